#!/usr/bin/env bash
# symbols.sh LIBRARY HEADER [--update]
# Compares what the shared library exports with symbols.txt beside this script, and that with what the header
# declares. A change of the list is a change of the binary interface: --update rewrites it, to be reviewed.
set -euo pipefail
library=$1 header=$2
list=$(dirname "$0")/symbols.txt

# Functions of every kind and data; the version's own name is an absolute symbol and no part of the interface.
exported=$(nm --dynamic --defined-only --format=posix "$library" | awk '$2 != "A" { sub(/@.*/, "", $1); print $1 }' | LC_ALL=C sort -u)
declared=$(grep -o '\blb_[a-z_]*(' "$header" | tr -d '(' | LC_ALL=C sort -u)

if [ "${3:-}" = --update ]; then
    printf '%s\n' "$exported" >"$list"
fi
status=0
diff --label symbols.txt --label "exported by the library" -u "$list" <(printf '%s\n' "$exported") || status=1
diff --label symbols.txt --label "declared by the header" -u "$list" <(printf '%s\n' "$declared") || status=1

# OpenGL is opened at run time: a host without it must still be able to load the library.
if readelf --dynamic "$library" | grep -E 'NEEDED.*lib(EGL|GL|OpenGL|GLX|GLESv2)\.'; then
    echo "the library is linked to OpenGL"
    status=1
fi
exit $status
