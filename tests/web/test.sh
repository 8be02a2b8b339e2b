#!/usr/bin/env bash
# Drives the page of web/dist in a real browser, from a plain file server: compares hashes of scenes
# with those of the program, drops files, flies, saves, makes errors, emulates a phone, and checks
# that two workers are faster than one. Run web/build.sh first.
#   tests/web/test.sh PATH/TO/juggler [FOLDER FOR SCREENSHOTS]
# Needs node, npm (one package, playwright-core, pinned by the lock file) and Chromium:
#   apt-get install -y chromium nodejs npm
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
juggler=$(realpath "${1:?usage: tests/web/test.sh PATH/TO/juggler [FOLDER]}")
pictures=$(realpath -m "${2:-$(mktemp -d)}")
mkdir -p "$pictures"

missing() { echo "error: $1 is missing: $2" >&2; exit 3; }
[ -f "$here/../../web/dist/index.html" ] || missing web/dist "web/build.sh makes it"
command -v node >/dev/null || missing node "apt-get install -y nodejs"
command -v npm >/dev/null || missing npm "apt-get install -y npm"
chromium=${CHROMIUM:-$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)}
[ -n "$chromium" ] || missing Chromium "apt-get install -y chromium"

cd "$here"
if [ ! -d node_modules/playwright-core ]; then npm ci --no-audit --no-fund --silent; fi
exec node test.mjs "$juggler" "$chromium" "$pictures"
