#!/usr/bin/env bash
# Runs all checks that a change must pass, as CI does. Steps that are cheap or likely to fail come
# first.
#   ./check.sh                  runs lint, unit, features, python, windows and golden
#   ./check.sh STEP...          runs single steps: lint unit python features golden windows web
#   ./check.sh changed [BASE]   runs lint and the tests of every package that the changes since BASE
#                               can break; the default BASE is the merge base with main, or the
#                               previous commit if nothing has changed since the merge base
#   ./check.sh deep [PART...]   runs the long checks: dist matrix noise rays furnaces memory
#                               cancelling kills kinds fuzz bombs web python cluster, and beside
#                               other programs gltf aovs flip metals samplers denoising peers; a
#                               part that passed on the same source does not run again
# CONTRIBUTING.md describes each step and its duration.
set -euo pipefail
cd "$(dirname "$0")"
# shellcheck source=tests/check/steps.sh
. tests/check/steps.sh
# shellcheck source=tests/check/python.sh
. tests/check/python.sh
# shellcheck source=tests/check/changed.sh
. tests/check/changed.sh
# shellcheck source=tests/check/deep.sh
. tests/check/deep.sh
# shellcheck source=tests/check/deep_python.sh
. tests/check/deep_python.sh

usage() {
  sed -n '2,/^set/{/^#/p}' check.sh >&2
  exit 2
}

# Folder for the output of background commands. The file `skipped` has one line for each check that
# this machine cannot run; this script and the tests append to it.
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
      case "$name" in lint | unit | python | features | golden | windows | web) ;; *) usage ;; esac
    done
    run_steps "$@"
    ;;
esac
report
