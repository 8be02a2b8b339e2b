#!/usr/bin/env bash
# Builds the module without optimization, assembles the package in a folder for tests, and prints
# the folder: faster than a wheel while the module changes. `./check.sh python` tests the wheel.
#   PYTHONPATH=$(crates/python/tests/stage.sh) python3 -m unittest discover crates/python/tests
set -euo pipefail
cd "$(dirname "$0")/../../.."
cargo build --quiet --locked -p juggler-python >&2
target=${CARGO_TARGET_DIR:-$PWD/target}
folder=$target/python
rm -rf "$folder"
mkdir -p "$folder"
cp -r crates/python/python/juggler "$folder/"
cp "$target/debug/lib_native.so" "$folder/juggler/_native.abi3.so"
echo "$folder"
