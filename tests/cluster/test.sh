#!/usr/bin/env bash
# Runs the commands of docs/cluster.md as the page states them: on a small Slurm cluster of three
# nodes on this machine, of which one dies halfway; then with missing shards; and by a stand-in for
# ssh. Each picture must have the same bytes as that of a plain render. Needs root, since Slurm
# starts tasks as other users, and installs Debian's Slurm if it is missing.
#   tests/cluster/test.sh PATH/TO/juggler
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
page=$here/../../docs/cluster.md
juggler=$(realpath "$1")
work=$(mktemp -d)
mkdir "$work/bin"
ln -s "$juggler" "$work/bin/juggler"
export PATH=$work/bin:$PATH

# shellcheck source=tests/cluster/slurm.sh
. "$here/slurm.sh"

finish() {
  local status=$?
  trap - EXIT
  stop_slurm
  if [ "$status" = 0 ]; then rm -rf "$work"; else echo "FAILED; what is left is in $work" >&2; fi
  exit "$status"
}
trap finish EXIT
trap 'exit 130' INT TERM

say() { printf '%4d s  %s\n' "$SECONDS" "$*"; }
fail() { echo "error: $*" >&2; exit 1; }

# Prints the code block of the page with this name.
block() {
  awk -v name="$1" '/^```/ { inside = $2 == name; next } inside' "$page" | grep . || fail "the page has no block $1"
}

# Waits at most 120 seconds until a command succeeds.
until_true() {
  local start=$SECONDS
  until "$@"; do
    [ $((SECONDS - start)) -lt 120 ] || fail "in vain: $*"
    sleep 0.2
  done
}

# Makes a folder with a scene of this many samples, and the picture that one machine renders.
begin() {
  mkdir "$work/$1" && cd "$work/$1"
  sed "s/\"samples\": 16/\"samples\": $2/" "$here/scene.json" > scene.json
  juggler render scene.json -o straight.png -q
}

same() { cmp "$1" "$2" && say "$1: the bytes of one machine"; }

# Succeeds once the task on node n2 has written a checkpoint.
has_kept_something() {
  task=$(squeue -h -w n2 -t R -o %K)
  [ -n "$task" ] && [ -f "part$task.jfilm" ] && juggler info "part$task.jfilm" | grep -q 'not finished'
}

node_dies() {
  begin slurm 1024
  # Differs from the page in one respect: checkpoints every second, since this picture takes
  # seconds.
  block shards.sbatch | sed 's/--checkpoint /--checkpoint-every 1 &/' > shards.sbatch
  block slurm-submit > submit.sh
  bash -e submit.sh &
  local submitted=$!
  until_true has_kept_something
  kill_node n2
  say "n2 is dead, it was at shard $task"
  wait "$submitted"
  grep 'is done, resuming' slurm-*_"$task".out || fail "shard $task did not go on"
  same scene.png straight.png
}

shards_are_missing() {
  rm scene.png part3.jfilm part7.jfilm part8.jfilm part9.jfilm
  local status=0
  juggler merge part*.jfilm -o scene.png 2> said || status=$?
  [ "$status" = 2 ] || fail "merge ended with status $status"
  [ ! -e scene.png ] || fail "a picture without all its parts"
  diff said <(awk '/^```/ { inside = $1 == "```text"; next } inside' "$page") || fail "that is not what the page says"
  block slurm-again > again.sh
  bash -e again.sh
  same scene.png straight.png
}

frames() {
  begin frames 16
  { block shards.sbatch | grep '^#' | sed 's/0-15/0-2/'; block frames.sbatch; } > frames.sbatch
  { block shards.sbatch | grep '^#' | sed 's/0-15/0-1/'; block range.sbatch | sed 's/30/3/; s/16/2/'; } > range.sbatch
  sbatch --wait frames.sbatch
  mkdir alone && mv frame_*.png alone
  sbatch --wait range.sbatch
  block range-merge | sed 's/29/2/' > merge.sh
  bash -e merge.sh
  for frame in 0000 0001 0002; do same "frame_$frame.png" "alone/frame_$frame.png"; done
  cmp -s frame_0000.png frame_0001.png && fail "nothing moves"
  same frame_0000.png straight.png
}

# Uses three hosts of which one is down: first its shards are missing, then it is left out.
by_ssh() {
  begin ssh 16
  cat > "$work/bin/ssh" <<'END'
#!/bin/sh
[ "$2" != dead ] && exec sh -c "$3"
echo "ssh: no route to host $2" >&2
exit 255
END
  chmod +x "$work/bin/ssh"
  printf '%s\n' one dead two > hosts
  # Differs from the page in one respect: does not wait a minute for a dead host.
  block ssh-shards | sed 's/sleep 60/sleep 3/' > shards.sh
  bash -e shards.sh && fail "a host was dead, and nobody noticed"
  [ ! -e scene.png ] || fail "a picture without all its parts"
  printf '%s\n' one two > hosts
  bash -e shards.sh
  same scene.png straight.png
}

by_ssh
start_slurm
say "Slurm runs on three nodes"
node_dies
shards_are_missing
frames
say "all is well"
