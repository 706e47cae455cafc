#!/usr/bin/env bash
# Takes the part of somebody who installed the library: consumer.sh STEP SOURCE BUILD WORK
#   install        installs BUILD into WORK/first and moves that to WORK/prefix: nothing may remember the first place
#   c_shared       examples/c by its Makefile, C99 without optimisation, and runs it
#   c_static       the same with the static library
#   cpp            examples/cpp by find_package
#   cmake_shared   examples/c by find_package, in a project without C++
#   cmake_static   the same with the static library
# Everything runs by software rendering.
set -euo pipefail
step=$1 source=$2 build=$3 work=$4
here=$work/$step
prefix=$work/prefix
map=$source/data/courtyard.exr
rm -rf "$here"
mkdir -p "$here"

if [ "$step" = install ]; then
    rm -rf "$prefix"
    cmake --install "$build" --prefix "$here/first" >/dev/null
    mv "$here/first" "$prefix"
    if grep -rlIF "$here" "$prefix"; then
        echo "the files above hold the path of the first prefix" >&2
        exit 1
    fi
    exit
fi

libdir=$(dirname "$(find "$prefix" -name liblightband.so)")

# Whether the program that was built is bound to the shared library: "yes" or "no" is what is wanted.
expect_shared() {
    local found=no
    if readelf --dynamic render | grep -q 'NEEDED.*liblightband'; then found=yes; fi
    [ "$found" = "$1" ] || { echo "bound to the shared library: $found, wanted: $1" >&2; exit 1; }
}

# Runs ./render and looks for each picture that it must have written.
run_example() {
    LD_LIBRARY_PATH=$libdir ./render "$map" software
    local picture
    for picture in "$@"; do
        [ -s "$picture" ] || { echo "$picture was not written" >&2; exit 1; }
    done
}

build_with_cmake() {
    cmake -S "$1" -B . -DCMAKE_PREFIX_PATH="$prefix" "${@:2}" >/dev/null
    cmake --build . >/dev/null
}

cd "$here"
export PKG_CONFIG_PATH=$libdir/pkgconfig XDG_CACHE_HOME=$work/cache
case $step in
c_shared)
    cp "$source"/examples/c/{render.c,Makefile} .
    make CFLAGS="-O0 -std=c99 -pedantic -Wall -Wextra -Werror"
    expect_shared yes
    run_example knot.exr knot.png
    ;;
c_static)
    cp "$source"/examples/c/{render.c,Makefile} .
    make CFLAGS="-O0 -std=c99 -pedantic -Wall -Wextra -Werror" STATIC=1
    expect_shared no
    run_example knot.exr knot.png
    ;;
cpp)
    build_with_cmake "$source/examples/cpp"
    expect_shared yes
    run_example metal-0.1.exr metal-0.8.exr
    ;;
cmake_shared)
    build_with_cmake "$source/tests/install/consumer" -DEXAMPLE="$source/examples/c/render.c"
    expect_shared yes
    run_example knot.exr knot.png
    ;;
cmake_static)
    build_with_cmake "$source/tests/install/consumer" -DEXAMPLE="$source/examples/c/render.c" -DSTATIC=ON
    expect_shared no
    run_example knot.exr knot.png
    ;;
*)
    echo "unknown step $step" >&2
    exit 2
    ;;
esac
