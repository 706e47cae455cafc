#!/usr/bin/env bash
# no_destructors.sh LIBRARY.a
# Objects of the library that the end of the process would destroy, while threads of the host may still use them. There are none: what
# lives as long as the process is made by new and never deleted. The files that include OpenEXR's headers have std::ios_base::Init of
# those, which is harmless.
set -euo pipefail
if nm --print-file-name --undefined-only "$1" | grep -w __cxa_atexit | grep -vE ':(exr[a-z_]*|cube_map)\.cpp\.o:'; then
    echo "the files above have static objects with destructors"
    exit 1
fi
