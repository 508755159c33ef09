"""A humanoid robot that is pushed while it balances: its PD gains, found again from its log.

gains      what --preset=robot finds of some robots (datasets/README.md)

The robot is simulated here, by Runge and Kutta's method in steps of 0.1 ms, and shares no code with pushid. Its log has, at 500 Hz,
time, centre of mass, centre of the base of support, and the force of a pusher. Standard library alone.
"""
import json
import math
import os
import random
import subprocess
import sys
import tempfile

import studies
from studies import number

ROBOTS = int(os.environ.get("PUSHID_STUDIES", "5"))
MASS, COM, GYRATION, RATE, SECONDS, STEP, GRAVITY = 38.0, 0.68, 0.19, 500, 2.5, 1e-4, 9.81
HEIGHT = 0.9  # of the push, m above the ground
MAPPING = {"columns": {"com": ["com_x", "com_y", "com_z"], "support": ["base_x", "base_y", "base_z"]},
           "joints": {"hip": "com", "base": "support"}, "time": "time", "length_unit": "m"}


def answer(kp, kd, push):
    """[(lean, force)], a row of the log each. push: N by time."""
    inertia = MASS * (COM ** 2 + GYRATION ** 2)

    def rates(time, state):
        lean, speed = state
        torque = MASS * GRAVITY * COM * math.sin(lean) - kp * lean - kd * speed + push(time) * HEIGHT * math.cos(lean)
        return speed, torque / inertia

    def moved(state, rate, step):
        return tuple(x + step * r for x, r in zip(state, rate))

    state, rows = (0.0, 0.0), []
    per_row = round(1 / RATE / STEP)
    for i in range(round(SECONDS * RATE) * per_row):
        time = i * STEP
        if i % per_row == 0:
            rows.append((state[0], push(time)))
        one = rates(time, state)
        two = rates(time + STEP / 2, moved(state, one, STEP / 2))
        three = rates(time + STEP / 2, moved(state, two, STEP / 2))
        four = rates(time + STEP, moved(state, three, STEP))
        state = moved(state, [(a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(one, two, three, four)], STEP)
    return rows


def write_log(folder, seed, pushes=8):
    """Logs of one robot under some pushes, mapping and manifest; -> the truth."""
    draw = random.Random(seed)
    kp, kd = draw.uniform(500, 900), draw.uniform(40, 90)
    recordings = []
    for k in range(pushes):
        size, start, duration = draw.uniform(15, 60) * (-1) ** k, draw.uniform(0.2, 0.4), draw.uniform(0.1, 0.3)
        rows = answer(kp, kd, lambda t: size * math.sin(math.pi * (t - start) / duration) if start < t < start + duration else 0.0)
        with open(f"{folder}/push{k}.csv", "w", encoding="utf-8") as file:
            file.write("time,com_x,com_y,com_z,base_x,base_y,base_z,force\n")
            for i, (lean, force) in enumerate(rows):
                noise = [draw.gauss(0.0, 1e-4) for _ in range(2)]
                file.write(f"{i / RATE:.3f},{COM * math.sin(lean) + noise[0]:.6f},0,{COM * math.cos(lean) + noise[1]:.6f},0,0,0,{force:.3f}\n")
        recordings.append({"id": f"push{k}", "setting": "single", "pushed_person": 0, "csv": [f"push{k}.csv"], "mapping": "log.json",
                           "subjects": [{"id": "robot", "mass_kg": MASS, "com_over_rod": 1, "gyration_over_rod": GYRATION / COM}]})
    for name, content in (("log.json", MAPPING), ("manifest.json", {"recordings": recordings})):
        with open(f"{folder}/{name}", "w", encoding="utf-8") as file:
            json.dump(content, file, indent=1)
    return {"Kp_theta": kp, "Kd_theta": kd}


def commands(folder):
    return [["pushid-push", f"--recordings={folder}/manifest.json", f"--sensor={folder}/{{id}}.csv", "--sensor_column=force",
             f"--height={HEIGHT / COM:.4f}", f"--out={folder}/{{id}}_force.csv", "--update"],
            ["pushid-fit", f"--recordings={folder}/manifest.json", "--preset=robot", f"--model_out={folder}/model.json"]]


def gains():
    rows = []
    for seed in range(1, ROBOTS + 1):
        with tempfile.TemporaryDirectory() as folder:
            truth = write_log(folder, seed)
            for program, *flags in commands(folder):
                subprocess.run([os.path.join(studies.BIN, program), *flags, "--quiet"], check=True, capture_output=True)
            with open(f"{folder}/model.json", encoding="utf-8") as file:
                found = {e["name"]: e["value"] for e in json.load(file)["parameters"]}
        for name, value in truth.items():
            rows.append([seed, f"`{name}`", number(value, 4), number(found[name], 4), f"{100 * (found[name] / value - 1):+.2f} %"])
    return studies.table(["robot", "gain", "truth", "found", "error"], rows)


if __name__ == "__main__":
    if sys.argv[1:2] == ["log"]:  # a log to try things on
        os.makedirs(sys.argv[2], exist_ok=True)
        print(write_log(sys.argv[2], 1))
    else:
        studies.main(__file__, {"gains": gains})
