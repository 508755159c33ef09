"""What apps/quickstart.sh and laboratory.sh print, from the commands themselves, and whether the first seed was a lucky one.

laboratory  ident/validation/README.md; people of another model; ten seconds
transcript  README.md; it builds the programs first, minutes the first time
seeds       ident/README.md; the same study with 300 seeds; half a minute

No recordings are needed.
"""
import os
import subprocess
import tempfile

import studies

SEEDS = 300


def result_of(script, *words, **environment):
    done = subprocess.run(["bash", os.path.join(studies.SOURCE, script), *words], stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, text=True, check=True, env=dict(os.environ, **environment))
    return "```\n" + done.stdout.partition("\n== Result\n")[2].rstrip() + "\n```"


def transcript():
    return result_of("apps/quickstart.sh")


def laboratory():
    with tempfile.TemporaryDirectory() as folder:
        return result_of("tests/studies/laboratory.sh", folder, PUSHID_BIN=studies.BIN)


def program(name, *arguments):
    command = [os.path.join(studies.BIN, name), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True,
                          env=dict(os.environ, OPENBLAS_NUM_THREADS="1")).stdout


def seeds():
    cover, miss, whole = 0, 0, 0
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
        for seed in range(1, SEEDS + 1):
            made, model = os.path.join(folder, f"seed{seed}"), os.path.join(folder, "model.json")
            program("pushid-simulate", f"--out={made}", "--people=8", "--recordings_per_person=6", f"--seed={seed}")
            manifest = f"{made}/manifest.json"
            program("pushid-fit", f"--recordings={manifest}", "--setting=single", "--quiet", f"--model_out={model}")
            told = program("pushid-report", f"--model={model}", f"--truth={manifest}").splitlines()
            cover += sum(line.rstrip().endswith(" covers") for line in told)
            missed = sum(line.rstrip().endswith(" misses") for line in told)
            miss, whole = miss + missed, whole + (missed == 0)
    return (f"The quickstart's study with {SEEDS} seeds: {cover} of {cover + miss} intervals cover the truth; in {whole} "
            f"studies all do.")


if __name__ == "__main__":
    studies.main(__file__, {"laboratory": laboratory, "transcript": transcript, "seeds": seeds})
