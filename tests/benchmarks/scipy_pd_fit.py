"""Baseline: the six-parameter PD model fitted with plain NumPy and SciPy.

What a researcher would write without pushid: read the BVH files, roll out all recordings at once
(vectorised over recordings), hand hip errors to scipy.optimize.least_squares with its finite
differences, start from natural values. Run by hand (packages: python3-numpy python3-scipy); it is no
part of the tests. Against it stands, as whole processes:

  time /usr/bin/python3 tests/benchmarks/scipy_pd_fit.py ../shared/fzj_push/manifest.json
  time pushid-fit --recordings=../shared/fzj_push/manifest.json --setting=single
  time pushid-fit --recordings=../shared/fzj_push/manifest.json --setting=single --preset=ldp --friction=anisotropic --free=mu_y --gain_scaling=mass

--start picks one start (default: each in turn), --loss is least_squares' own.
"""
import argparse
import json
import os
import time

import numpy as np
from scipy.optimize import least_squares

G, REFERENCE_MASS = 9.81, 85.0
NAMES = ["c_x", "c_y", "Kp_theta", "Kp_phi", "Kd_theta", "Kd_phi"]
STARTS = {  # c = mu + Kp of the cart, N s/m; N m/rad; N m s/rad
    "published": [130.0, 130.0, 1500.0, 1500.0, 200.0 / 60.0, 200.0 / 60.0],
    "textbook": [50.0, 50.0, 1200.0, 1200.0, 100.0, 100.0],  # K = 1.5 m g l, well damped
}


def rotations(axis, degrees):
    """[frame, 3, 3] about one axis."""
    a = np.radians(degrees)
    c, s = np.cos(a), np.sin(a)
    i, j = {"X": (1, 2), "Y": (2, 0), "Z": (0, 1)}[axis]
    r = np.tile(np.eye(3), (len(a), 1, 1))
    r[:, i, i], r[:, i, j], r[:, j, i], r[:, j, j] = c, -s, s, c
    return r


def read_bvh(path):
    """Joint positions [frame, joint, 3] in metres."""
    with open(path) as file:
        lines = [line.split() for line in file]
    parents, offsets, channels, stack = [], [], [], []
    end_site = False
    for at, words in enumerate(lines):
        if not words:
            continue
        if words[0] in ("ROOT", "JOINT"):
            parents.append(stack[-1] if stack else -1)
            current = len(parents) - 1
        elif words[0] == "End":
            end_site, current = True, -1
        elif words[0] == "{":
            stack.append(current)
        elif words[0] == "}":
            stack.pop()
            end_site = False
        elif words[0] == "OFFSET" and not end_site:
            offsets.append(np.array(words[1:4], float))
        elif words[0] == "CHANNELS":
            channels.append(words[2:])
        elif words[0] == "MOTION":
            frames = int(lines[at + 1][1])
            motion = np.array(lines[at + 3:at + 3 + frames], float)
            break
    position = np.zeros((frames, len(parents), 3))
    rotation = np.zeros((frames, len(parents), 3, 3))
    column = 0
    for joint, parent in enumerate(parents):
        local = np.tile(offsets[joint], (frames, 1))
        turn = np.tile(np.eye(3), (frames, 1, 1))
        for channel in channels[joint]:
            values = motion[:, column]
            column += 1
            if channel.endswith("position"):
                local[:, "XYZ".index(channel[0])] += values
            else:
                turn = turn @ rotations(channel[0], values)
        if parent < 0:
            position[:, joint], rotation[:, joint] = local, turn
        else:
            at_parent = rotation[:, parent]
            position[:, joint] = position[:, parent] + np.einsum("fij,fj->fi", at_parent, local)
            rotation[:, joint] = at_parent @ turn
    return position / 1000.0


def load(manifest_path):
    """All single-person recordings, padded to the longest."""
    with open(manifest_path) as file:
        manifest = json.load(file)
    folder = os.path.dirname(manifest_path)
    entries = [r for r in manifest["recordings"] if r["setting"] == "single"]
    hips, pushes, carts, masses = [], [], [], []
    for entry in entries:
        joints = read_bvh(os.path.join(folder, entry["bvh"][0]))
        hips.append(joints[:, 0])
        carts.append(0.5 * (joints[0, 16] + joints[0, 20]))
        push = np.loadtxt(os.path.join(folder, entry["push_csv"]), delimiter=",", skiprows=1, ndmin=2)
        pushes.append(push[:, 1:])
        masses.append(entry["subjects"][0]["mass_kg"])
    count, longest = len(hips), max(len(h) for h in hips)
    data = {"mass": np.array(masses), "dt": 1.0 / entries[0]["fps"]}
    data["hip"] = np.zeros((count, longest, 3))
    data["valid"] = np.zeros((count, longest), bool)
    data["push"] = np.zeros((count, longest, 4))
    data["push_frames"] = np.array([len(p) for p in pushes])
    for i in range(count):
        data["hip"][i, :len(hips[i])] = hips[i]
        data["valid"][i, 1:len(hips[i])] = True
        data["push"][i, :len(pushes[i])] = pushes[i]
    cart = np.array(carts)
    rod = data["hip"][:, 0] - cart
    data["length"] = np.linalg.norm(rod, axis=1)
    u = rod / data["length"][:, None]
    data["height"] = cart[:, 2]
    data["q0"] = np.stack([cart[:, 0], cart[:, 1], np.arcsin(u[:, 0]), np.arctan2(-u[:, 1], u[:, 2])], 1)
    return data


def rollout(parameters, data):
    """Hip positions [recording, frame, 3] and angles; people who pass 1.4 rad stay where they are."""
    mass, l = data["mass"], data["length"]
    m = 0.9 * mass
    scale = mass / REFERENCE_MASS
    c_x, c_y, kp_th, kp_ph, kd_th, kd_ph = (p * scale for p in parameters)
    q, qd = data["q0"].copy(), np.zeros_like(data["q0"])
    count, frames = data["push"].shape[:2]
    path = np.empty((count, frames, 4))
    path[:, 0] = q
    speed = np.zeros((count, frames))
    matrix = np.zeros((count, 4, 4))
    fallen = np.zeros(count, bool)
    for t in range(frames - 1):
        s, c = np.sin(q[:, 2]), np.cos(q[:, 2])
        sp, cp = np.sin(q[:, 3]), np.cos(q[:, 3])
        thd, phd = qd[:, 2], qd[:, 3]
        own = np.stack([-c_x * qd[:, 0], -c_y * qd[:, 1], -kp_th * q[:, 2] - kd_th * thd,
                        -kp_ph * q[:, 3] - kd_ph * phd], 1)
        pushed = (t < data["push_frames"])[:, None]  # the push is the whole force while it lasts
        force = np.where(pushed, data["push"][:, t], own)
        force[:, 0] += m * l * s * thd**2
        force[:, 1] -= m * l * (2 * s * cp * thd * phd + c * sp * (thd**2 + phd**2))
        force[:, 2] += -m * l**2 * s * c * phd**2 + m * G * l * s * cp
        force[:, 3] += 2 * m * l**2 * s * c * thd * phd + m * G * l * c * sp
        matrix[:, 0, 0] = matrix[:, 1, 1] = mass
        matrix[:, 0, 2] = matrix[:, 2, 0] = m * l * c
        matrix[:, 1, 2] = matrix[:, 2, 1] = m * l * s * sp
        matrix[:, 1, 3] = matrix[:, 3, 1] = -m * l * c * cp
        matrix[:, 2, 2] = m * l**2
        matrix[:, 3, 3] = m * l**2 * c**2
        qd = qd + data["dt"] * np.linalg.solve(matrix, force[:, :, None])[:, :, 0]
        new_q = q + data["dt"] * qd
        fallen |= ~(np.abs(new_q[:, 2:]).max(axis=1) < 1.4)
        qd[fallen] = 0.0
        q = np.where(fallen[:, None], q, new_q)
        path[:, t + 1] = q
        speed[:, t + 1] = np.hypot(qd[:, 0], qd[:, 1])
    lr = l[:, None]
    hip = np.stack([path[:, :, 0] + lr * np.sin(path[:, :, 2]),
                    path[:, :, 1] - lr * np.cos(path[:, :, 2]) * np.sin(path[:, :, 3]),
                    data["height"][:, None] + lr * np.cos(path[:, :, 2]) * np.cos(path[:, :, 3])], 2)
    return hip, path, speed, fallen


def errors(parameters, data):
    return (rollout(parameters, data)[0] - data["hip"])[data["valid"]]


def judge(parameters):
    """What a person of 80 kg does after 25 N s, a half-sine of 12 frames at the hip."""
    frames, dt, l = 12 + 120 + 1, 1.0 / 60.0, 0.95
    shape = np.sin(np.pi * (np.arange(12) + 0.5) / 12)
    # As in the recordings, the push is the whole force while it lasts.
    data = {"mass": np.array([80.0]), "length": np.array([l]), "height": np.zeros(1), "dt": dt,
            "q0": np.zeros((1, 4)), "push": np.zeros((1, frames, 4)), "push_frames": np.array([12])}
    force = shape * 25.0 / (shape.sum() * dt)
    data["push"][0, :12, 0], data["push"][0, :12, 2] = force, force * l
    _, path, speed, fallen = rollout(parameters, data)
    if fallen[0] or np.abs(path[0, :, 2:]).max() > 1.0:
        return "fallen: leans beyond 1 rad within two seconds"
    if speed[0, -1] > 0.1 or np.abs(path[0, -1, 2:]).max() > 0.05:
        return "self-propelling: %.2f m/s and %.2f rad after two seconds" % (
            speed[0, -1], np.abs(path[0, -1, 2:]).max())
    return "settles"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("manifest")
    parser.add_argument("--start", choices=sorted(STARTS))
    parser.add_argument("--loss", default="soft_l1")
    arguments = parser.parse_args()
    begin = time.perf_counter()
    data = load(arguments.manifest)
    print("%d recordings read in %.2f s" % (len(data["mass"]), time.perf_counter() - begin))
    scale = np.array([100.0, 100.0, 1500.0, 1500.0, 70.0, 70.0])
    for name in [arguments.start] if arguments.start else STARTS:
        begin = time.perf_counter()
        fit = least_squares(lambda z: errors(z * scale, data).ravel(), np.array(STARTS[name]) / scale,
                            loss=arguments.loss, f_scale=0.1)
        seconds = time.perf_counter() - begin
        hip, _, _, fallen = rollout(fit.x * scale, data)
        distance = np.where(data["valid"], np.linalg.norm(hip - data["hip"], axis=2), 0.0)
        last = data["valid"].shape[1] - 1 - np.argmax(data["valid"][:, ::-1], axis=1)
        ade = (distance.sum(axis=1) / data["valid"].sum(axis=1)).mean()
        fde = distance[np.arange(len(last)), last].mean()
        print("\nstart '%s': cost %.4f, %d evaluations, %.2f s, %s" % (
            name, fit.cost, fit.nfev, seconds, fit.message))
        print("  " + ", ".join("%s %.4g" % pair for pair in zip(NAMES, fit.x * scale)))
        print("  on these recordings: hipADE %.3f m, hipFDE %.3f m, %d of %d leave the model" % (
            ade, fde, fallen.sum(), len(fallen)))
        print("  " + judge(fit.x * scale))


if __name__ == "__main__":
    main()
