"""The tutorials of the site: sections of READMEs whose commands (```sh, ```toml and ```python blocks) are run as they are
written, on synthetic recordings, with what they print put below them.

  tutorials.py BIN [NAME ...]    runs those named, or all; fails with the first command that does. `import pushid` is that of
                                 BIN/../python, or an installed one; where it does not work, Python's is left out of all.
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
MOST_LINES = 30  # of an output

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
GROUPS = "pushid-simulate --out=M --people=6 --group_size=3 --recordings_per_person=3 --seed=1"
PLAN = f"""pushid-simulate --out=M --people=4 --recordings_per_person=4 --seed=1
grep -v '^restoration' >plan.toml <<'END'
{(ROOT / "apps/README.md").read_text().partition("```toml")[2].partition("```")[0].strip()}
END"""

# name of the page: title, what stands before it, README and its headings, what is run before.
TUTORIALS = {
    "own_recordings": ("Your own recordings, step by step", "After `bash apps/quickstart.sh`, in the folder of the project.",
                       "README.md", ("Your own recordings, step by step", "How to read the result"),
                       f"PUSHID_BIN=$PWD/build/release/bin bash '{ROOT}/apps/quickstart.sh' --out=quickstart-output"),
    "force_plates": ("Force plates and load cells", "The files of a laboratory (TRC, CSV, MOT) that `pushid-simulate --laboratory` "
                     "makes, and what is different with C3D files.", "datasets/README.md",
                     ("A laboratory's files, from start to end", "Pushes and sensors", "Moving ground and force platforms",
                      "From a folder of files to a manifest"), ":"),
    "row": ("A row of people", f"`M` are recordings of groups; here of synthetic people, made by `{GROUPS}`.",
            "ident/formations/README.md", ("ident/formations: simulated formations of people",), GROUPS),
    "python": ("Python", "The arrays are of four synthetic people, whose mu is 30, Kp_theta 1800, Kd_theta 70 and a_x -10.", "apps/python/README.md", ("apps/python: import pushid",),
               f"'{sys.executable}' - <<'END'{ARRAYS}END"),
    "batch": ("A batch, also on a cluster", "Many fits from one plan. Outputs are those of the plan below without the line "
              "`restoration`, which needs a training.", "apps/README.md", ("Many fits: pushid-batch",), PLAN)}


def section(readme, heading):
    """Until the next heading of its level."""
    text = (ROOT / readme).read_text()
    match = re.search(rf"^(#+) {re.escape(heading)}\n", text, re.M)
    if not match:
        sys.exit(f"{readme} has no section '{heading}'")
    end = re.search(rf"^#{{1,{max(2, len(match[1]))}}} ", text[match.end():], re.M)
    return text[match.start():match.end() + end.start() if end else len(text)]


def text_of(name):
    _, _, readme, headings, _ = TUTORIALS[name]
    return "\n".join(section(readme, heading) for heading in headings)


def with_outputs(name, binaries):
    """The tutorial's text with what its commands print. They run in one shell, one after the other, in a new folder."""
    text = text_of(name)
    blocks = list(BLOCK.finditer(text))
    if not blocks:
        sys.exit(f"tutorial {name} has no commands")
    with tempfile.TemporaryDirectory() as folder:
        os.makedirs(f"{folder}/build/release")
        os.symlink(binaries, f"{folder}/build/release/bin")
        script = f"set -euo pipefail\n( {TUTORIALS[name][4]}\n) >/dev/null\n"
        for i, block in enumerate(blocks):
            commands = textwrap.dedent(block[3])
            if block[2] == "python":
                commands = f"'{sys.executable}' - <<'END_OF_PYTHON'\n{commands}END_OF_PYTHON\n"
            script += f"exec >'{folder}/{i}.txt'\n{commands}"
        done = subprocess.run(["bash", "-c", script], cwd=folder, capture_output=True, text=True, check=False,
                              env=surroundings(binaries))
        if done.returncode != 0:
            reached = sum(os.path.exists(f"{folder}/{i}.txt") for i in range(len(blocks)))
            sys.exit(f"tutorial {name}: exit code {done.returncode} in block {reached} of {len(blocks)}:\n"
                     f"{blocks[max(0, reached - 1)][3]}\n{done.stderr}")
        outputs = [pathlib.Path(f"{folder}/{i}.txt").read_text().replace(folder, "...").splitlines() for i in range(len(blocks))]
    for block, lines in reversed(list(zip(blocks, outputs))):
        if not lines:
            continue
        shown = lines[:MOST_LINES] + (["..."] if len(lines) > MOST_LINES else [])
        printed = textwrap.indent("\n".join(["", "```text", *shown, "```", ""]), block[1], lambda line: True)
        text = text[:block.end()] + printed + text[block.end():]
    return text


def surroundings(binaries):
    return dict(os.environ, PATH=f"{binaries}:{os.environ['PATH']}", OPENBLAS_NUM_THREADS="1",
                PYTHONPATH=f"{binaries.parent}/python:{os.environ.get('PYTHONPATH', '')}")


def available(binaries):
    """Python's tutorial only where `import pushid` works."""
    module = subprocess.run([sys.executable, "-c", "import pushid; pushid.simulate"], capture_output=True, check=False,
                            env=surroundings(binaries))
    return [name for name in TUTORIALS if name != "python" or module.returncode == 0]


def main():
    binaries = pathlib.Path(sys.argv[1]).resolve()
    for name in sys.argv[2:] or available(binaries):
        printed = with_outputs(name, binaries).count("```text")
        print(f"{name}: {len(BLOCK.findall(text_of(name)))} blocks, {printed} outputs")


if __name__ == "__main__":
    main()
