#!/usr/bin/env bash
# Decodes movies with other programs: shows MP4, WebP, APNG and GIF files of one animation in a real
# browser and, if they are installed, reads them with ffprobe and ffmpeg. Checks lengths, sizes,
# seeking, and colors against those of the frames as PNG.
#   tests/movies/test.sh PATH/TO/juggler [FOLDER FOR THE MOVIES]
# Needs node, npm (playwright-core, pinned by the lock file of tests/browser) and Chromium:
#   apt-get install -y chromium nodejs npm
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
juggler=$(realpath "${1:?usage: tests/movies/test.sh PATH/TO/juggler [FOLDER]}")
folder=$(realpath -m "${2:-$(mktemp -d)}")
mkdir -p "$folder"

missing() { echo "error: $1 is missing: apt-get install -y $2" >&2; exit 3; }
command -v node >/dev/null || missing node nodejs
command -v npm >/dev/null || missing npm npm
chromium=${CHROMIUM:-$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)}
[ -n "$chromium" ] || missing Chromium chromium

cd "$here/../browser"
if [ ! -d node_modules/playwright-core ]; then npm ci --no-audit --no-fund --silent; fi
exec node "$here/test.mjs" "$juggler" "$chromium" "$folder"
