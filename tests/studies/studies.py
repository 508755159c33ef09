"""What the studies share: running a program, its JSON, numbers with errors, and the READMEs' blocks.

A study is a script that makes blocks of Markdown: tables and transcripts of a README. Every number of a
README stands in such a block, between the lines

    <!-- tests/studies/NAME.py BLOCK -->
    <!-- end -->

    python3 tests/studies/NAME.py [BLOCK ...]            prints the blocks
    python3 tests/studies/NAME.py [BLOCK ...] --write    puts them into the README that has their place

PUSHID_RECORDINGS is the folder of the published recordings (default ../shared/fzj_push beside the source),
PUSHID_BIN that of the programs (default build/release/bin). What a program printed is kept in
build/studies under a hash of its command, the program itself and the library of the programs, so that a table's wording can be
changed without running again; remove the folder to measure times anew. Standard library alone.
"""
import hashlib
import json
import math
import os
import resource
import subprocess
import sys
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.path.abspath(os.environ.get("PUSHID_BIN", os.path.join(SOURCE, "build/release/bin")))
RECORDINGS = os.path.abspath(os.environ.get("PUSHID_RECORDINGS", os.path.join(SOURCE, "../shared/fzj_push")))
MANIFEST = os.path.join(RECORDINGS, "manifest.json")
KEPT = os.path.join(SOURCE, "build/studies")
END = "<!-- end -->"


class Output:
    """What a program printed, the file it wrote (`path`), which `json` parses, and its processor time, s."""

    def __init__(self, text, path, seconds, failed):
        self.text, self.path, self.seconds, self.failed = text, path, seconds, failed

    @property
    def json(self):
        with open(self.path, encoding="utf-8") as file:
            return json.load(file)


def program_bytes(executable):
    """What makes its output: itself, and the library that the programs share, in a build or beside an installed bin."""
    files = [executable] + [os.path.join(BIN, "..", *folders, "libpushid.so") for folders in (["ident"], ["lib", "pushid"])]
    parts = []
    for name in filter(os.path.exists, files):
        with open(name, "rb") as file:
            parts.append(hashlib.sha256(file.read()).digest())
    return b"".join(parts)


def run(program, *arguments, out="json_out", ending="json", keep=True, may_fail=False):
    """Runs a program with --OUT=FILE.ENDING added (out=None: without) unless it was run so before and keep is true.

    A failure ends the study unless may_fail; a usage error always does."""
    executable = os.path.join(BIN, program)
    if not os.path.exists(executable):
        sys.exit(f"{executable} is missing: build the programs, or name their folder by PUSHID_BIN")
    key = hashlib.sha256(program_bytes(executable) + "\0".join(arguments).encode()).hexdigest()[:16]
    os.makedirs(KEPT, exist_ok=True)
    text_file, path, kept = (os.path.join(KEPT, f"{program}-{key}.{e}") for e in ("txt", ending, "run"))
    if not (keep and os.path.exists(text_file)):
        command = [executable, *arguments] + ([f"--{out}={path}"] if out else [])
        print(f"{program} {' '.join(arguments)}", file=sys.stderr, flush=True)
        environment = dict(os.environ, OPENBLAS_NUM_THREADS="1")  # results repeat to the bit
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, env=environment)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        if done.returncode != 0 and not (may_fail and done.returncode == 2):
            sys.exit(f"{program} ended with exit code {done.returncode}")
        if not keep:
            return Output(done.stdout, path, seconds, done.returncode != 0)
        for name, text in ((kept, f"{seconds} {done.returncode}"), (text_file, done.stdout)):
            with tempfile.NamedTemporaryFile("w", dir=KEPT, delete=False) as file:
                file.write(text)
            os.replace(file.name, name)
    seconds, code = "nan", "0"
    if os.path.exists(kept):
        with open(kept, encoding="utf-8") as file:
            seconds, code = file.read().split()
    with open(text_file, encoding="utf-8") as file:
        return Output(file.read(), path, float(seconds), code != "0")


def on_recordings(program, setting, *arguments, **options):
    """The same with the published recordings of a setting; a lack of them ends the study."""
    if not os.path.exists(MANIFEST):
        sys.exit(f"{MANIFEST} is missing: PUSHID_RECORDINGS names the folder of the recordings, which "
                 "python3 -m pushid.ldp --split=train writes (apps/python/README.md)")
    return run(program, f"--recordings={MANIFEST}", f"--setting={setting}", *arguments, **options)


def printed_table(program, *arguments):
    """The cells of a table that a study in C++ printed, without its header, and the line after it."""
    lines = run(program, *arguments, out=None).text.splitlines()
    rows = []
    for part in "\n".join(lines[:-1]).split("\n\n"):  # a wide table is broken, its first column repeated
        cells = [[cell.strip() for cell in line.split("  ") if cell.strip()] for line in part.splitlines()[1:]]
        rows = [row + more[1:] for row, more in zip(rows, cells)] if rows else cells
    return rows, lines[-1]


def fit(setting, *arguments):
    """A fit; `path` is the model, which --model of the other programs takes."""
    return on_recordings("pushid-fit", setting, *arguments, out="model_out")


def check(fitted, *arguments):
    """The checks of a fit; `path` is the model with them."""
    return run("pushid-check", f"--model={fitted.path}", f"--recordings={MANIFEST}", *arguments, out="model_out")


def number(value, digits=3):
    """To so many significant digits, without an exponent: 2860, 0.409, -0.24."""
    if value == 0.0 or not math.isfinite(value):
        return f"{value:g}"
    decimals = digits - 1 - math.floor(math.log10(abs(value)))
    return f"{round(value, decimals):.{max(0, decimals)}f}"


def with_error(value, error, sign=False):
    """The error to two digits, the value to the same place: 0.096 +- 0.021, 2860 +- 310."""
    if not error > 0.0:
        return number(value)
    decimals = 1 - math.floor(math.log10(error))
    decimals = 1 - math.floor(math.log10(round(error, decimals)))  # 0.0996 is 0.10
    places = max(0, decimals)
    return f"{round(value, decimals):{'+' if sign else ''}.{places}f} +- {round(error, decimals):.{places}f}"


def table(header, rows):
    """A Markdown table; a cell that is None is empty."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join("" if cell is None else str(cell) for cell in line) + " |" for line in lines)


def transcript(command, text):
    """A command and what it printed; the path of the recordings reads M."""
    text = text.replace(RECORDINGS, "M").rstrip("\n")
    return f"```\n$ {command}\n{text}\n```"


def readmes():
    for folder, folders, files in os.walk(SOURCE):
        folders[:] = sorted(f for f in folders if f not in ("build", ".git"))
        if "README.md" in files:
            yield os.path.join(folder, "README.md")


def write_block(marker, text):
    for path in readmes():
        with open(path, encoding="utf-8") as file:
            before, found, rest = file.read().partition(f"\n{marker}\n")
        if not found:
            continue
        _, end, after = rest.partition(END)
        if not end:
            sys.exit(f"{path}: no line '{END}' after '{marker}'")
        with open(path, "w", encoding="utf-8") as file:
            file.write(before + found + text + "\n" + end + after)
        return
    sys.exit(f"no README.md has the line '{marker}'")


def main(script, blocks):
    """blocks: name -> function that returns Markdown."""
    name = os.path.basename(script)
    asked = [a for a in sys.argv[1:] if a != "--write"]
    for block in asked:
        if block not in blocks:
            sys.exit(f"{name}: no block '{block}'; there are {', '.join(blocks)}")
    for block in asked or blocks:
        marker, text = f"<!-- tests/studies/{name} {block} -->", blocks[block]()
        print(f"{marker}\n{text}\n{END}\n", flush=True)
        if "--write" in sys.argv[1:]:
            write_block(marker, text)
