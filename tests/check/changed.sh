# `check.sh changed`: tests the packages that a change can break, by the dependency graph.
# shellcheck shell=bash

# Prints the commit to compare with: the merge base with main, which on main is the last commit, or
# the commit before it if nothing has changed since.
changed_base() {
  local base
  base=$(git merge-base HEAD main 2>/dev/null || git merge-base HEAD origin/main 2>/dev/null || git rev-parse HEAD)
  if [ -z "$(changed_files "$base")" ]; then base=$(git rev-parse --verify --quiet HEAD~1 || echo "$base"); fi
  echo "$base"
}

# Lists the files that differ from a commit, untracked files included.
changed_files() {
  git diff --name-only "$1" --
  git ls-files --others --exclude-standard
}

# Lists a package and all packages that depend on it, also for tests only. The names are those of
# the folders in crates/.
dependents() {
  local name
  name=$(sed -n 's/^name = "\(.*\)"/\1/p' "crates/$1/Cargo.toml" | head -1)
  cargo tree --workspace --locked --edges normal,build,dev --prefix none --invert "$name" |
    sed -n 's|^juggler[a-z-]* v[^ ]* (.*/crates/\([a-z-]*\)).*|\1|p'
}

# Prints the packages whose tests read a file outside of their own folder in crates/.
readers() {
  case "$1" in
    schema/*) printf '%s\n' scene python-types ;;
    scenes/* | docs/scene-format.md) echo scene ;;
    crates/python/python/*) printf '%s\n' python python-types ;;
    docs/gallery.md) echo juggler ;;
    docs/viewer.md) echo viewer ;;
    Cargo.toml | Cargo.lock | clippy.toml | rustfmt.toml | check.sh | .ci/* | tests/check/*) echo all ;;
  esac
}

# Succeeds if a Rust file differs from a commit in comments alone, that is in lines that are empty
# or begin with `//`. Such lines of string literals count as comments too; the whole check finds
# errors in them.
is_commented() {
  [[ $2 == *.rs && -f $2 ]] && git cat-file -e "$1:$2" 2>/dev/null || return 1
  git diff -U0 "$1" -- "$2" |
    awk '/^[-+]/ && !/^(---|\+\+\+) / && !/^[-+][[:space:]]*(\/\/.*)?$/ { code = 1 } END { exit code }'
}

# Lists the packages to test by their folders, one per line; `all` if the change can affect all of
# them. A dependent package sees the code of a package but not its comments, which only affect the
# tests of the package itself and, as `descriptions`, the scene format.
affected_packages() {
  local base=$1 file package direct=
  while read -r file; do
    if [[ $file != crates/*/* || $file == crates/python/python/* ]]; then
      direct+="$(readers "$file")"$'\n'
    elif is_commented "$base" "$file"; then
      printf '%s\ndescriptions\n' "$(cut -d/ -f2 <<< "$file")"
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
  if grep -qE '^(crates/(session|viewer|serve)|tests/(viewer|browser|movies))/' <<< "$files"; then step_windows; fi
  if grep -q '^crates/python/' <<< "$files"; then step_python; fi
}

# Builds and runs the tests of packages, and the tests of the source tree. The build is that of the
# whole workspace, as in the whole check, so that no package is built twice with different features.
run_test_programs() {
  local package program built filter
  heading "changed: build"
  built=$(mktemp)
  # shellcheck disable=SC2046
  cargo test --workspace --locked --no-run --message-format=json-render-diagnostics $(test_targets "$@") > "$built"
  for package in "$@"; do
    filter=()
    case "$package" in
      descriptions) package=scene filter=(format:: units::) ;;
    esac
    test_programs "$package" "$built" | while read -r program; do
      heading "changed: $package, ${program##*/}"
      (cd "crates/$package" && "$program" --quiet "${filter[@]}" < /dev/null)
    done
  done
  if [[ " $* " != *" golden "* ]]; then
    heading "changed: the rules of the tree"
    (cd crates/golden && "$(test_programs golden "$built" | grep '/golden-')" --quiet tree:: words:: < /dev/null)
  fi
  rm -f "$built"
  heading "changed: examples of the documentation"
  cargo test --workspace --locked --doc --quiet
}

# Prints the flags of cargo that select the test programs of packages and of the source tree. Since
# cargo selects targets by name for all packages, a few others are built, too.
test_targets() {
  local package file
  printf '%s\n' --lib --test=golden
  for package in "$@"; do
    if [ "$package" = descriptions ]; then package=scene; fi
    for file in "crates/$package"/tests/*.rs "crates/$package"/tests/*/main.rs; do
      case "$file" in
        *'*'*) ;;
        */main.rs) basename "$(dirname "$file")" ;;
        *) basename "$file" .rs ;;
      esac
    done | sed 's/^/--test=/'
    if [ -e "crates/$package/src/main.rs" ] || [ -e "crates/$package/src/bin" ]; then echo --bins; fi
  done | sort -u
}

# Extracts the test programs of a package, one per line, from cargo's JSON messages.
test_programs() {
  sed -n "/\"package_id\":\"[^\"]*\/crates\/$1#/{/\"profile\":{[^}]*\"test\":true}/s/.*\"executable\":\"\([^\"]*\)\".*/\1/p}" "$2"
}
