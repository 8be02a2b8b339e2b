# `check.sh deep`: what takes too long for every change. Each part takes an hour at most.
# shellcheck shell=bash

deep_parts=(dist matrix noise rays furnaces memory kills kinds fuzz bombs web cluster)

check_deep() {
  local part
  for part in "$@"; do
    [[ " ${deep_parts[*]} " == *" $part "* ]] || { echo "no part is called \`$part\`: ${deep_parts[*]}" >&2; exit 2; }
  done
  [ $# -gt 0 ] || set -- "${deep_parts[@]}"
  for part in "$@"; do once "$part"; done
}

# Names the source as it is: the commit, what differs from it, and files that git does not know yet.
source_id() {
  { git rev-parse HEAD; git diff HEAD; git ls-files --others --exclude-standard -z | xargs -0 -r sha256sum; } | sha256sum | cut -d' ' -f1
}

# Runs a part, unless it passed on this very source: a run that was broken off goes on where it was.
once() {
  local part=$1 passed=$programs/deep/$1 source
  source=$(source_id)
  heading "deep: $part"
  if [ "$(cat "$passed" 2>/dev/null)" = "$source" ]; then
    echo "passed already, on the same source"
    return
  fi
  "deep_$part"
  mkdir -p "$programs/deep"
  echo "$source" > "$passed"
}

# All hashes by the very profile that is shipped, and the size of the program.
deep_dist() {
  local size
  cargo test --profile dist --locked -p juggler-golden --test golden -- hashes:: hits:: matrix::
  cargo build --profile dist --locked -p juggler-cli
  size=$(stat -c %s "$programs/dist/juggler")
  echo "the program has $size bytes"
  [ "$size" -lt 20000000 ] || { echo "error: the program has 20 MB or more" >&2; return 1; }
}

# All scenes and larger pictures on all threads, vector units, orders and shards.
deep_matrix() { JUGGLER_MATRIX=wide cargo test --release --locked -p juggler-golden --test golden -- matrix::; }

# Whether `--noise` keeps its word, on more scenes, against longer references.
deep_noise() { JUGGLER_NOISE=all cargo test --release --locked -p juggler-golden --test golden -- --nocapture noise::; }

# A million rays a case against brute force, and 100,000 that leave each shape.
deep_rays() {
  JUGGLER_RAYS=1_000_000 cargo test --release --locked -p juggler-bvh
  JUGGLER_HITS=1000 cargo test --release --locked -p juggler-world --lib precision
}

# White furnaces over whole grids of every material's parameters, room furnaces of every shape that emits, and heaps of 1 to 40
# balls with the machinery for caustics and without.
deep_furnaces() {
  JUGGLER_FURNACES=all cargo test --release --locked -p juggler-bsdf --lib contract::white
  JUGGLER_FURNACES=all cargo test --release --locked -p juggler-render --test integration -- white_worlds:: white_kinds:: rooms:: balls::
}

# What `--max-memory` promises, by an optimized program: the check itself asks an unoptimized one.
deep_memory() { cargo test --release --locked -p juggler-cli --test program -- memory::; }

# Renders killed at random moments and continued.
deep_kills() { cargo run --release --locked -p juggler-golden --bin kill-test -- 100 1; }

# A new kind of every family, added to a copy of the source, which is built and renders with it.
deep_kinds() { JUGGLER_KINDS=all cargo test --locked -p juggler-golden --test golden -- kinds::; }

# 28,000 mutations of files, and 20,000 scenes whose numbers are extreme, in processes whose address space is limited.
deep_fuzz() { JUGGLER_MUTATIONS=2000 JUGGLER_FIELDS=20000 cargo test --release --locked -p juggler-fuzz --test hostile; }

# Small files and command lines that ask for much, given to the optimized program.
deep_bombs() {
  cargo build --release --locked -p juggler-cli
  cargo run --release --locked -p juggler-fuzz --bin bombs -- "$programs/release/juggler"
}

# The page that renders in the browser alone; its compiler and standard library are large downloads.
deep_web() { step_web; }

# The commands of docs/cluster.md on a small Slurm of its own; as root.
deep_cluster() {
  cargo build --release --locked -p juggler-cli
  tests/cluster/test.sh "$programs/release/juggler"
}
