"""Does the estimated offset between the clocks of sensor and cameras have a bias?

offsets  ident/push/README.md; half a minute on one core

People are simulated at 960 Hz, where the step is short against the push, and seen by cameras at 60 Hz (every
16th frame), joints noisy; the sensor's clock is off by a known time.
"""
import csv
import json
import math
import os
import re
import tempfile

import studies
from studies import with_error

FPS, EVERY, TRUTH = 960, 16, 0.150  # Hz, frames, s
NOISES = [0.0, 0.001, 0.002]  # m


def see_at_60_hz(path):
    """Keeps every 16th frame of a BVH file."""
    with open(path, encoding="utf-8") as file:
        lines = file.read().splitlines()
    head = next(i for i, line in enumerate(lines) if line.startswith("Frames:"))
    frames = lines[head + 2::EVERY]
    lines[head] = f"Frames: {len(frames)}"
    lines[head + 1] = f"Frame Time: {EVERY / FPS:.9f}"
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines[:head + 2] + frames) + "\n")


def write_sensor(push, start_frame, frames, path):
    """The push as samples at 960 Hz on a clock that reads TRUTH at frame 0."""
    with open(push, encoding="utf-8") as file:
        force = {start_frame + int(row["frame"]): row["fx"] for row in csv.DictReader(file)}
    with open(path, "w", encoding="utf-8") as file:
        file.write("time,force\n")
        for t in range(frames):
            # A row drives the step from frame t to t + 1: its middle is half a frame later.
            file.write(f"{TRUTH + (t + 0.5) / FPS:.9f},{force.get(t, 0)}\n")


def offsets_at(noise):
    """Errors of the estimates and their stated standard errors, s."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        studies.run("pushid-simulate", f"--out={folder}", "--people=4", "--recordings_per_person=3", f"--fps={FPS}",
                    "--frames=1440", "--push_kind=external", f"--noise={noise}", out=None, keep=False)
        manifest = os.path.join(folder, "manifest.json")
        with open(manifest, encoding="utf-8") as file:
            recordings = json.load(file)
        for r in recordings["recordings"]:
            sensor = os.path.join(folder, "sensor.csv")
            see_at_60_hz(os.path.join(folder, r["bvh"][0]))
            write_sensor(os.path.join(folder, r.pop("push_csv")), 0, 1440, sensor)
            r.update(fps=FPS / EVERY, frames=1440 // EVERY)
            with open(manifest, "w", encoding="utf-8") as file:
                json.dump({"recordings": [r]}, file)
            told = studies.run("pushid-push", "--overwrite", f"--recordings={manifest}", f"--id={r['id']}", f"--sensor={sensor}",
                               "--estimate_offset", f"--out={folder}/push.csv", out=None, keep=False).text
            value, error = re.search(r"(-?[\d.e-]+) \+- ([\d.e-]+) s", told).groups()
            found.append((float(value) - TRUTH, float(error)))
    return found


def offsets():
    rows = []
    for noise in NOISES:
        found = offsets_at(noise)
        n = len(found)
        mean = sum(e for e, _ in found) / n
        spread = math.sqrt(sum((e - mean) ** 2 for e, _ in found) / (n - 1))
        rows.append([f"{1000 * noise:g}", n, with_error(1000 * mean, 1000 * spread / math.sqrt(n)),
                     f"{1000 * spread:.2g}", f"{1000 * sum(s for _, s in found) / n:.2g}"])
    return studies.table(["noise of the joints, mm", "pushes", "mean error of the offset, ms", "spread, ms",
                          "stated standard error, ms"], rows)


if __name__ == "__main__":
    studies.main(__file__, {"offsets": offsets})
