# The part `python` of `check.sh deep`: the wheel that is shipped, and long tests of the package.
# Each piece is remembered by itself, so that an interrupted run continues.
# shellcheck shell=bash

python_pieces=(wheel 3.11 3.13 typing hostile forks memory cluster overhead)

deep_python() {
  local piece
  for piece in "${python_pieces[@]}"; do once "python_$piece"; done
  for piece in "${python_pieces[@]}"; do
    [ "$(cat "$programs/deep/python_$piece" 2>/dev/null)" = "$(source_id)" ] || is_left_out=yes
  done
}

# Prints the path of the wheel that is shipped.
shipped_wheel() { echo "$programs"/deep/wheel/*.whl; }

# Builds the wheel that is shipped, with the license texts of all that it links, and checks it. Zig
# links it with the C library of 2018.
deep_python_wheel() {
  python_with wheel maturin==1.16.0 ziglang==0.17.1 zopflipy==1.14 || return 0
  "$python" tests/python/licenses.py crates/python/licenses
  PATH=$(realpath -s "${python%/*}"):$PATH build_wheel "$programs/deep/wheel" \
    --manifest-path crates/python/Cargo.toml --locked --zig --compatibility manylinux_2_28 > /dev/null
  "$python" tests/python/pack.py "$(shipped_wheel)"
  "$python" tests/python/wheel.py "$(shipped_wheel)"
}

# Makes the environment of a Python with the wheel and all packages that tests may use; `$python` is
# its interpreter. Leaves out the piece if that Python is not installed.
shipped_package() {
  local version=$1 packages
  if ! "python$version" -c 'import ensurepip, venv' 2>/dev/null; then
    leave_out "python: python$version is not installed (apt-get install python$version-venv)"
    return 1
  fi
  python=$programs/deep/python-$version/bin/python
  mapfile -t packages < <(packages_for_tests)
  environment "$programs/deep/python-$version" "python$version" "$(shipped_wheel)" "${packages[@]}" ||
    { is_left_out=yes; return 1; }
}

# Runs tests of the package in one Python, beside the optimized program: those of the given modules,
# or all, with the hashes of all built-in scenes.
test_shipped() {
  shipped_package "$1" || return 0
  shift
  cargo build --release --locked -p juggler-cli
  JUGGLER_HASHES=all JUGGLER_PROGRAM=$PWD/$programs/release/juggler test_package "${python%/bin/*}" "$@"
}

deep_python_3.11() {
  test_shipped 3.11 installed
  test_shipped 3.11
}

deep_python_3.13() {
  test_shipped 3.13 installed
  test_shipped 3.13
}

# Checks the package, its tests of types and its examples as strictly as type checkers can, and the
# completion of editors.
deep_python_typing() {
  python_with typing mypy==2.4.1 pyright==1.1.414 jedi==0.20.1 numpy==2.4.6 || return 0
  PATH=$(realpath -s "${python%/*}"):$PATH check_types "${python%/bin/*}"
  "${python%/*}/mypy" --config-file crates/python/tests/typed/mypy.ini
  PYTHONPATH=crates/python/python "$python" tests/python/completion.py
}

deep_python_hostile() { JUGGLER_INPUTS=100000 test_shipped 3.11 test_hostile; }
deep_python_forks() { JUGGLER_FORKS=1000 test_shipped 3.11 test_forks; }
deep_python_memory() { JUGGLER_SCENES=10000 test_shipped 3.11 test_memory; }

# Kills workers, nodes and drivers of clusters of Ray and Dask on this machine.
deep_python_cluster() { test_shipped 3.11 deep_cluster; }

# Compares the time of whole processes with that of the program of the same profile.
deep_python_overhead() {
  shipped_package 3.11 || return 0
  cargo build --profile dist --locked -p juggler-cli --features ktx2
  "$python" tests/python/overhead.py "$python" "$programs/dist/juggler"
}
