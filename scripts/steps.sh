# Sourced by the scripts beside it: the project's root as working folder, headings that tell the time that passed,
# and the two steps that more than one script takes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export LIGHTBAND_STARTED=${LIGHTBAND_STARTED:-$EPOCHSECONDS}
# One name for the compiler in every build: left alone, the Python package takes g++, whose objects ccache keeps apart
# from those of c++, and the whole library is compiled twice.
export CC=${CC:-cc} CXX=${CXX:-c++}

step() {
    local elapsed=$((EPOCHSECONDS - LIGHTBAND_STARTED))
    printf '\n== %d:%02d  %s\n' $((elapsed / 60)) $((elapsed % 60)) "$*"
}

# Configures and builds one preset of CMakePresets.json: build_preset PRESET [TARGET...]
build_preset() {
    local preset=$1 targets=()
    shift
    [ $# -eq 0 ] || targets=(--target "$@")
    if command -v ccache >/dev/null; then
        export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
    fi
    cmake --preset "$preset" --log-level=WARNING >/dev/null
    cmake --build --preset "$preset" "${targets[@]}"
}

# Installs the Python package into build/venv when one of its sources changed since the last time.
install_package() {
    local sources=(CMakeLists.txt pyproject.toml bindings cmake include shaders src scripts/requirements-build.txt)
    local stamp=build/venv/package.stamp now
    now=$(find "${sources[@]}" -type f -not -path '*/__pycache__/*' -printf '%p %s %T@\n' | sort)
    if [ -f "$stamp" ] && [ "$now" = "$(cat "$stamp")" ]; then
        echo "the installed package is up to date"
        return
    fi
    build/venv/bin/python -m pip install --quiet --no-deps --no-build-isolation --config-settings=build-dir=build/python .
    printf '%s\n' "$now" >"$stamp"
}
