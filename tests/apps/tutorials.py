"""Sections of READMEs whose commands (```sh and ```python blocks) are run as they are written, on synthetic recordings.

  tutorials.py BIN [NAME ...]    runs those named, or all; fails with the first command that does. `import pushid` is that of
                                 BIN/../python, or an installed one.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^( *)```(sh|python)\n(.*?)^ *```\n", re.S | re.M)

# Arrays of four people, at 100 frames a second, as the README of Python names them. Pushes are whole ones, as a sensor
# measures them; the masses must be those of the README.
ARRAYS = """
import numpy as np, pushid
made = pushid.simulate(people=4, recordings_per_person=2, fps=100, seed=4, push_kind="external")[0]
assert [one.mass[0] for one in made[::2]] == [61.9, 94.3, 78.2, 60.7], [one.mass[0] for one in made[::2]]
for recording, name in zip(made, [f"{name}_{take}" for name in ("anna", "ben", "cleo", "dan") for take in (1, 2)]):
    for part, values in (("hip", recording.hip), ("left_ankle", recording.left_ankle), ("right_ankle", recording.right_ankle),
                         ("push", recording.push[:, 0])):
        np.save(f"{name}_{part}.npy", values)
"""
PLAN = f"""pushid-simulate --out=M --people=4 --recordings_per_person=4 --seed=1
grep -v '^restoration' >plan.toml <<'END'
{(ROOT / "apps/README.md").read_text().partition("```toml")[2].partition("```")[0].strip()}
END"""

# The quickstart as a newcomer runs it, where the programs are those that it would build; a cmake that does nothing builds them.
QUICKSTART = "PUSHID_BIN=$PWD/build/release/bin"
if pathlib.Path(sys.argv[1]).resolve() == ROOT / "build/release/bin":
    QUICKSTART = "mkdir stub && ln -s /bin/true stub/cmake && PATH=$PWD/stub:$PATH"

# name: README and its headings, what is run before.
TUTORIALS = {
    "own_recordings": ("README.md", ("Your own recordings, step by step",),
                       f"{QUICKSTART} bash '{ROOT}/apps/quickstart.sh' --out=quickstart-output"),
    "force_plates": ("datasets/README.md", ("A laboratory's files, from start to end", "Pushes and sensors",
                                            "Moving ground and force platforms", "From a folder of files to a manifest"), ":"),
    "row": ("ident/formations/README.md", ("ident/formations: simulated formations of people",),
            "pushid-simulate --out=M --people=6 --group_size=3 --recordings_per_person=3 --seed=1"),
    "python": ("apps/python/README.md", ("apps/python: import pushid",), f"'{sys.executable}' - <<'END'{ARRAYS}END"),
    "batch": ("apps/README.md", ("Many fits: pushid-batch",), PLAN)}


def section(readme, heading):
    """Until the next heading of its level."""
    text = (ROOT / readme).read_text()
    match = re.search(rf"^(#+) {re.escape(heading)}\n", text, re.M)
    if not match:
        sys.exit(f"{readme} has no section '{heading}'")
    end = re.search(rf"^#{{1,{max(2, len(match[1]))}}} ", text[match.end():], re.M)
    return text[match.start():match.end() + end.start() if end else len(text)]


def run(name, binaries):
    """All commands in one shell, one after the other, in a new folder. Returns how many blocks there were."""
    readme, headings, before = TUTORIALS[name]
    blocks = [block for heading in headings for block in BLOCK.finditer(section(readme, heading))]
    if not blocks:
        sys.exit(f"tutorial {name} has no commands")
    with tempfile.TemporaryDirectory() as folder:
        os.makedirs(f"{folder}/build/release")
        os.symlink(binaries, f"{folder}/build/release/bin")
        script = f"set -euo pipefail\n( {before}\n)\n"
        for i, block in enumerate(blocks):
            commands = textwrap.dedent(block[3])
            if block[2] == "python":
                commands = f"'{sys.executable}' - <<'END_OF_PYTHON'\n{commands}END_OF_PYTHON\n"
            script += f"echo 'block {i + 1} of {len(blocks)}' >&2\n{commands}"
        done = subprocess.run(["bash", "-c", script], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                              check=False, env=dict(os.environ, PATH=f"{binaries}:{os.environ['PATH']}", OPENBLAS_NUM_THREADS="1",
                                                    PYTHONPATH=f"{binaries.parent}/python:{os.environ.get('PYTHONPATH', '')}"))
    if done.returncode != 0:
        sys.exit(f"tutorial {name}: exit code {done.returncode}\n{done.stderr}")
    return len(blocks)


for asked in sys.argv[2:] or TUTORIALS:
    print(f"{asked}: {run(asked, pathlib.Path(sys.argv[1]).resolve())} blocks")
