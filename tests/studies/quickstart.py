"""What apps/quickstart.sh prints of the fit and of the held-out pushes, from the command itself.

transcript  README.md; it builds the programs in build/quickstart first, minutes the first time

No recordings are needed.
"""
import os
import subprocess

import studies


def transcript():
    done = subprocess.run(["bash", os.path.join(studies.SOURCE, "apps/quickstart.sh")], stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, text=True, check=True)
    parts = ["== " + part.rstrip() for part in done.stdout.split("\n== ")]
    asked = [p for p in parts if p.startswith(("== Identifying", "== Predicting"))]
    # Of the errors the mean over recordings; the rest is by strength and person.
    asked[-1] = "\n".join(asked[-1].splitlines()[:3])
    return "```\n" + "\n\n".join(asked) + "\n```"


if __name__ == "__main__":
    studies.main(__file__, {"transcript": transcript})
