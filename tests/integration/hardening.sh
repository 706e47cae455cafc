#!/usr/bin/env bash
# hardening.sh LIBRARY COMPILE_COMMANDS BUILD_TYPE
# Whether the shared library was built as LIGHTBAND_HARDENING promises.
set -euo pipefail
library=$1 compile_commands=$2 build_type=$3
status=0

missing() {
    echo "$library has no $1" >&2
    status=1
}

# Full RELRO: all symbols are bound at load time, and what they were written to is read-only afterwards.
dynamic=$(readelf --wide --dynamic "$library")
grep -q 'BIND_NOW\|Flags:.*\bNOW\b' <<<"$dynamic" || missing "immediate binding (-z now)"
grep -q GNU_RELRO <<<"$(readelf --wide --program-headers "$library")" || missing "GNU_RELRO segment"

grep -q 'UND __stack_chk_fail' <<<"$(readelf --wide --dyn-syms "$library")" || missing "stack protector"

# _FORTIFY_SOURCE leaves no trace where every size is known to the compiler: the commands are asked instead.
if [ "$build_type" != Debug ]; then
    if grep '"command".*/src/' "$compile_commands" | grep -v -- '-D_FORTIFY_SOURCE=2'; then
        missing "_FORTIFY_SOURCE=2 in the commands above"
    fi
fi
exit $status
