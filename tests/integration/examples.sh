#!/usr/bin/env bash
# examples.sh SOURCE C_COMPILER CXX_COMPILER
# Every documented program compiles without a warning under the options that strict projects use: those of examples/,
# the first one of lightband.hpp and the one of the README, each as the body of a function.
set -euo pipefail
source=$1 c_compiler=$2 cxx_compiler=$3
strict=(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror -fsyntax-only "-I$source/include")

check_c() { "$c_compiler" -std=c99 "${strict[@]}" -x c -; }
check_cpp() { "$cxx_compiler" -std=c++17 "${strict[@]}" -x c++ -; }

# Reads indented statements and makes them a function of the program whose includes are given.
function_body() {
    local statements
    statements=$(cat)
    [ -n "$statements" ] || { echo "the example was not found" >&2; return 1; }
    printf '#include <%s>\n%s {\n%s\n}\n' "$1" "$2" "$statements"
}

echo "examples/c"
check_c <"$source/examples/c/render.c"
echo "examples/cpp"
check_cpp <"$source/examples/cpp/render.cpp"
echo "lightband.hpp"
sed -n 's|^//     \(.*\)|\1|p' "$source/include/lightband/lightband.hpp" |
    function_body lightband/lightband.hpp "void example(); void example()" | check_cpp
echo "README.md"
sed -n '/^```c$/,/^```$/{/^```/!p}' "$source/README.md" |
    function_body lightband/lightband.h "void example(void); void example(void)" | check_c
