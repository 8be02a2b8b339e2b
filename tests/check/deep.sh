# `check.sh deep`: checks that take too long for every change, each part an hour and a quarter at
# most on two cores.
# shellcheck shell=bash

deep_parts=(dist matrix noise rays furnaces memory cancelling kills kinds fuzz bombs web python cluster
  gltf aovs flip metals samplers denoising peers)

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

# Runs a part unless it passed on the same source, so that an interrupted run can continue. A part
# that lacks a tool sets `is_left_out` and counts as not run.
once() {
  local part=$1 passed=$programs/deep/$1 source is_left_out=
  source=$(source_id)
  heading "deep: $part"
  if [ "$(cat "$passed" 2>/dev/null)" = "$source" ]; then
    echo "passed already, on the same source"
    return
  fi
  "deep_$part"
  [ -z "$is_left_out" ] || return 0
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
deep_matrix() { JUGGLER_MATRIX=wide cargo test "${golden_optimized[@]}" -- matrix::; }

# Compares the error that `--noise` requests with the true error, on more scenes and with longer
# references.
deep_noise() { JUGGLER_NOISE=all cargo test "${golden_optimized[@]}" -- --nocapture noise::; }

# Compares a million rays per case with brute force, and traces 100,000 rays from each shape.
deep_rays() {
  JUGGLER_RAYS=1_000_000 cargo test --release --locked -p juggler-bvh
  JUGGLER_HITS=1000 cargo test --release --locked -p juggler-world --lib precision
}

# Runs white furnaces over whole grids of every material's parameters, furnaces in rooms with every
# emissive shape, heaps of 1 to 40 specular spheres with and without specular paths, and 200 stacks of
# touching surfaces in all orders.
deep_furnaces() {
  JUGGLER_FURNACES=all cargo test --release --locked -p juggler-bsdf --lib contract::white
  JUGGLER_FURNACES=all cargo test --release --locked -p juggler-render --test integration -- touching white_worlds:: white_kinds:: rooms:: caustics::
}

# Tests `--max-memory` with the optimized program; the step `unit` tests the unoptimized one.
deep_memory() { cargo test --release --locked -p juggler-cli --test program -- memory::; }

# Cancels builds of ten million triangles and measures the CPU time after that.
deep_cancelling() {
  JUGGLER_TRIANGLES=10_000_000 cargo test --release --locked -p juggler --test integration -- --nocapture cancelling::
}

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

# Installs Python packages into an environment of their own, once; `$python` is its interpreter.
# Leaves out the part `$1` if that fails.
python_with() {
  local part=$1 folder=$programs/deep/python-$1
  shift
  python=$folder/bin/python
  [ ! -e "$folder/complete" ] || return 0
  if python3 -m venv "$folder" && "$folder/bin/pip" install --quiet "$@"; then
    touch "$folder/complete"
  else
    leave_out "$part: its Python packages cannot be installed ($*)"
    return 1
  fi
}

leave_out() {
  is_left_out=yes
  skip "$1"
}

# Prints the folder for the pictures of a part, which belong to this source alone.
pictures_of() {
  local folder
  folder=$programs/deep/pictures-$1/$(source_id)
  mkdir -p "$folder"
  echo "$folder"
}

# Compares the glTF importer with other programs on the committed models. The part `speed` prints
# times only.
deep_gltf() {
  local parts=(models numbers meshes movie extensions malformed)
  python_with gltf -r tests/gltf/requirements.txt || return 0
  if command -v npm >/dev/null && npm install --silent --no-package-lock --prefix tests/gltf; then
    parts+=(tangents encodings)
  else
    leave_out "gltf: tangents and encodings: packages of Node.js cannot be installed (apt-get install nodejs npm)"
  fi
  cargo build --release --locked -p juggler-cli --features ktx2
  "$python" tests/gltf/agree.py "$programs/release/juggler" scenes/models "${parts[@]}"
}

# Reads all AOVs with OpenEXR and OpenImageIO.
deep_aovs() {
  python_with aovs -r tests/aovs/requirements.txt || return 0
  cargo build --release --locked -p juggler-cli
  "$python" tests/aovs/agree.py "$programs/release/juggler"
}

# Compares FLIP with the evaluator of its authors.
deep_flip() {
  local pairs
  python_with flip flip-evaluator==1.7 || return 0
  pairs=$(realpath "$(pictures_of flip)")
  JUGGLER_FLIP_PICTURES=$pairs cargo test --release --locked -p juggler-imaging --lib -- flip::tests::flip_matches
  cargo build --release --locked -p juggler-cli
  "$python" tests/flip/agree.py "$pairs" "$programs/release/juggler"
}

# Derives the named metals from the tables of refractiveindex.info. JUGGLER_METALS names the folder
# `database/data` of that database.
deep_metals() {
  if [ -z "${JUGGLER_METALS:-}" ]; then
    leave_out "metals: JUGGLER_METALS does not name the tables of refractiveindex.info"
    return
  fi
  python_with metals -r tests/metals/requirements.txt || return 0
  "$python" tests/metals/derive.py "$JUGGLER_METALS"
}

# Prints the tables of docs/samplers.md.
deep_samplers() {
  local folder
  python_with samplers numpy==2.4.6 || return 0
  cargo build --release --locked -p juggler-cli
  folder=$(pictures_of samplers)
  "$python" tests/samplers/error_table.py "$programs/release/juggler" "$folder/errors"
  "$python" tests/samplers/noise_table.py "$programs/release/juggler" "$folder/noise"
}

# Checks that the denoiser keeps the mean and leaves no bright pixels, and prints the table of
# docs/denoising.md.
deep_denoising() {
  local folder
  cargo build --release --locked -p juggler-cli
  folder=$(pictures_of denoising)
  python3 tests/denoising/conservation.py "$programs/release/juggler" "$folder/means"
  python3 tests/denoising/table.py "$programs/release/juggler" "$folder/table"
}

# Compares pictures with those of Mitsuba and Cycles. JUGGLER_PEERS names the comparison pack, and
# JUGGLER_PEER_SCENES its scenes (docs/benchmarks.md); JUGGLER_PEER_PYTHON has numpy and Pillow.
deep_peers() {
  if [ ! -d "${JUGGLER_PEERS:-}" ] || [ ! -d "${JUGGLER_PEER_SCENES:-}" ]; then
    leave_out "peers: JUGGLER_PEERS and JUGGLER_PEER_SCENES do not name the comparison pack and its scenes"
    return
  fi
  cargo build --release --locked -p juggler-cli
  OURS_BIN=$programs/release/juggler "${JUGGLER_PEER_PYTHON:-python3}" tests/peers/agree.py \
    "$JUGGLER_PEERS" "$JUGGLER_PEER_SCENES" "$(pictures_of peers)"
}
