#!/usr/bin/env bash
# Everything that must hold before a change lands. CI runs exactly this; cheap steps, and those
# likely to fail, come first.
#   ./check.sh                  lint, unit, features, windows and golden
#   ./check.sh STEP...          single steps: lint unit features golden windows web
#   ./check.sh changed [BASE]   lint, and the tests of every package that the changes since BASE can
#                               break; BASE is the merge base with main by default, with nothing
#                               changed since that the commit before
#   ./check.sh deep [PART...]   the long checks: dist matrix noise rays furnaces memory kills kinds
#                               fuzz bombs web cluster; parts that passed on the very same source are not run again
# CONTRIBUTING.md says what each step does and how long it takes.
set -euo pipefail
cd "$(dirname "$0")"
# shellcheck source=tests/check/steps.sh
. tests/check/steps.sh
# shellcheck source=tests/check/changed.sh
. tests/check/changed.sh
# shellcheck source=tests/check/deep.sh
. tests/check/deep.sh

usage() {
  sed -n '2,/^set/{/^#/p}' check.sh >&2
  exit 2
}

# What commands in the background print, and what could not run on this machine: one line each,
# written here and by the tests themselves.
logs=$(mktemp -d)
export JUGGLER_SKIPPED=$logs/skipped
touch "$JUGGLER_SKIPPED"
finish() {
  local process
  for process in "${background[@]}"; do kill -- "-$process" 2>/dev/null || true; done
  rm -rf "$logs"
}
trap finish EXIT
trap 'exit 130' INT TERM

case "${1:-all}" in
  all) check_all ;;
  changed) shift; check_changed "$@" ;;
  deep) shift; check_deep "$@" ;;
  *)
    for name in "$@"; do
      case "$name" in lint | unit | features | golden | windows | web) ;; *) usage ;; esac
    done
    run_steps "$@"
    ;;
esac
report
