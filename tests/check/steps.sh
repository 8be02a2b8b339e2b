# The steps of check.sh.
# shellcheck shell=bash

programs=${CARGO_TARGET_DIR:-target}
# Named as a target, this machine shares build scripts and macros with builds for which it is not
# named.
host=$(rustc -vV | sed -n 's/^host: //p')

# Announces what begins, and how many seconds have passed.
heading() { printf '\n== %4d s  %s\n' "$SECONDS" "$*"; }

# Everything. What is only built is built while windows are driven, which leaves the machine idle.
check_all() {
  run_steps lint unit
  in_background "golden: optimized programs" at_leisure build_golden
  start_windows
  in_background "features" at_leisure step_features
  finish_windows
  finish_background "features"
  finish_background "golden: optimized programs"
  run_steps golden
}

run_steps() {
  local name
  for name in "$@"; do "step_$name"; done
}

# Notes a check that cannot run for want of a package. CI installs packages first (.ci/run), so that
# nothing is missing there.
skip() {
  if [ "${CI:-}" = true ]; then echo "error: $1, and CI skips nothing that a package gives" >&2; exit 1; fi
  echo "SKIPPED: $1"
  echo "$1" >> "$JUGGLER_SKIPPED"
}

# How the check ends: what was skipped, and why.
report() {
  heading "all checks passed"
  if [ -s "$JUGGLER_SKIPPED" ]; then
    printf '%d checks were skipped:\n' "$(wc -l < "$JUGGLER_SKIPPED")"
    sort "$JUGGLER_SKIPPED" | uniq -c | sed 's/^ *\([0-9]*\) /  \1 x /'
  else
    echo "nothing was skipped"
  fi
}

# Starts a command beside what follows, as a process group; what it prints is kept until it is
# waited for.
in_background() {
  local name=$1
  shift
  set -m
  "$@" > "$logs/$name" 2>&1 < /dev/null &
  background[$name]=$!
  set +m
}
declare -A background=()

# Runs a command whenever nothing else runs.
at_leisure() {
  renice -n 19 "$BASHPID" >/dev/null
  "$@"
}

# Waits for a command in the background, and prints what it printed.
finish_background() {
  local name=$1 status=0
  [ -n "${background[$name]:-}" ] || return 0
  wait "${background[$name]}" || status=$?
  unset "background[$name]"
  heading "$name"
  cat "$logs/$name"
  [ "$status" = 0 ] || { echo "error: $name: status $status" >&2; exit 1; }
}

step_lint() {
  heading "lint: spelling"
  if command -v typos >/dev/null; then typos; else skip "spelling: typos is not installed (pip install typos)"; fi
  heading "lint: format"
  cargo fmt --all --check
  heading "lint: clippy"
  cargo clippy --workspace --all-targets --locked -- -D warnings
  heading "lint: documentation"
  RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked --quiet
}

# Tests of every package but those of the whole, unoptimized, with overflow checks.
step_unit() {
  heading "unit: tests of each package, and of its documentation"
  cargo test --workspace --locked --exclude juggler-golden
}

# Each feature alone and none: the workspace builds them only all together. The program without
# features holds the libraries without theirs, `juggler-web` the session without threads and clocks.
step_features() {
  local line
  heading "features: packages by themselves"
  while read -r line; do
    echo "cargo clippy $line"
    # shellcheck disable=SC2086
    cargo clippy --locked --quiet $line -- -D warnings
  done <<'END'
-p juggler-cli --no-default-features
-p juggler-cli --no-default-features --features av1
-p juggler-cli --no-default-features --features serve
-p juggler-cli --no-default-features --features view
-p juggler-web
END
  # The page itself needs a compiler that few machines have (step web), its list of packages does not.
  heading "features: packages of the page in WebAssembly"
  if cargo tree --locked -p juggler-web --target wasm32-unknown-unknown --edges normal --prefix none |
    grep -E '^(libloading|notify|rav1e|rustix|signal-hook|tokio) '; then
    echo "error: WebAssembly has no system that these packages could call" >&2
    return 1
  fi
}

# Hashes of pictures in every build that people make: they must be the same to the bit. Statistics
# of whole pictures are optimized, the rules of the tree are read once.
step_golden() {
  heading "golden: pictures and hashes, unoptimized, with overflow checks"
  cargo test --workspace --locked --test golden -- "${golden_left_out[@]}"
  heading "golden: pictures and hashes, optimized"
  cargo test "${golden_optimized[@]}" -- --skip tree:: --skip arithmetic:: --skip kinds::
  heading "golden: hashes, optimized for this very processor"
  RUSTFLAGS="-C target-cpu=native" cargo test "${golden_native[@]}" -- hashes:: hits:: matrix::
}

# Statistics of whole pictures, which take too long unoptimized.
golden_left_out=(--skip noise:: --skip blur::)
golden_optimized=(--release --locked -p juggler-golden --test golden)
# Texts of scenes are not worth their time here.
golden_native=("${golden_optimized[@]}" --target "$host"
  --config "profile.release.package.juggler-scene.opt-level=1")

# Builds the optimized programs of `golden`, to run later.
build_golden() {
  cargo test "${golden_optimized[@]}" --no-run
  RUSTFLAGS="-C target-cpu=native" cargo test "${golden_native[@]}" --no-run
}

# Builds the program as the tests do: without them, other features of its dependencies would build
# all of them again.
build_debug_program() { cargo test --workspace --locked --no-run --quiet; }

step_windows() {
  start_windows
  finish_windows
}

# The window is driven beside the page: most of the time each waits for pictures.
start_windows() {
  heading "windows: the program that is driven"
  build_debug_program
  heading "windows: the window, the page and films are driven"
  drive "windows: the window" drive_window "xvfb xdotool imagemagick libgl1 libgl1-mesa-dri libxkbcommon-x11-0" Xvfb xdotool import
  drive "windows: the page and films" drive_page "chromium nodejs npm ffmpeg" chromium node npm
}

finish_windows() {
  finish_background "windows: the page and films"
  finish_background "windows: the window"
}

drive_window() { tests/viewer/test.sh "$programs/debug/juggler"; }
drive_page() { tests/browser/test.sh "$programs/debug/juggler" && tests/films/test.sh "$programs/debug/juggler"; }

# Starts a test that drives a program from outside, where its tools are there.
drive() {
  local name=$1 test=$2 packages=$3 tool
  shift 3
  for tool in "$@"; do
    if ! command -v "$tool" >/dev/null; then
      skip "$name: $tool is not installed (apt-get install $packages)"
      return
    fi
  done
  in_background "$name" "$test"
}

# The page that renders in the browser alone; not in CI, since its compiler and standard library are
# large downloads.
step_web() {
  heading "web: the page that renders in the browser alone"
  build_debug_program
  web/build.sh
  tests/web/test.sh "$programs/debug/juggler"
}
