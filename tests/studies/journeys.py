"""What three newcomers do, from their own files to their result; every file is made here.

sensor   TRC markers (y up, mm, pelvis and malleoli) and a force sensor with a clock of its own: inspected, made a
         manifest, pushes, a fit beside the truth, a batch
bvh      BVH with a hierarchy, names and a unit of its own (CMU's, 0.0564 m): inspected, pushes by inverse dynamics,
         a fit, rigid bodies as BVH in the hierarchy that came in
crowd    a fitted model on a line of ten: the wave, bodies, the same people as recordings again, fitted as a group

    python3 tests/studies/journeys.py BIN [JOURNEY ...]

BIN is the folder of the programs. Ends with exit code 1 where a program fails or a result is not what it must be.
"""
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile

MARKERS = {  # of which joint, and how far beside it (m; forward, left, up)
    "LASI": ("Hips", (0.1, 0.12, 0)), "RASI": ("Hips", (0.1, -0.12, 0)),
    "LPSI": ("Hips", (-0.1, 0.05, 0)), "RPSI": ("Hips", (-0.1, -0.05, 0)),
    "L_FAL": ("LeftAnkle", (0, 0.04, 0)), "L_TAM": ("LeftAnkle", (0, -0.04, 0)),
    "R_FAL": ("RightAnkle", (0, -0.04, 0)), "R_TAM": ("RightAnkle", (0, 0.04, 0))}
CLOCK = 2.5  # s: what the sensor's clock reads at frame 0


class Journey:
    """Runs programs in a folder of its own; shows each command and what it printed."""

    def __init__(self, programs, folder):
        self.programs, self.folder = programs, folder

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, program, *arguments):
        print(f"$ {program} {' '.join(arguments)}", flush=True)
        done = subprocess.run([os.path.join(self.programs, program), *arguments, "--quiet"], cwd=self.folder,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        print(done.stdout, flush=True)
        need(done.returncode == 0, f"{program} ended with exit code {done.returncode}")
        return done.stdout

    def json(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return json.load(file)


def need(holds, what):
    if not holds:
        sys.exit(f"journeys.py: {what}")


def covered(report):
    """"5 of 6 intervals cover the truth": 5, 6."""
    inside, of = re.search(r"(\d+) of (\d+) intervals cover", report).groups()
    return int(inside), int(of)


def rotation(axis, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, k = [(1, 2), (2, 0), (0, 1)]["XYZ".index(axis)]
    m = [[float(r == q) for q in range(3)] for r in range(3)]
    m[i][i], m[i][k], m[k][i], m[k][k] = c, -s, s, c
    return m


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(len(b[0]))] for i in range(3)]


def joints_of(path):
    """Positions of the joints of a BVH file, by name, a list of [x, y, z] in its unit; frames a second."""
    with open(path, encoding="utf-8") as file:
        head, motion = file.read().split("MOTION")
    joints, stack, channels = [], [], 0
    for line in head.splitlines():
        words = line.split()
        if words[:1] in (["ROOT"], ["JOINT"], ["End"]):
            joints.append({"name": words[1], "parent": stack[-1] if stack else None, "channels": []})
        elif words[:1] == ["{"]:
            stack.append(len(joints) - 1)
        elif words[:1] == ["}"]:
            stack.pop()
        elif words[:1] == ["OFFSET"]:
            joints[-1]["offset"] = [float(w) for w in words[1:]]
        elif words[:1] == ["CHANNELS"]:
            joints[-1]["channels"] = [(channels + i, name) for i, name in enumerate(words[2:])]
            channels += len(words) - 2
    lines = motion.strip().splitlines()
    rate = 1.0 / float(lines[1].split(":")[1])
    tracks = {joint["name"]: [] for joint in joints}
    for line in lines[2:]:
        values, placed = [float(w) for w in line.split()], []
        for joint in joints:
            turned, moved = rotation("X", 0), list(joint["offset"])
            for at, name in joint["channels"]:
                if name.endswith("position"):
                    moved["XYZ".index(name[0])] = values[at]  # in the offset's place
                else:
                    turned = product(turned, rotation(name[0], values[at]))
            if joint["parent"] is not None:
                place, turn = placed[joint["parent"]]
                moved = [place[i] + sum(turn[i][k] * moved[k] for k in range(3)) for i in range(3)]
                turned = product(turn, turned)
            placed.append((moved, turned))
            tracks[joint["name"]].append(moved)
    return tracks, rate


def write_trc(bvh, trc):
    """The markers of a BVH file as OpenSim has them: y up, z to the right, mm."""
    joints, rate = joints_of(bvh)
    frames = len(joints["Hips"])
    rows = [f"PathFileType\t4\t(X/Y/Z)\t{os.path.basename(trc)}",
            "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
            f"{rate:g}\t{rate:g}\t{frames}\t{len(MARKERS)}\tmm\t{rate:g}\t1\t{frames}",
            "Frame#\tTime\t" + "\t\t\t".join(MARKERS),
            "\t\t" + "\t".join(f"{axis}{i + 1}" for i in range(len(MARKERS)) for axis in "XYZ"), ""]
    for t in range(frames):
        cells = [str(t + 1), f"{t / rate:.6f}"]
        for joint, beside in MARKERS.values():
            x, y, z = (joints[joint][t][i] + 1000.0 * beside[i] for i in range(3))
            cells += [f"{x:.4f}", f"{z:.4f}", f"{-y:.4f}"]
        rows.append("\t".join(cells))
    with open(trc, "w", encoding="utf-8") as file:
        file.write("\n".join(rows) + "\n")
    return rate, frames


def write_sensor(push, rate, frames, path):
    """The push as the readings of a load cell, 10 samples a frame."""
    with open(push, encoding="utf-8") as file:
        force = {int(row["frame"]): (float(row["fx"]), float(row["fy"])) for row in csv.DictReader(file)}
    with open(path, "w", encoding="utf-8") as file:
        file.write("time,fx,fy,fz\n")
        for sample in range(10 * frames):
            fx, fy = force.get(sample // 10, (0.0, 0.0))
            file.write(f"{CLOCK + sample / (10 * rate):.6f},{fx:.6f},{fy:.6f},0\n")


def sensor(journey):
    journey.run("pushid-simulate", "--out=truth", "--people=4", "--recordings_per_person=6", "--push_kind=external",
                "--fps=100", "--frames=150", "--noise=0.001", "--seed=3")
    os.makedirs(journey.path("data"))
    os.makedirs(journey.path("push"))
    with open(journey.path("data/masses.csv"), "w", encoding="utf-8") as file:
        file.write("id,mass_kg\n")
        people = {s["id"]: s["mass_kg"] for r in journey.json("truth/manifest.json")["recordings"]
                  for s in r["subjects"]}
        file.writelines(f"{name},{mass}\n" for name, mass in people.items())
    recordings = journey.json("truth/manifest.json")["recordings"]
    for r in recordings:
        rate, frames = write_trc(journey.path(f"truth/{r['bvh'][0]}"), journey.path(f"data/{r['id']}.trc"))
        write_sensor(journey.path(f"truth/{r['push_csv']}"), rate, frames, journey.path(f"data/{r['id']}_force.csv"))

    first = recordings[0]["id"]
    seen = journey.run("pushid-inspect", f"data/{first}.trc")
    need("L_FAL + L_TAM" in seen and "y is up" in seen, "pushid-inspect does not see the malleoli, or what is up")
    journey.run("pushid-manifest", "--folder=data", "--pattern={subject}_{take}_{magnitude}.trc",
                "--masses=data/masses.csv", "--up=y", "--forward=x", "--out=manifest.json")
    for r in recordings:
        journey.run("pushid-push", "--recordings=manifest.json", f"--id={r['id']}", f"--sensor=data/{r['id']}_force.csv",
                    f"--sensor_start={CLOCK}", "--height=0.9", f"--out=push/{r['id']}.csv", "--update")
    doubts = journey.run("pushid-inspect", "manifest.json")
    need(" case" not in doubts, "pushid-inspect doubts recordings that are sound")
    journey.run("pushid-fit", "--recordings=manifest.json", "--model_out=model.json")
    report = journey.run("pushid-report", "--model=model.json", "--truth=truth/manifest.json")
    inside, of = covered(report)
    need(of >= 3 and inside >= of - 1, f"{inside} of {of} intervals cover the truth")
    with open(journey.path("plan.toml"), "w", encoding="utf-8") as file:
        file.write('[data]\nrecordings = "manifest.json"\n[jobs]\ngroup_by = "none"\nfolds = 3\n[[variant]]\n'
                   'name = "default"\nflags = []\n[[variant]]\nname = "pd"\nflags = ["--preset=ldp"]\n'
                   '[output]\ndir = "batch"\n')
    table = journey.run("pushid-batch", "--plan=plan.toml", "--jobs=2")
    need("3 of 3" in table, "the batch's variants are not compared on all folds")
    need(os.path.exists(journey.path("batch/summary.csv")), "the batch wrote no table")


# CMU's names for the joints of the synthetic skeleton.
CMU = {"Hips": "Hips", "Spine": "LowerBack", "Spine1": "Spine", "Spine2": "Spine1", "Neck": "Neck", "Head": "Head",
       "RightClavicle": "RightShoulder", "RightShoulder": "RightArm", "RightElbow": "RightForeArm",
       "RightWrist": "RightHand", "LeftClavicle": "LeftShoulder", "LeftShoulder": "LeftArm", "LeftElbow": "LeftForeArm",
       "LeftWrist": "LeftHand", "RightHip": "RightUpLeg", "RightKnee": "RightLeg", "RightAnkle": "RightFoot",
       "RightToe": "RightToeBase", "LeftHip": "LeftUpLeg", "LeftKnee": "LeftLeg", "LeftAnkle": "LeftFoot",
       "LeftToe": "LeftToeBase"}
CMU_UNIT = 0.0564  # m


def write_cmu(source, target):
    """A BVH file under CMU's names, in its unit."""
    per_mm = 0.001 / CMU_UNIT
    lengths, is_length, lines = [], [], []
    with open(source, encoding="utf-8") as file:
        head, motion = file.read().split("MOTION")
    for line in head.splitlines():
        words = line.split()
        if words[:1] in (["ROOT"], ["JOINT"]):
            line = line.replace(words[1], CMU[words[1]])
        elif words[:1] == ["OFFSET"]:
            line = line.split("OFFSET")[0] + "OFFSET " + " ".join(repr(per_mm * float(w)) for w in words[1:])
        elif words[:1] == ["CHANNELS"]:
            is_length += [word.endswith("position") for word in words[2:]]
        lines.append(line)
    for line in motion.strip().splitlines()[2:]:
        lengths.append(" ".join(repr(per_mm * float(w)) if scaled else w
                                for w, scaled in zip(line.split(), is_length)))
    with open(target, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\nMOTION\n" + "\n".join(motion.strip().splitlines()[:2] + lengths) + "\n")


def bvh(journey):
    journey.run("pushid-simulate", "--out=truth", "--people=2", "--recordings_per_person=6", "--seed=11")
    os.makedirs(journey.path("cmu"))
    os.makedirs(journey.path("push"))
    recordings = journey.json("truth/manifest.json")["recordings"]
    for r in recordings:
        write_cmu(journey.path(f"truth/{r['bvh'][0]}"), journey.path(f"cmu/{r['id']}.bvh"))
    first = recordings[0]["id"]
    need("LeftFoot" in journey.run("pushid-inspect", f"cmu/{first}.bvh"), "pushid-inspect does not see CMU's ankles")
    journey.run("pushid-manifest", "--folder=cmu", "--pattern={subject}_{take}_{magnitude}.bvh", "--mass=75",
                "--out=manifest.json")
    read = ["--recordings=manifest.json", f"--length_scale={CMU_UNIT}"]
    journey.run("pushid-push", *read, "--ids=" + ",".join(r["id"] for r in recordings), "--out=push/{id}.csv",
                "--update")
    journey.run("pushid-fit", *read, "--model_out=model.json")
    predict = ["--model=model.json", *read, f"--id={first}", "--restoration=rigid"]
    journey.run("pushid-predict", *predict, "--out=motion.bvh")
    with open(journey.path("motion.bvh"), encoding="utf-8") as made, \
            open(journey.path(f"cmu/{first}.bvh"), encoding="utf-8") as given:
        joints = [[w.split()[1] for w in text.read().splitlines() if w.split()[:1] in (["ROOT"], ["JOINT"])]
                  for text in (made, given)]
    need(joints[0] == joints[1], f"the hierarchy changed: {joints[0]}")


def crowd(journey):
    journey.run("pushid-simulate", "--out=people", "--people=4", "--recordings_per_person=6", "--seed=5")
    # Nobody touches anybody in these: contact keeps the values of the preset.
    journey.run("pushid-fit", "--recordings=people/manifest.json", "--preset=group", "--model_out=group.json",
                "--fix=contact_stiffness,contact_distance,contact_kappa,contact_damping")
    line = ["--model=group.json", "--formation=line", "--people=10", "--spacing=0.45", "--push=80"]
    told = journey.run("pushid-formation", *line, "--svg_out=wave.svg", "--csv_out=line.csv", "--html_out=line.html",
                       "--restoration=rigid", "--bvh_out=line")
    need("10" in told, "the table of the line has no tenth person")
    for name in ("wave.svg", "line.csv", "line.html"):
        need(os.path.getsize(journey.path(name)) > 1000, f"{name} is empty")
    recording = journey.json("line/manifest.json")["recordings"][0]
    need(len(recording["subjects"]) == 10, "the line is no recording of ten people")
    journey.run("pushid-inspect", "line/manifest.json")
    journey.run("pushid-evaluate", "--model=group.json", "--recordings=line/manifest.json", "--json_out=scores.json")
    error = journey.json("scores.json")["mean"]["hipADE_m"]
    need(error < 0.005, f"the model that made the line is {error} m off it")


JOURNEYS = {"sensor": sensor, "bvh": bvh, "crowd": crowd}

if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for name in sys.argv[2:] or JOURNEYS:
        need(name in JOURNEYS, f"no journey '{name}'; there are {', '.join(JOURNEYS)}")
        with tempfile.TemporaryDirectory() as scratch:
            JOURNEYS[name](Journey(os.path.abspath(sys.argv[1]), scratch))
