#!/bin/sh
# Builds the page that renders in the browser alone: plain files in web/dist/, for any static file
# server. See docs/web.md.
set -eu
cd "$(dirname "$0")"

built=${CARGO_TARGET_DIR:-$PWD/../target}
target=wasm32-unknown-unknown
tools=$(./toolchain.sh)
rustc=$(echo "$tools" | sed -n 1p)
linker=$(echo "$tools" | sed -n 2p)

# The generated JavaScript fits the module only if both have the same version of wasm-bindgen.
version=$(sed -n '/^name = "wasm-bindgen"$/{n;s/version = "\(.*\)"/\1/p;}' ../Cargo.lock)
if ! grep -q "wasm-bindgen-cli-support = \"=$version\"" bindgen/Cargo.toml; then
  echo "web/bindgen/Cargo.toml must require wasm-bindgen-cli-support =$version, as Cargo.lock has wasm-bindgen" >&2
  exit 1
fi
cargo build --release --locked --manifest-path bindgen/Cargo.toml --target-dir "$built/bindgen"

[ -z "$linker" ] || export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER="$linker"
RUSTC=$rustc RUSTFLAGS="-C target-feature=+simd128" \
  cargo build --locked --manifest-path ../Cargo.toml -p juggler-web --lib --profile web --target "$target" --target-dir "$built"

rm -rf dist.new
mkdir dist.new
"$built/bindgen/release/bindgen" "$built/$target/web/juggler_web.wasm" dist.new
cp page/* ../crates/serve/page/files.js dist.new
rm -rf dist
mv dist.new dist
du -sh dist
