# `check.sh changed`: what a change can break, by the graph of packages.
# shellcheck shell=bash

# The commit that a change is compared with: where the branch left main, on main itself the commit before.
changed_base() {
  local base
  base=$(git merge-base HEAD main 2>/dev/null || git merge-base HEAD origin/main 2>/dev/null || true)
  if [ -z "$base" ] || [ "$base" = "$(git rev-parse HEAD)" ]; then base=$(git rev-parse HEAD~1 2>/dev/null || git rev-parse HEAD); fi
  echo "$base"
}

# Files that differ from a commit, those included that git does not know yet.
changed_files() {
  git diff --name-only "$1" --
  git ls-files --others --exclude-standard
}

# A package and all packages that build on it, tests included; packages are named by their folders in crates/.
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

# The packages to test, one a line, by their folders; `all` where everything may be concerned.
affected_packages() {
  local file direct
  direct=$(while read -r file; do
    case "$file" in
      crates/*/*) cut -d/ -f2 <<< "$file" ;;
      *) readers "$file" ;;
    esac
  done | sort -u)
  if grep -qx all <<< "$direct"; then echo all; return; fi
  while read -r package; do [ -z "$package" ] || dependents "$package"; done <<< "$direct" | sort -u
}

check_changed() {
  local base files packages
  base=$(git rev-parse --verify "${1:-$(changed_base)}")
  files=$(changed_files "$base" | sort -u)
  packages=$(affected_packages <<< "$files")
  heading "changed since $(git log -1 --format='%h %s' "$base")"
  echo "packages to test: ${packages//$'\n'/, }"
  step_lint
  if [ "$packages" = all ]; then
    step_unit
    run_test_programs golden
  elif [ -n "$packages" ]; then
    # shellcheck disable=SC2086
    run_test_programs $packages
  fi
  if grep -qE '^(crates/(session|viewer|serve)|tests/(viewer|browser|films))/' <<< "$files"; then step_windows; fi
}

# Builds all tests together, as the whole check does, so that nothing is built twice in two shapes; runs those of packages.
run_test_programs() {
  local package program built
  heading "changed: build"
  built=$(mktemp)
  cargo test --workspace --locked --no-run --message-format=json-render-diagnostics > "$built"
  for package in "$@"; do
    sed -n "/\"package_id\":\"[^\"]*\/crates\/$package#/{/\"profile\":{[^}]*\"test\":true}/s/.*\"executable\":\"\([^\"]*\)\".*/\1/p}" "$built" |
      while read -r program; do
        heading "changed: $package, ${program##*/}"
        (cd "crates/$package" && "$program" --quiet </dev/null)
      done
  done
  rm -f "$built"
}
