"""People who are pushed, simulated without any code of pushid: continuous time, Runge-Kutta of fourth order at 2 ms, its own
equations of motion, and files as a laboratory writes them (points in CSV, one push CSV a recording).

Sliding: an inverted pendulum on a cart with a drag, a lean term that steps after the lean, and stiffness and damping of the lean.
Standing: feet that never move; one link, or two with a hip. All but the drag act on the state `delay` seconds ago. Planar, along the push.
"""
import csv
import math

import numpy as np

G = 9.81
STEP = 2e-3  # s


def half_sine(impulse, duration):
    """A force of one bump, N, that begins at 0."""
    peak = impulse * math.pi / (2.0 * duration)
    return lambda t: peak * math.sin(math.pi * t / duration) if 0.0 <= t < duration else 0.0


def late(history, at):
    """What (lean, rate) was at step `at`, between steps by straight lines; before the first one rest."""
    if at <= 0.0:
        return 0.0, 0.0
    i, f = int(at), at - int(at)
    a, b = history[i], history[min(i + 1, len(history) - 1)]
    return a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1])


class Slider:
    """An inverted pendulum on a cart that is pushed from rest, in the plane of its push: x of the cart and the lean. gains, the same
    in all directions: c, a (per mass, 1/s and m/s^2/rad), k (of m g l), d (of m l^2, 1/s)."""

    def __init__(self, mass, rod, gains, delay=0.0):
        self.mass, self.rod, self.gains, self.delay = mass, rod, gains, delay
        self.point, self.height = 0.9 * mass, 1.0

    def acceleration(self, lean, speed, rate, seen, force):
        """(cart, lean) of a horizontal force at `height` of the rod, N; by Lagrange's equations, the mass matrix inverted by Cramer's rule."""
        m, l, gains = self.point, self.rod, self.gains
        sine, cosine = math.sin(lean), math.cos(lean)
        along = self.mass * (-gains["c"] * speed + gains["a"] * seen[0]) + force + m * l * sine * rate * rate
        about = m * G * l * (sine - gains["k"] * seen[0]) - m * l * l * gains["d"] * seen[1] + force * self.height * l * cosine
        across = m * l * cosine
        det = self.mass * m * l * l - across * across
        return (m * l * l * along - across * about) / det, (self.mass * about - across * along) / det

    def run(self, force, direction, seconds, fps):
        """force(t), N, along a horizontal direction. -> times, hip [n, 3], feet [n, 2]."""
        frames, substeps = int(seconds * fps) + 1, max(1, round(1.0 / (fps * STEP)))
        h = 1.0 / (fps * substeps)
        x = lean = speed = rate = t = 0.0
        out, history = [], []
        for _ in range(frames):
            out.append((x, lean))
            for _ in range(substeps):
                f0, f1, f2 = force(t), force(t + h / 2), force(t + h)
                history.append((lean, rate))

                def seen(ahead, *now):
                    return late(history, len(history) - 1 + ahead - self.delay / h) if self.delay > 2 * h else now

                a1, b1 = self.acceleration(lean, speed, rate, seen(0.0, lean, rate), f0)
                s2, r2 = speed + h / 2 * a1, rate + h / 2 * b1
                a2, b2 = self.acceleration(lean + h / 2 * rate, s2, r2, seen(0.5, lean + h / 2 * rate, r2), f1)
                s3, r3 = speed + h / 2 * a2, rate + h / 2 * b2
                a3, b3 = self.acceleration(lean + h / 2 * r2, s3, r3, seen(0.5, lean + h / 2 * r2, r3), f1)
                s4, r4 = speed + h * a3, rate + h * b3
                a4, b4 = self.acceleration(lean + h * r3, s4, r4, seen(1.0, lean + h * r3, r4), f2)
                x += h / 6 * (speed + 2 * s2 + 2 * s3 + s4)
                lean += h / 6 * (rate + 2 * r2 + 2 * r3 + r4)
                speed += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
                rate += h / 6 * (b1 + 2 * b2 + 2 * b3 + b4)
                t += h
                if abs(lean) > 1.0:
                    raise FloatingPointError("falls")
        along = np.array([math.cos(direction), math.sin(direction)])
        travel, leans = np.array(out).T
        feet = np.outer(travel, along)
        hip = np.column_stack([feet + self.rod * np.outer(np.sin(leans), along), self.rod * np.cos(leans)])
        return np.arange(frames) / fps, hip, feet


class Stander:
    """Feet that never move; ankle torque -(kp lean + kd rate) on the lean of `delay` seconds ago. One link, or two: legs and a trunk
    on a passive hip."""

    def __init__(self, mass, rod, kp, kd, delay=0.0, links=1):
        self.mass, self.rod, self.kp, self.kd, self.delay, self.links = mass, rod, kp, kd, delay, links
        legs, trunk = 0.36 * mass, 0.64 * mass
        self.c1, self.c2, self.m1, self.m2 = 0.55 * rod, 0.27 * rod, legs, trunk
        self.i1, self.i2 = legs * (0.3 * rod)**2, trunk * (0.26 * rod)**2
        self.hip_stiffness, self.hip_damping = 1.2 * trunk * G * self.c2 + 200.0, 25.0

    def acceleration(self, q, v, seen, force):
        ankle = -(self.kp * seen[0] + self.kd * seen[1])
        l, c1, c2, m1, m2 = self.rod, self.c1, self.c2, self.m1, self.m2
        if self.links == 1:
            inertia = m1 * c1**2 + self.i1 + m2 * (l + c2)**2 + self.i2
            load = (m1 * c1 + m2 * (l + c2)) * G * math.sin(q[0]) + ankle + force * l * math.cos(q[0])
            return np.array([load / inertia, load / inertia])
        d = q[0] - q[1]
        mass = np.array([[m1 * c1**2 + self.i1 + m2 * l**2, m2 * l * c2 * math.cos(d)],
                         [m2 * l * c2 * math.cos(d), m2 * c2**2 + self.i2]])
        hip = -(self.hip_stiffness * (q[1] - q[0]) + self.hip_damping * (v[1] - v[0]))
        load = np.array([(m1 * c1 + m2 * l) * G * math.sin(q[0]) + ankle - hip + force * l * math.cos(q[0]),
                         m2 * c2 * G * math.sin(q[1]) + hip])
        load -= m2 * l * c2 * math.sin(d) * np.array([v[1]**2, -v[0]**2])
        return np.linalg.solve(mass, load)

    def run(self, force, direction, seconds, fps):
        q, v, history, out = np.zeros(2), np.zeros(2), [], []
        frames, substeps = int(seconds * fps) + 1, max(1, round(1.0 / (fps * STEP)))
        h = 1.0 / (fps * substeps)
        lag = self.delay / h

        def seen(steps, q, v):
            """Lean and rate `delay` before `steps` (of h, may be a half)."""
            return (q[0], v[0]) if lag < 1.0 else late(history, steps - lag)

        step = 0
        for frame in range(frames):
            out.append(q.copy())
            for _ in range(substeps):
                history.append((q[0], v[0]))
                t = step * h

                def slope(s, q, v, t=t, step=step):
                    return v, self.acceleration(q, v, seen(step + s, q, v), force(t + s * h))

                a1 = slope(0.0, q, v)
                a2 = slope(0.5, q + h / 2 * a1[0], v + h / 2 * a1[1])
                a3 = slope(0.5, q + h / 2 * a2[0], v + h / 2 * a2[1])
                a4 = slope(1.0, q + h * a3[0], v + h * a3[1])
                q = q + h / 6 * (a1[0] + 2 * a2[0] + 2 * a3[0] + a4[0])
                v = v + h / 6 * (a1[1] + 2 * a2[1] + 2 * a3[1] + a4[1])
                step += 1
                if abs(q[0]) > 0.8:
                    raise FloatingPointError("falls")
        leans = np.array([o[0] for o in out])
        hip = np.stack([self.rod * np.sin(leans) * math.cos(direction), self.rod * np.sin(leans) * math.sin(direction),
                        self.rod * np.cos(leans)], axis=1)
        return np.arange(frames) / fps, hip, np.zeros((frames, 2))


ANKLE_HEIGHT, HALF_STANCE = 0.09, 0.1  # m


def turned(angle):
    """About the vertical."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def points_of(hip, feet, turn):
    """Hip, left and right ankle as a camera system has them; who is turned has turned hips."""
    def ankle(side):
        return np.column_stack([feet, np.full(len(feet), ANKLE_HEIGHT)]) + turn @ [0.0, side * HALF_STANCE, 0.0]

    return [hip + [0.0, 0.0, ANKLE_HEIGHT], ankle(1), ankle(-1)]


def noise_of(shape, size, random, memory=0.0, exact_start=False):
    """Normal noise of standard deviation `size`, in frame 0 none if exact_start; `memory`: of one frame's noise in the next."""
    noise = random.standard_normal(shape)
    for t in range(1, shape[0] if memory else 0):
        noise[t] = memory * noise[t - 1] + math.sqrt(1.0 - memory * memory) * noise[t]
    if exact_start:
        noise[0] = 0.0
    return size * noise


def write_points(path, times, points, noise, random, drift=0.0, memory=0.0, exact_start=False):
    names = [f"{p}_{axis}" for p in ("hip", "left_ankle", "right_ankle") for axis in "xyz"]
    slow = np.outer(times / max(times[-1], 1e-9), [drift, 0.0, 0.0])  # of the camera system, m
    data = np.hstack([p + slow + noise_of(p.shape, noise, random, memory, exact_start) for p in points])
    with open(path, "w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["time", *names])
        for t, row in zip(times, data):
            rows.writerow([f"{t:.6f}", *(f"{x:.6f}" for x in row)])


def write_push(path, force, direction, hip, feet, fps, duration, scale=1.0, height=1.0):
    """The generalized force of a horizontal one at `height` of the rod, as a load cell has it that is read with the frames: row t is
    the mean over the frame's time."""
    rows = []
    for i in range(int(math.ceil(duration * fps)) + 1):
        f = scale * np.mean([force((i + s) / fps) for s in (-0.4, -0.2, 0.0, 0.2, 0.4)])
        fx, fy = f * math.cos(direction), f * math.sin(direction)
        u = hip[min(i, len(hip) - 1)] - np.append(feet[min(i, len(feet) - 1)], 0.0)
        rod = np.linalg.norm(u)
        theta, phi = math.asin(u[0] / rod), math.atan2(-u[1], u[2])
        lever = height * rod
        rows.append([fx, fy, lever * (fx * math.cos(theta) + fy * math.sin(theta) * math.sin(phi)),
                     -lever * fy * math.cos(theta) * math.cos(phi)])
    with open(path, "w", encoding="utf-8") as file:
        file.write("frame,fx,fy,ftheta,fphi\n")
        for i, row in enumerate(rows):
            file.write(f"{i}," + ",".join(f"{x:.6g}" for x in row) + "\n")
