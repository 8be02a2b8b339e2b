#!/usr/bin/env bash
# Drives the window of `juggler view` as a person would, on a virtual display: keys, drags, the
# wheel, fields, dropped files, and a file that is edited meanwhile. The window's title and screenshots show the
# effects.
#   tests/viewer/test.sh PATH/TO/juggler [FOLDER FOR THE SCREENSHOTS]
# Needs Xvfb, xdotool, ImageMagick's import, python3, and the libraries of windows. On Debian:
#   apt-get install xvfb xdotool imagemagick libgl1 libgl1-mesa-dri libx11-xcb1 libxcursor1 libxi6 \
#     libxkbcommon-x11-0
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
juggler=$(realpath "$1")
work=$(mktemp -d)
shots=${2:-$work}
mkdir -p "$shots"
for tool in Xvfb xdotool import python3; do
  command -v "$tool" >/dev/null || { echo "error: $tool is not installed (apt-get install xvfb xdotool imagemagick python3)" >&2; exit 1; }
done

viewer= server=
finish() {
  local status=$?
  trap - EXIT
  for process in $viewer $server; do kill "$process" 2>/dev/null || true; done
  if [ "$status" = 0 ]; then rm -rf "$work"; else echo "FAILED; what is left is in $work and $shots" >&2; fi
  exit "$status"
}
trap finish EXIT
trap 'exit 130' INT TERM

say() { printf '%4d s  %s\n' "$SECONDS" "$*"; }
fail() { echo "error: $*" >&2; exit 1; }

# Waits at most 60 seconds until a command succeeds.
until_true() {
  local start=$SECONDS
  until "$@"; do
    [ $((SECONDS - start)) -lt 60 ] || fail "in vain: $* (the title is '$(title)')"
    sleep 0.05
  done
}

title() { xdotool getwindowname "$window" 2>/dev/null || true; }
titled() { [[ $(title) == $1 ]]; }
finished() { titled "juggler - scene - frame * - 16/16"; }

# Screenshots of the whole window and of the picture alone; the panel is 316 pixels wide, the
# timeline 34 pixels high. The files contain no dates, so equal pictures are equal files.
grab() { import -window "$window" -define png:exclude-chunks=date,time "$@"; }
shoot() { grab "PNG24:$shots/$1.png"; }
shoot_picture() { grab -crop 900x700+0+0 +repage "PNG24:$shots/$1.png"; }
equal() { cmp -s "$shots/$1.png" "$shots/$2.png"; }
rmse() { "$juggler" compare "$shots/$1.png" "$shots/$2.png" --tolerance 0 | awk '/^RMSE/ { print $2 }' || true; }
differ() { ! equal "$1" "$2" && awk -v e="$(rmse "$1" "$2")" 'BEGIN { exit !(e > 0.01) }'; }
same() { equal "$1" "$2" || "$juggler" compare "$shots/$1.png" "$shots/$2.png" >/dev/null; }

# The display shows an image some time after the program has drawn it, later on a busy machine. So
# take screenshots until the picture equals an earlier one, or differs from it.
shot_like() { shoot_picture "$2" && same "$1" "$2"; }
shot_unlike() { shoot_picture "$2" && differ "$1" "$2"; }
like() { until_true shot_like "$1" "$2"; }
unlike() { until_true shot_unlike "$1" "$2"; }
shot_again() { cp "$shots/$1.png" "$shots/last.png" && shoot_picture "$1" && same last "$1"; }
# Takes a screenshot of the picture as soon as it no longer changes.
steady() { shoot_picture "$1"; until_true shot_again "$1"; }
small() { [[ $(xdotool getwindowgeometry "$window") == *700x500* ]]; }

point() { xdotool mousemove --window "$window" "$1" "$2"; sleep 0.2; }
# Drags from one point to another: X Y X Y BUTTON.
drag() {
  point "$1" "$2"
  xdotool mousedown "$5"; sleep 0.1
  for step in 1 2 3 4; do
    xdotool mousemove --window "$window" $(($1 + ($3 - $1) * step / 4)) $(($2 + ($4 - $2) * step / 4)); sleep 0.05
  done
  xdotool mouseup "$5"; sleep 0.1
}
hold() { xdotool keydown "$1"; sleep 0.4; xdotool keyup "$1"; }
press() { xdotool key "$1"; sleep 0.15; }
# Waits until the picture is finished again after a change.
settle() { sleep 0.3; until_true finished; sleep 0.3; }
# Returns to the first view.
home() { press Home; point 5 5; like start back; }

find_window() { window=$(xdotool search --pid "$viewer" --name juggler 2>/dev/null | tail -1); [ -n "$window" ]; }
has_focus() { xdotool windowfocus "$window" 2>/dev/null && [ "$(xdotool getwindowfocus 2>/dev/null)" = "$window" ]; }
open() {
  "$juggler" view "$@" 2>"$work/stderr" &
  viewer=$!
  until_true find_window
  until_true has_focus
  sleep 0.5
}
# Checks that the program ends without a message after its window was closed.
ended() {
  local status=0
  wait "$viewer" || status=$?
  viewer=
  [ "$status" = 0 ] || fail "the viewer ended with status $status: $(cat "$work/stderr")"
  [ ! -s "$work/stderr" ] || fail "the viewer wrote: $(cat "$work/stderr")"
}

window=
status=0
env -u DISPLAY -u WAYLAND_DISPLAY -u WAYLAND_SOCKET "$juggler" view one-sphere 2>"$work/none" || status=$?
[ "$status" = 3 ] && grep -q '^error: no window' "$work/none" && ! grep -q panicked "$work/none" ||
  fail "without a display: status $status, $(cat "$work/none")"
say "without a display: an error and status 3"

# Without `-noreset`, the display resets when its last client leaves, and refuses clients meanwhile.
mkfifo "$work/display"
Xvfb -displayfd 7 -screen 0 1280x800x24 -nolisten tcp -noreset 7>"$work/display" 2>/dev/null &
server=$!
read -r number < "$work/display"
export DISPLAY=:$number

cd "$work"
cp "$here/scene.json" scene.json
open scene.json --threads 2
until_true finished
sleep 0.5
steady start
shoot first
say "the first picture: $(title)"

drag 300 300 420 340 1; settle; unlike start looked
home
say "a drag looks around, Home goes back"
for key in w a e j i u x; do
  hold "$key"; settle; unlike start "key-$key"
  home
done
say "keys move and turn"
point 450 350; xdotool click 4; xdotool click 4; settle; unlike start zoomed
home
say "the wheel zooms"
xdotool keydown shift; drag 300 300 400 300 1; xdotool keyup shift; settle; unlike start slid
home
drag 300 300 400 300 2; settle; unlike start slid-middle
home
press m; drag 300 300 420 340 1; settle; unlike start orbited; unlike looked orbited
press m; home
say "Shift and the middle button slide, M orbits"
point 480 400; xdotool click --repeat 2 --delay 60 1; settle; unlike start framed
home
say "a double click brings an object into view"

point 480 380; press p; sleep 0.3; unlike start probed
press Escape; point 5 5; sleep 0.3; like start back
press 3; settle; unlike start normals
press 1; like start back
press bracketright; settle; unlike start brighter
press bracketleft; like start back
say "the probe, normals, exposure"

xdotool keydown r; drag 300 300 500 450 1; xdotool keyup r; unlike start region
press t; point 5 5; like start back
say "a region is drawn up and given up"

drag 74 783 420 783 1; settle; unlike start later
titled "juggler - scene - frame 0 - *" && fail "the slider did not move time: $(title)"
home
press period; until_true titled "juggler - scene - frame 1 - *"
press comma; until_true titled "juggler - scene - frame 0 - *"; settle
press space; until_true titled "juggler - scene - frame [5-9]* - *"; press space; settle
home
say "the slider, single frames, play and stop"

sed 's/"sphere", "material": "red"/"spere", "material": "red"/' "$here/scene.json" > next && mv next scene.json
until_true titled "* - error"; sleep 0.4; shoot mistake; unlike start mistake-picture
sed 's/#c02020/#20a040/' "$here/scene.json" > next && mv next scene.json
unlike mistake-picture green; settle; unlike start green
cp "$here/scene.json" scene.json; like start back
say "a mistake in the file is shown over the picture until it is mended; edits show"

press question; sleep 0.3; shoot help; unlike start help-picture
press Escape; sleep 0.3; like start back
press Tab; sleep 0.5; shoot folded; press Tab; sleep 0.5; like start back
say "the keys under ?, the panel folds"

press ctrl+s; until_true test -s scene.png; unlike start saved-picture; shoot saved; like start back
say "a message over the picture names the saved file for a while"
"$juggler" render scene.json -o straight.png -q
"$juggler" compare scene.png straight.png >/dev/null || fail "the saved picture is not that of juggler render"
say "the saved picture is that of juggler render"

"$juggler" render scene.json --denoise -o denoised.png -q
! "$juggler" compare straight.png denoised.png >/dev/null || fail "denoising shows in nothing"
saves_denoised() { rm -f scene.png; press ctrl+s; sleep 0.5; "$juggler" compare scene.png denoised.png >/dev/null 2>&1; }
press n; until_true saves_denoised; shoot denoised
press n; like start back
say "N shows the picture that juggler render --denoise writes"

ticks() { awk '{ print $14 + $15 }' "/proc/$viewer/stat"; }
# Other work on the machine may delay the last frame, so one quiet interval of ten is enough.
idle() { local before; before=$(ticks); sleep 4; used=$(($(ticks) - before)); [ "$used" -le 4 ]; }
for try in 1 2 3 4 5 6 7 8 9 10; do
  if idle; then break; fi
  [ "$try" -lt 10 ] || fail "idle, but 4 seconds took $used ticks of the processor, ten times"
done
say "idle: $used ticks of the processor in 4 seconds"

xdotool windowsize "$window" 700 500; until_true small; sleep 1; shoot small
xdotool windowsize "$window" 1280 800; point 5 5; like start back
say "the window shrinks and grows"

press g; unlike start chooser-picture; sleep 2; shoot chooser
xdotool type --delay 40 pool; sleep 0.5; shoot chooser-pool; press Return
until_true titled "juggler - scalablitz-pool - [0-9]*/*"; sleep 1; unlike start pool
say "another scene: $(title)"

cp "$here/../../scenes/models/robot.glb" .
python3 "$here/drop.py" "$window" robot.glb
until_true titled "juggler - robot - frame 0 - [1-9]*"; sleep 1; unlike pool dropped-glb-picture; shoot dropped-glb
mkdir -p parts
python3 "$here/split.py" robot.glb "parts/of a robot.gltf"
python3 "$here/drop.py" "$window" "parts/of a robot.gltf"
until_true titled "juggler - of a robot - frame 0 - [1-9]*"; sleep 1; unlike pool dropped-gltf-picture; shoot dropped-gltf
head -c 100 robot.glb > broken.glb
python3 "$here/drop.py" "$window" broken.glb
until_true titled "* - error"; sleep 0.4; shoot dropped-broken
say "models are dropped on the window, as one file and as several"

press ctrl+q; ended
say "Ctrl+Q: status 0"
open; until_true titled "juggler - juggler - *"; sleep 2; shoot choice
press Escape; press ctrl+q; ended
say "without a scene there is a choice"
