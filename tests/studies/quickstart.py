"""What apps/quickstart.sh prints, from the command itself, and whether its first seed was a lucky one.

laboratory  ident/validation/README.md; the second example; ten seconds
transcript  README.md; it builds the programs first, minutes the first time
seeds       ident/README.md; the same recordings and fit with 30 seeds; half a minute

No recordings are needed.
"""
import os
import subprocess
import tempfile

import studies

SEEDS = 30


def result_of(*flags, **environment):
    done = subprocess.run(["bash", os.path.join(studies.SOURCE, "apps/quickstart.sh"), *flags], stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, text=True, check=True, env=dict(os.environ, **environment))
    return "```\n" + done.stdout.partition("\n== Result\n")[2].rstrip() + "\n```"


def transcript():
    return result_of()


def laboratory():
    with tempfile.TemporaryDirectory() as folder:
        return result_of("--example=laboratory", f"--out={folder}", PUSHID_BIN=studies.BIN)


def program(name, *arguments):
    command = [os.path.join(studies.BIN, name), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True,
                          env=dict(os.environ, OPENBLAS_NUM_THREADS="1")).stdout


def seeds():
    cover = miss = 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(1, SEEDS + 1):
            made, model = os.path.join(folder, f"seed{seed}"), os.path.join(folder, "model.json")
            program("pushid-simulate", f"--out={made}", "--people=4", "--recordings_per_person=6", f"--seed={seed}")
            manifest = f"{made}/manifest.json"
            program("pushid-fit", f"--recordings={manifest}", "--setting=single", "--quiet", f"--model_out={model}")
            told = program("pushid-report", f"--model={model}", f"--truth={manifest}").splitlines()
            cover += sum(line.rstrip().endswith(" covers") for line in told)
            miss += sum(line.rstrip().endswith(" misses") for line in told)
    return (f"The quickstart's fit with {SEEDS} seeds instead of the first: {cover} of {cover + miss} intervals cover "
            f"the truth.")


if __name__ == "__main__":
    studies.main(__file__, {"laboratory": laboratory, "transcript": transcript, "seeds": seeds})
