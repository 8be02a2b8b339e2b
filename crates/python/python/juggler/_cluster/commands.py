"""Scripts for batch systems, whose machines run the program (docs/cluster.md)."""

import os
import shlex

from juggler import _native
from juggler._errors import SettingsError
from juggler._movie import _flags

_SLURM = """\
#!/bin/bash
# Renders {scene} in {shards} shards with Slurm, and merges them. Run it again after a failure.
set -e
sbatch --wait <<'END'
#!/bin/bash
#SBATCH --job-name=juggler
#SBATCH --array=0-{last}
#SBATCH --cpus-per-task=8
#SBATCH --mem=4G
#SBATCH --requeue
#SBATCH --open-mode=append
part={stem}-$SLURM_ARRAY_TASK_ID.jfilm
exec juggler render {words} --shard auto/{shards} --checkpoint "$part" -o "$part" \\
    --threads "$SLURM_CPUS_PER_TASK" --max-memory "${{SLURM_MEM_PER_NODE}}M"
END
"""

_HYPERQUEUE = """\
#!/bin/bash
# Renders {scene} in {shards} shards with HyperQueue, and merges them. Run it again after a failure.
set -e
hq submit --array 0-{last} --cpus 8 --wait -- sh -c '
    part={stem}-$HQ_TASK_ID.jfilm
    exec juggler render {quoted} --shard auto/{shards} --checkpoint "$part" -o "$part" \\
        --threads 8 --max-memory 4G'
"""

_SSH = """\
#!/bin/bash
# Renders {scene} in {shards} shards on the machines that the file `hosts` names, one in a line, and merges
# them. All machines access this folder under the same path. Run it again after a failure.
set -e
export hosts="$(cat hosts)"
seq 0 {last} | xargs -P "$(wc -l < hosts)" --process-slot-var=SLOT -I{{}} bash -c '
    mapfile -t host <<< "$hosts"
    ssh -n "${{host[SLOT]}}" "cd \\"$PWD\\" && juggler render {quoted} --shard {{}}/{shards} \\
        --checkpoint {stem}-{{}}.jfilm -o {stem}-{{}}.jfilm" || {{ sleep 60; exit 1; }}'
"""

_MERGE = "juggler merge {parts} -o {output}\n"

_SYSTEMS = {"slurm": _SLURM, "hyperqueue": _HYPERQUEUE, "ssh": _SSH}


def script(scene, shards, system, output, settings):
    """Returns the script, see `juggler.cluster.commands`."""
    if system not in _SYSTEMS:
        known = ", ".join(f'"{name}"' for name in _SYSTEMS)
        raise SettingsError(f"`system` must be one of {known}, not {system!r}")
    if not isinstance(scene, (str, os.PathLike)):
        raise SettingsError(
            "the machines of a batch system read a scene file: save the scene, and give its path"
        )
    if not isinstance(shards, int) or not 1 <= shards <= 100_000:
        raise SettingsError(f"`shards` must be a number from 1 to 100,000, not {shards!r}")
    for name in ("time", "threads", "max_memory"):
        if settings.get(name) is not None:
            raise SettingsError(f"`{name}` is no setting of the script: each system has its own limits")
    if settings.get("sampler") is not None or not isinstance(settings.get("camera", ""), (str, type(None))):
        raise SettingsError("the program has no flag for `sampler` and for cameras that are no names")
    _native.check_settings({name: value for name, value in settings.items() if name != "progress"})
    words = [os.fspath(scene), *_words(settings)]
    stem = shlex.quote(os.path.splitext(os.path.basename(os.fspath(scene)))[0])
    quoted = " ".join(map(shlex.quote, words))
    values = {
        "scene": os.fspath(scene),
        "shards": shards,
        "last": shards - 1,
        "stem": stem,
        "words": quoted,
        # Within the quotes of `sh -c '...'`.
        "quoted": quoted.replace("'", "'\\''"),
    }
    parts = " ".join(f"{stem}-{number}.jfilm" for number in range(shards))
    if shards > 3:
        parts = f"{stem}-{{0..{shards - 1}}}.jfilm"
    output = (
        f"{os.path.splitext(os.path.basename(os.fspath(scene)))[0]}.png"
        if output is None
        else os.fspath(output)
    )
    return _SYSTEMS[system].format_map(values) + _MERGE.format(parts=parts, output=shlex.quote(output))


def _words(settings):
    """Flags of the program for settings of a still image."""
    settings = {name: value for name, value in settings.items() if value is not None}
    words = []
    for name, flag in (("frame", "--frame"), ("at", "--at")):
        if name in settings:
            words.append(f"{flag}={settings.pop(name)}")
    aovs = settings.pop("aovs", None)
    if aovs:
        words.append(f"--aov={aovs if isinstance(aovs, str) else ','.join(aovs)}")
    return [*words, *_flags(settings)]
