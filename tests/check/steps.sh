# Steps of check.sh.
# shellcheck shell=bash

programs=${CARGO_TARGET_DIR:-target}
# Target triple of this machine. With an explicit target, RUSTFLAGS do not apply to build scripts
# and macros, so that both builds share them.
host=$(rustc -vV | sed -n 's/^host: //p')

# Prints a heading with the seconds since the start.
heading() { printf '\n== %4d s  %s\n' "$SECONDS" "$*"; }

# Runs all steps of CI. Since driving windows leaves the machine mostly idle, builds run meanwhile.
check_all() {
  run_steps lint unit
  in_background "golden: optimized programs" at_leisure build_golden
  start_windows
  in_background "features" at_leisure step_features
  in_background "python" at_leisure step_python
  finish_windows
  finish_background "features"
  finish_background "golden: optimized programs"
  finish_background "python"
  run_steps golden
}

run_steps() {
  local name
  for name in "$@"; do "step_$name"; done
}

# Records a check that cannot run because a package is missing. In CI that is an error, since
# .ci/run installs the packages first.
skip() {
  if [ "${CI:-}" = true ]; then echo "error: $1, and CI skips nothing that a package gives" >&2; exit 1; fi
  echo "SKIPPED: $1"
  echo "$1" >> "$JUGGLER_SKIPPED"
}

# Prints the result: the skipped checks and their reasons.
report() {
  heading "all checks passed"
  if [ -s "$JUGGLER_SKIPPED" ]; then
    printf '%d checks were skipped:\n' "$(wc -l < "$JUGGLER_SKIPPED")"
    sort "$JUGGLER_SKIPPED" | uniq -c | sed 's/^ *\([0-9]*\) /  \1 x /'
  else
    echo "nothing was skipped"
  fi
}

# Starts a command in the background, as a process group. `finish_background` prints its output.
in_background() {
  local name=$1
  shift
  set -m
  "$@" > "$logs/$name" 2>&1 < /dev/null &
  background[$name]=$!
  set +m
}
declare -A background=()

# Runs a command at the lowest priority.
at_leisure() {
  renice -n 19 "$BASHPID" >/dev/null
  "$@"
}

# Waits for a background command and prints its output.
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

# Tests every package, unoptimized, with overflow checks. All steps select the whole workspace, since
# another set of packages would compile all libraries again.
step_unit() {
  heading "unit: tests of each package, and of its documentation"
  cargo test --workspace --locked
}

# Checks each feature alone and no features, since the workspace builds only all of them together.
# The program without features uses the libraries without features; `juggler-web` uses the session
# without threads and clocks.
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
-p juggler-import --no-default-features
-p juggler-web
END
  # Check only the list of packages: building the page needs a compiler that few machines have (see
  # step web).
  heading "features: packages of the page in WebAssembly"
  if cargo tree --locked -p juggler-web --target wasm32-unknown-unknown --edges normal --prefix none |
    grep -E '^(libloading|notify|rav1e|rustix|signal-hook|tokio) '; then
    echo "error: WebAssembly has no system that these packages could call" >&2
    return 1
  fi
}

# Compares hashes of pictures in optimized builds with those of the step unit; they must be equal to
# the bit. Statistics of whole pictures run here only, and tests of the source tree there only.
step_golden() {
  heading "golden: pictures and hashes, optimized"
  cargo test "${golden_optimized[@]}" -- --skip tree:: --skip arithmetic:: --skip kinds::
  heading "golden: hashes, optimized for this very processor"
  RUSTFLAGS="-C target-cpu=native" cargo test "${golden_native[@]}" -- hashes:: hits:: matrix::
}

# Selects the Python module, too, so that its wheel has the same features of all libraries and shares
# them (see `build_wheel`). The module itself is not built here.
golden_optimized=(--release --locked -p juggler-golden -p juggler-python --test golden)
# Optimizes the crates `scene` and `mesh` less: reading files takes less time here than compiling
# them. Leaves out movies, whose encoder takes long to compile.
golden_native=("${golden_optimized[@]}" --no-default-features --target "$host"
  --config "profile.release.package.juggler-scene.opt-level=1"
  --config "profile.release.package.juggler-mesh.opt-level=1")

# Builds the optimized test programs of `golden` in advance.
build_golden() {
  cargo test "${golden_optimized[@]}" --no-run
  RUSTFLAGS="-C target-cpu=native" cargo test "${golden_native[@]}" --no-run
}

# Builds the program together with the tests. A build without them would select other features of
# its dependencies and compile all of them again.
build_debug_program() { cargo test --workspace --locked --no-run --quiet; }

step_windows() {
  start_windows
  finish_windows
}

# Drives the window and the page concurrently: both wait for pictures most of the time.
start_windows() {
  heading "windows: the program that is driven"
  build_debug_program
  heading "windows: the window, the page and movies are driven"
  drive "windows: the window" drive_window "xvfb xdotool imagemagick python3 libgl1 libgl1-mesa-dri libxkbcommon-x11-0" Xvfb xdotool import python3
  drive "windows: the page and movies" drive_page "chromium nodejs npm ffmpeg" chromium node npm
}

finish_windows() {
  finish_background "windows: the page and movies"
  finish_background "windows: the window"
}

drive_window() { tests/viewer/test.sh "$programs/debug/juggler"; }
drive_page() { tests/browser/test.sh "$programs/debug/juggler" && tests/movies/test.sh "$programs/debug/juggler"; }

# Starts a test that drives a program from outside if the tools for it are installed.
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

# Builds and drives the page that renders in the browser alone. CI leaves it out, since its compiler
# and standard library are large downloads.
step_web() {
  heading "web: the page that renders in the browser alone"
  build_debug_program
  web/build.sh
  tests/web/test.sh "$programs/debug/juggler"
}
