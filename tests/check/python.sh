# The step `python`: builds the wheel, installs it into fresh virtual environments, and tests it.
# shellcheck shell=bash

# The wheel of the check has the profile `release` and no limit of size. The tests of `golden`
# select the same package, so that both builds share all libraries.
wheel_options=(--manifest-path crates/python/Cargo.toml --profile release --features av1,serve --locked
  --compatibility linux --auditwheel skip)

# Tests the Python package as users install it. The program to compare with is the unoptimized one.
step_python() {
  local wheel folder=$programs/python packages
  heading "python: the wheel"
  if ! python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
    skip "python: python3 is missing or older than 3.11 (apt-get install python3)"
    return
  fi
  if ! command -v maturin >/dev/null; then
    skip "python: maturin is not installed (pip install maturin)"
    return
  fi
  build_debug_program
  wheel=$(build_wheel "$folder/wheel" "${wheel_options[@]}")
  heading "python: the package by itself, in $(python3 --version)"
  environment "$folder/bare" python3 "$wheel" || return 0
  test_package "$folder/bare" installed
  count_instructions "$folder/bare/bin/juggler"
  heading "python: the package beside NumPy and others, in $(python3 --version)"
  mapfile -t packages < <(packages_for_tests | grep -vE "^($large_packages)")
  environment "$folder/numpy" python3 "$wheel" "${packages[@]}" || return 0
  test_package "$folder/numpy"
  heading "python: types"
  if command -v pyright >/dev/null; then check_types "$folder/numpy"; else skip "python: pyright is not installed (pip install pyright)"; fi
}

# Counts the instructions of rendering by the program of the wheel, which is optimized and has all
# that renders.
count_instructions() {
  heading "python: instructions of rendering"
  if ! command -v valgrind >/dev/null; then
    skip "instructions: valgrind is not installed (apt-get install valgrind)"
    return
  fi
  tests/instructions/compare.py "$1"
}

# Checks the stubs of the package, and uses and mistakes of it, as strictly as pyright can.
check_types() {
  PYRIGHT_PYTHON_IGNORE_WARNINGS=1 pyright --pythonpath "$1/bin/python" --project crates/python/tests/typed
}

# Packages of hundreds of megabytes, which only `deep python` installs.
large_packages="distributed|open3d|pyvista|ray"

# Prints the packages that the tests work with, one per line.
packages_for_tests() { grep -v '^#' crates/python/tests/requirements.txt; }

# Builds a wheel into a folder of its own, with the given options of maturin, and prints its path.
build_wheel() {
  local folder=$1 wheel
  shift
  rm -rf "$folder"
  maturin build --quiet "$@" --out "$folder" >&2 || return 1
  wheel=$(echo "$folder"/*.whl)
  echo "$wheel: $(stat -c %s "$wheel") bytes" >&2
  echo "$wheel"
}

# Installs a wheel and packages into a new virtual environment of a Python, unless that very wheel is
# installed there already. Fails if the packages cannot be had.
environment() {
  local folder=$1 python=$2 wheel=$3 contents
  shift 3
  contents="$("$python" --version) $(sha256sum < "$wheel") $*"
  [ "$(cat "$folder/contents" 2>/dev/null)" != "$contents" ] || return 0
  rm -rf "$folder"
  if ! "$python" -m venv "$folder"; then
    skip "python: $python makes no virtual environments (apt-get install python3-venv)"
    return 1
  fi
  if [ $# -gt 0 ] && ! "$folder/bin/pip" install --quiet --disable-pip-version-check "$@"; then
    skip "python: packages cannot be installed ($*)"
    return 1
  fi
  "$folder/bin/pip" install --quiet --disable-pip-version-check --no-deps --no-index "$wheel" || exit 1
  echo "$contents" > "$folder/contents"
}

# Runs tests of the package in a virtual environment: all, or those of the given modules.
test_package() {
  local folder=$1
  shift
  JUGGLER_PROGRAM=${JUGGLER_PROGRAM:-$PWD/$programs/debug/juggler} "$folder/bin/python" crates/python/tests/run.py "$@"
}
