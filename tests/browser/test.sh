#!/usr/bin/env bash
# Drives the page of `juggler serve` in a real browser: the first picture, drags, keys, scenes,
# edits of the file, errors, a server that restarts, two pages of which one steers, a phone, and
# saving. It also measures the latency from a key to the picture.
#   tests/browser/test.sh PATH/TO/juggler [FOLDER FOR SCREENSHOTS]
# Needs node, npm (one package, playwright-core, pinned by the lock file) and Chromium:
#   apt-get install -y chromium nodejs npm
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
juggler=$(realpath "${1:?usage: tests/browser/test.sh PATH/TO/juggler [FOLDER]}")
pictures=${2:-$(mktemp -d)}
mkdir -p "$pictures"

missing() { echo "error: $1 is missing: apt-get install -y $2" >&2; exit 3; }
command -v node >/dev/null || missing node nodejs
command -v npm >/dev/null || missing npm npm
chromium=${CHROMIUM:-$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)}
[ -n "$chromium" ] || missing Chromium chromium

cd "$here"
if [ ! -d node_modules/playwright-core ]; then npm ci --no-audit --no-fund --silent; fi
exec node test.mjs "$juggler" "$chromium" "$pictures"
