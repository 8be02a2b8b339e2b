#!/bin/sh
# Prints the `rustc` that compiles for wasm32-unknown-unknown, and its linker (an empty line for the
# compiler's own). These are rustup's if it has the target. Otherwise the script unpacks Debian's
# `rustc-web` into a folder of its own and builds its standard library once. It installs nothing and
# needs no special rights.
set -eu

target=wasm32-unknown-unknown
if [ -d "$(rustc --print sysroot)/lib/rustlib/$target/lib" ]; then
  rustup which rustc 2> /dev/null || command -v rustc
  echo
  exit
fi
if ! apt-cache show rustc-web > /dev/null 2>&1; then
  echo "no $target here: install it (rustup target add $target)," >&2
  echo "or build on a Debian that has rustc-web, after apt-get update" >&2
  exit 1
fi

cache=${XDG_CACHE_HOME:-$HOME/.cache}/juggler-web
version=$(apt-cache policy rustc-web | sed -n 's/ *Candidate: //p')
needed=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' "$(dirname "$0")/../Cargo.toml")
if dpkg --compare-versions "$version" lt "$needed"; then
  echo "rustc-web $version is older than $needed: run apt-get update, which knows newer ones" >&2
  exit 1
fi
prefix=$cache/rustc-$version
lock=$cache/lock
mkdir -p "$cache"
# Run one instance at a time; a second one finds the result of the first.
exec 9> "$lock"
flock 9

# Lists the packages that an installation would add to those that are installed.
packages() {
  apt-get install -s --no-install-recommends rustc-web libstd-rust-web-dev rust-web-src lld-19 |
    sed -n 's/^Inst \([^ ]*\).*/\1/p'
}

unpack() {
  rm -rf "$prefix.new"
  mkdir -p "$prefix.new/debs"
  (
    cd "$prefix.new/debs"
    # shellcheck disable=SC2046
    apt-get -q download $(packages)
    for file in *.deb; do dpkg -x "$file" ..; done
  ) >&2
  rm -rf "$prefix.new/debs"
  mv "$prefix.new" "$prefix"
}

wrapper() { # name, program
  {
    echo '#!/bin/sh'
    echo "export LD_LIBRARY_PATH=$prefix/usr/lib/$(uname -m)-linux-gnu"
    echo "exec $prefix/$2 \"\$@\""
  } > "$prefix/$1"
  chmod +x "$prefix/$1"
}

# Builds the standard library: an empty crate built with `build-std` leaves the libraries of std,
# which are copied to the compiler's own folder for them.
standard_library() {
  crate=$(mktemp -d)
  mkdir "$crate/src"
  printf '[package]\nname = "empty"\nedition = "2024"\n[workspace]\n' > "$crate/Cargo.toml"
  : > "$crate/src/lib.rs"
  (
    cd "$crate"
    RUSTC=$prefix/rustc RUSTC_BOOTSTRAP=1 CARGO_TARGET_DIR=$crate/target RUSTFLAGS= \
      cargo build --release -Z build-std=std,panic_abort --target "$target"
  ) >&2
  libraries=$prefix/usr/lib/rustlib/$target/lib
  mkdir -p "$libraries.new"
  cp "$crate/target/$target"/release/deps/lib*.rlib "$libraries.new"
  rm -f "$libraries.new"/libempty-*
  mv "$libraries.new" "$libraries"
  rm -rf "$crate"
}

[ -d "$prefix" ] || unpack
wrapper rustc usr/bin/rustc
wrapper wasm-ld usr/lib/llvm-19/bin/wasm-ld
[ -d "$prefix/usr/lib/rustlib/$target/lib" ] || standard_library
echo "$prefix/rustc"
echo "$prefix/wasm-ld"
