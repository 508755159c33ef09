"""How often does pushid-inspect tell of a push that cannot be right, and of one that is?

findings  ident/push/README.md; two minutes on one core; needs NumPy

People whom independent_people.py simulates stand for half a second, sway by up to 8 mm, and are pushed; cameras have noise of 1 to
8 mm. What their pushes' files say is then changed. The first row counts false alarms.
"""
import json
import math
import os
import tempfile

import numpy as np

import independent_people as people
import studies

STILL, FPS, SECONDS = 0.5, 60, 2.0  # s, Hz, s
PEOPLE, PUSHES = 16, 5
NOISES = (0.001, 0.002, 0.004, 0.008)  # m

# What is wrong -> what becomes of the rows of a push [frames, 4].
FAULTS = {
    "nothing": lambda rows: rows,
    "its sign": lambda rows: -rows,
    "1000 times too small (kN)": lambda rows: rows / 1000,
    "1000 times too large": lambda rows: rows * 1000,
    "9.81 times too small (kgf)": lambda rows: rows / 9.81,
    "0.3 s late": lambda rows: np.roll(rows, round(0.3 * FPS), axis=0),
    "0.3 s early": lambda rows: np.roll(rows, -round(0.3 * FPS), axis=0),
    "0.1 s late": lambda rows: np.roll(rows, round(0.1 * FPS), axis=0),
    "5 N at rest": lambda rows: rows + [5.0, 0.0, 5.0, 0.0],
}


def person_of(kind, random):
    mass, rod = random.uniform(55, 95), random.uniform(0.86, 1.0)
    if kind == 0:
        gains = {"c": random.uniform(0.3, 0.8), "a": -random.uniform(5, 12), "k": random.uniform(1.5, 3.3), "d": 0.9}
        return people.Slider(mass, rod, gains)
    body = mass * people.G * rod
    return people.Stander(mass, rod, random.uniform(1.25, 1.9) * body, random.uniform(0.3, 0.5) * body,
                          random.choice([0.0, 0.12]), kind)


def swaying(times, random):
    size, rate, phase = random.uniform(0.001, 0.004), random.uniform(0.2, 0.5), random.uniform(0, 2 * math.pi)
    return size * (np.sin(2 * math.pi * rate * times + phase) - math.sin(phase))


def recorded(kind):
    """(name, mass, rows of the push) of every recording, whose motion is written as NAME.csv."""
    random, found = np.random.default_rng(kind + 1), []
    while len(found) < PEOPLE * PUSHES:
        person = person_of(kind, random)
        for _ in range(PUSHES):
            speed = random.uniform(0.05, 0.16) if kind else random.uniform(0.1, 0.6)
            push = people.half_sine(speed * person.mass, random.uniform(0.1, 0.4))
            try:
                times, hip, feet = person.run(lambda t, push=push: push(t - STILL), 0.0, SECONDS, FPS)
            except FloatingPointError:
                continue
            hip[:, :2] += np.column_stack([swaying(times, random), swaying(times, random)])
            name = f"r{len(found)}"
            people.write_points(f"{name}.csv", times, people.points_of(hip, feet, np.eye(3)), NOISES[len(found) % 4], random)
            force = [np.mean([push((i + s) / FPS - STILL) for s in (0.1, 0.3, 0.5, 0.7, 0.9)]) for i in range(len(times))]
            found.append((name, person.mass, np.array([[f, 0.0, f * person.rod, 0.0] for f in force])))
    return found


def told(recordings, fault):
    """How many recordings have a finding."""
    for name, mass, rows in recordings:
        with open(f"{name}_push.csv", "w", encoding="utf-8") as file:
            file.write("frame,fx,fy,ftheta,fphi\n")
            for i, row in enumerate(fault(rows)):
                file.write(f"{i}," + ",".join(f"{x:.6g}" for x in row) + "\n")
        entry = {"id": name, "setting": "single", "pushed_person": 0, "csv": [f"{name}.csv"], "length_unit": "m",
                 "subjects": [{"id": name, "mass_kg": round(mass, 2)}], "push_csv": f"{name}_push.csv"}
        with open(f"{name}.json", "w", encoding="utf-8") as file:
            json.dump({"recordings": [entry]}, file)
    inspected = studies.run("pushid-inspect", *(f"{name}.json" for name, *_ in recordings), out="json_out", keep=False).json
    return sum(any(" case" in line for line in one["warnings"]) for one in inspected)


def findings():
    kinds = ["people who step", "who stand", "who stand, with a hip"]
    columns = []
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for kind in range(len(kinds)):
            recordings = recorded(kind)
            columns.append([f"{told(recordings, fault)} of {len(recordings)}" for fault in FAULTS.values()])
    return studies.table(["what is wrong with the push", *kinds], [list(row) for row in zip(FAULTS, *columns)])


if __name__ == "__main__":
    studies.main(__file__, {"findings": findings})
