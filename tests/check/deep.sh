# `check.sh deep`: checks that take too long for every change, each part at most an hour.
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

# Prints a hash of the source: the commit, the difference to it, and untracked files.
source_id() {
  { git rev-parse HEAD; git diff HEAD; git ls-files --others --exclude-standard -z | xargs -0 -r sha256sum; } | sha256sum | cut -d' ' -f1
}

# Runs a part unless it passed on the same source, so that an interrupted run can continue.
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

# Tests all hashes with the profile `dist`, and the size of the program without `ktx2`; the program
# that is shipped has it.
deep_dist() {
  local size
  cargo test --profile dist --locked -p juggler-golden --test golden -- hashes:: hits:: matrix::
  cargo build --profile dist --locked -p juggler-cli
  size=$(stat -c %s "$programs/dist/juggler")
  echo "the program has $size bytes"
  [ "$size" -lt 23000000 ] || { echo "error: the program has 23 MB or more" >&2; return 1; }
  cargo build --profile dist --locked -p juggler-cli --features ktx2
  echo "the program with ktx2 has $(stat -c %s "$programs/dist/juggler") bytes"
}

# Renders all scenes, and larger pictures, on all threads, vector units, orders and shards.
deep_matrix() { JUGGLER_MATRIX=wide cargo test --release --locked -p juggler-golden --test golden -- matrix::; }

# Compares the error that `--noise` requests with the true error, on more scenes and with longer
# references.
deep_noise() { JUGGLER_NOISE=all cargo test --release --locked -p juggler-golden --test golden -- --nocapture noise::; }

# Compares a million rays per case with brute force, and traces 100,000 rays from each shape.
deep_rays() {
  JUGGLER_RAYS=1_000_000 cargo test --release --locked -p juggler-bvh
  JUGGLER_HITS=1000 cargo test --release --locked -p juggler-world --lib precision
}

# Runs white furnaces over whole grids of every material's parameters, furnaces in rooms with every
# emissive shape, and heaps of 1 to 40 specular spheres with and without specular paths.
deep_furnaces() {
  JUGGLER_FURNACES=all cargo test --release --locked -p juggler-bsdf --lib contract::white
  JUGGLER_FURNACES=all cargo test --release --locked -p juggler-render --test integration -- white_worlds:: white_kinds:: rooms:: caustics::
}

# Tests `--max-memory` with the optimized program; the step `unit` tests the unoptimized one.
deep_memory() { cargo test --release --locked -p juggler-cli --test program -- memory::; }

# Kills renders at random times and resumes them.
deep_kills() { cargo run --release --locked -p juggler-golden --bin kill-test -- 100 1; }

# Adds a new kind of every family to a copy of the source, builds it, and renders with each.
deep_kinds() { JUGGLER_KINDS=all cargo test --locked -p juggler-golden --test golden -- kinds::; }

# Reads 28,000 mutated files and 20,000 scenes with extreme numbers, in processes of limited address
# space.
deep_fuzz() { JUGGLER_MUTATIONS=2000 JUGGLER_FIELDS=20000 cargo test --release --locked -p juggler-fuzz --test hostile; }

# Gives the optimized program small files and command lines that claim or request much.
deep_bombs() {
  cargo build --release --locked -p juggler-cli
  cargo run --release --locked -p juggler-fuzz --bin bombs -- "$programs/release/juggler"
}

# Builds and drives the page that renders in the browser alone. Its compiler and standard library
# are large downloads.
deep_web() { step_web; }

# Runs the commands of docs/cluster.md on a small Slurm cluster of its own; needs root.
deep_cluster() {
  cargo build --release --locked -p juggler-cli
  tests/cluster/test.sh "$programs/release/juggler"
}
