# `check.sh changed`: what a change can break, by the graph of packages.
# shellcheck shell=bash

# The commit that a change is compared with: where the branch left main, on main itself the last
# commit, and the one before where nothing has changed since.
changed_base() {
  local base
  base=$(git merge-base HEAD main 2>/dev/null || git merge-base HEAD origin/main 2>/dev/null || git rev-parse HEAD)
  if [ -z "$(changed_files "$base")" ]; then base=$(git rev-parse --verify --quiet HEAD~1 || echo "$base"); fi
  echo "$base"
}

# Files that differ from a commit, those included that git does not know yet.
changed_files() {
  git diff --name-only "$1" --
  git ls-files --others --exclude-standard
}

# A package and all packages that build on it, tests included; packages are named by their folders
# in crates/.
dependents() {
  local name
  name=$(sed -n 's/^name = "\(.*\)"/\1/p' "crates/$1/Cargo.toml" | head -1)
  cargo tree --workspace --locked --edges normal,build,dev --prefix none --invert "$name" |
    sed -n 's|^juggler[a-z-]* v[^ ]* (.*/crates/\([a-z]*\)).*|\1|p'
}

# The package whose tests read a file outside of crates/.
readers() {
  case "$1" in
    scenes/* | schema/* | docs/scene-format.md) echo scene ;;
    docs/gallery.md) echo juggler ;;
    docs/viewer.md) echo viewer ;;
    Cargo.toml | Cargo.lock | clippy.toml | rustfmt.toml | check.sh | .ci/* | tests/check/*) echo all ;;
  esac
}

# Whether a Rust file differs from a commit in comments alone: in lines that are empty or begin with
# `//`. Lines of texts that begin so are taken for comments too; the whole check finds what they
# break.
is_commented() {
  [[ $2 == *.rs && -f $2 ]] && git cat-file -e "$1:$2" 2>/dev/null || return 1
  git diff -U0 "$1" -- "$2" |
    awk '/^[-+]/ && !/^(---|\+\+\+) / && !/^[-+][[:space:]]*(\/\/.*)?$/ { code = 1 } END { exit code }'
}

# The packages to test, one a line, by their folders; `all` where everything may be concerned. What
# is built on a package sees its code, not its comments: those reach its own tests and, as
# descriptions, the scene format.
affected_packages() {
  local base=$1 file package direct=
  while read -r file; do
    if [[ $file != crates/*/* ]]; then
      direct+="$(readers "$file")"$'\n'
    elif is_commented "$base" "$file"; then
      printf '%s\nscene\n' "$(cut -d/ -f2 <<< "$file")"
    else
      direct+="$(cut -d/ -f2 <<< "$file")"$'\n'
    fi
  done
  if grep -qx all <<< "$direct"; then echo all; return; fi
  sort -u <<< "$direct" | while read -r package; do [ -z "$package" ] || dependents "$package"; done
}

check_changed() {
  local base files packages
  base=$(git rev-parse --verify "${1:-$(changed_base)}")
  files=$(changed_files "$base" | sort -u)
  packages=$(affected_packages "$base" <<< "$files" | sort -u)
  heading "changed since $(git log -1 --format='%h %s' "$base")"
  echo "packages to test: ${packages//$'\n'/, }"
  step_lint
  if grep -qx all <<< "$packages"; then
    step_unit
    run_test_programs golden
  elif [ -n "$packages" ]; then
    # shellcheck disable=SC2086
    run_test_programs $packages
  fi
  if grep -qE '^(crates/(session|viewer|serve)|tests/(viewer|browser|films))/' <<< "$files"; then step_windows; fi
}

# Builds all tests together, as the whole check does, so that nothing is built twice in two shapes;
# runs those of packages, and the rules of the tree.
run_test_programs() {
  local package program built left_out
  heading "changed: build"
  built=$(mktemp)
  cargo test --workspace --locked --no-run --message-format=json-render-diagnostics > "$built"
  for package in "$@"; do
    left_out=()
    if [ "$package" = golden ]; then left_out=("${golden_left_out[@]}"); fi
    test_programs "$package" "$built" | while read -r program; do
      heading "changed: $package, ${program##*/}"
      (cd "crates/$package" && "$program" --quiet "${left_out[@]}" < /dev/null)
    done
  done
  if [[ " $* " != *" golden "* ]]; then
    heading "changed: the rules of the tree"
    (cd crates/golden && "$(test_programs golden "$built" | grep '/golden-')" --quiet tree:: < /dev/null)
  fi
  rm -f "$built"
  heading "changed: examples of the documentation"
  cargo test --workspace --locked --doc --quiet
}

# The test programs of a package, one a line, in what cargo printed.
test_programs() {
  sed -n "/\"package_id\":\"[^\"]*\/crates\/$1#/{/\"profile\":{[^}]*\"test\":true}/s/.*\"executable\":\"\([^\"]*\)\".*/\1/p}" "$2"
}
