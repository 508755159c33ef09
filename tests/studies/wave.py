"""A push that travels through ten people in a line, by the model fitted to the recordings of groups.

transcript  the run of pushid-formation (ident/formations/README.md)
pushes      how far it goes by push and parameters (ident/formations/README.md)

Half a minute on one core for the fit, seconds for the rest.
"""
import re

import studies

LINE = ["--formation=line", "--people=10", "--spacing=0.45"]


def simulate(*flags):
    model = studies.fit("groups", "--preset=group").path
    return studies.run("pushid-formation", f"--model={model}", *LINE, *flags, out=None).text


def transcript():
    return studies.transcript("pushid-formation --model=group.json " + " ".join(LINE) + " --push=80",
                              simulate("--push=80"))


def pushes():
    rows = []
    for setting in ("", "row_1"):
        for push in (30, 80, 157):
            text = simulate(f"--push={push}", *([f"--setting={setting}"] if setting else []))
            lines = text.splitlines()
            moved, _, wave = next(line for line in lines if "people moved by" in line).partition("; ")
            header = next(line for line in lines if line.startswith("person "))
            outcomes = [re.split(r"\s{2,}", line[header.index("outcome"):])[0] for line in lines
                        if line[:7].strip().isdigit()]
            counts = [f"{outcomes.count(o)} {o}" for o in sorted(set(outcomes))]
            speed = re.search(r"s: ([\d.]+ m/s)(?: \(.*: (.*)\))?", wave)
            told = "none" if not speed else speed[1] + (f" ({speed[2]})" if speed[2] else "")
            rows.append([setting or "shared", push, moved.split()[0], ", ".join(counts), told])
    return studies.table(["parameters of", "push, N s", "people moved by 2 cm", "outcome", "speed of the onset (90 %)"], rows)


if __name__ == "__main__":
    studies.main(__file__, {"transcript": transcript, "pushes": pushes})
