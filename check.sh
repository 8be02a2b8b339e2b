#!/usr/bin/env bash
# Everything that must hold before a change lands; CI runs exactly this. Cheap checks first.
#   ./check.sh            all of it
#   ./check.sh quick      without the release build, and without driving windows and pages
#   ./check.sh --windows  instead, only the window of juggler view, the page of juggler serve and films in a browser, driven
#   ./check.sh --web      instead, the page that renders in the browser alone (web/build.sh): built, driven in Chromium, not in CI
#   ./check.sh --cluster  instead, the commands of docs/cluster.md on a small Slurm of its own: as root, some minutes, not in CI
set -euo pipefail
cd "$(dirname "$0")"
mode=${1:-all}
case "$mode" in all | quick | --windows | --web | --cluster) ;; *) echo "usage: ./check.sh [quick | --windows | --web | --cluster]" >&2; exit 2 ;; esac

step() { printf '\n== %s\n' "$*"; }

programs=${CARGO_TARGET_DIR:-target}

# Runs a test that drives a program from outside, where its tools are there.
drive() {
  local test=$1 packages=$2 tool
  shift 2
  for tool in "$@"; do
    if ! command -v "$tool" >/dev/null; then
      echo "$tool is not installed: skipped (apt-get install $packages)"
      return
    fi
  done
  "$test" "$programs/debug/juggler"
}

drive_windows() {
  step "tests: the window of juggler view, with keys and mouse"
  drive tests/viewer/test.sh "xvfb xdotool imagemagick libgl1 libgl1-mesa-dri libxkbcommon-x11-0" Xvfb xdotool import

  step "tests: the page of juggler serve, in Chromium"
  drive tests/browser/test.sh "chromium nodejs npm" chromium node npm

  step "tests: films, in Chromium"
  drive tests/films/test.sh "chromium nodejs npm" chromium node npm
}

if [ "$mode" = --windows ]; then
  cargo build --workspace --locked
  drive_windows
  exit
fi

if [ "$mode" = --web ]; then
  step "tests: the page that renders in the browser alone"
  cargo build --workspace --locked
  web/build.sh
  exec tests/web/test.sh "$programs/debug/juggler"
fi

if [ "$mode" = --cluster ]; then
  step "tests: the commands of docs/cluster.md"
  cargo build --release --locked -p juggler-cli
  exec tests/cluster/test.sh "$programs/release/juggler"
fi

step "spelling"
if command -v typos >/dev/null; then typos; else echo "typos is not installed: skipped (pip install typos)"; fi

step "format"
cargo fmt --all --check

step "lints"
cargo clippy --workspace --all-targets --locked -- -D warnings

step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked --quiet

step "tests: units, contracts, hostile input, tree, licences, schema, documentation"
cargo test --workspace --locked

if [ "$mode" = all ]; then
  drive_windows

  step "tests: pictures and hashes again, optimised: debug and release must agree to the bit"
  cargo test --release --locked -p juggler-golden \
    --test arithmetic --test hashes --test instances --test matrix --test noise --test scales

  step "tests: hashes once more, built for this very processor"
  RUSTFLAGS="-C target-cpu=native" CARGO_PROFILE_RELEASE_LTO=off CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16 \
    cargo test --release --locked --target-dir target/native -p juggler-golden --test hashes --test matrix
fi

step "all checks passed"
