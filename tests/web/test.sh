#!/usr/bin/env bash
# The page of web/dist driven in a real browser, from a plain file server: hashes of scenes equal to those of the program,
# dropped files, flying, saving, mistakes, a phone, and that two workers are faster than one. After web/build.sh.
#   tests/web/test.sh PATH/TO/juggler [FOLDER FOR SCREENSHOTS]
# Needs node, npm (one package, playwright-core, by the lock file) and Chromium: apt-get install -y chromium nodejs npm
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
