"""People who stand on a platform, and a laboratory's cart and pole, simulated without any code of pushid: continuous time,
Runge-Kutta of fourth order at a millisecond, delay by history, files as a laboratory writes them.

A person is a rigid body that turns about the ankles, with what pushid takes an average body for (0.97 of the mass, centre of mass at
1.09 of the way from ankles to hip, inertia 1.15 m h^2 about the ankles). Active ankle torques act on the lean `delay` seconds ago,
passive ones on the present lean. Planar, along x.
"""
import csv
import math

import numpy as np

import independent_people as people
from independent_people import G

STEP = 1e-3  # s
ANKLE_HEIGHT = people.ANKLE_HEIGHT
REFERENCE_MASS, REFERENCE_ROD = 85.0, 0.95  # gains are quoted for


def minimum_jerk(size, start, seconds):
    """Displacement of a platform, m, and its acceleration, m/s^2."""
    def shift(t):
        u = min(1.0, max(0.0, (t - start) / seconds))
        return size * u**3 * (10.0 - 15.0 * u + 6.0 * u * u)

    def acceleration(t):
        u = (t - start) / seconds
        return size / seconds**2 * u * (60.0 - 180.0 * u + 120.0 * u * u) if 0.0 < u < 1.0 else 0.0

    return shift, acceleration


def still():
    return (lambda t: 0.0), (lambda t: 0.0)


class Stander:
    """gains: Kp (N m/rad), Kd (N m s/rad), share (passive), delay (s), of the reference person."""

    def __init__(self, mass, rod, gains):
        self.mass, self.rod = mass, rod
        scale = mass / REFERENCE_MASS * rod / REFERENCE_ROD
        self.kp, self.kd = gains["Kp"] * scale, gains["Kd"] * scale * rod / REFERENCE_ROD
        self.delay, self.share = gains["delay"], gains["share"]
        self.above, self.height = 0.97 * mass, 1.09 * rod
        self.inertia = 1.15 * self.above * self.height**2

    def ankles(self, lean, rate, then):
        return (-(1.0 - self.share) * (self.kp * then[0] + self.kd * then[1])
                - self.share * (self.kp * lean + self.kd * rate))

    def angular(self, lean, torque, push, ground):
        """The lean's acceleration; push: N at the hip; ground: m/s^2."""
        load = self.above * self.height * (G * math.sin(lean) - ground * math.cos(lean))
        return (load + torque + push * self.rod * math.cos(lean)) / self.inertia

    def run(self, push, ground, seconds, fps):
        """push(t) N, ground: m/s^2 at t. -> times, lean, and what platforms see: shear (N), centre (m), by frame."""
        substeps = max(1, round(1.0 / (fps * STEP)))
        h = 1.0 / (fps * substeps)
        lag, history, frames = self.delay / h, [], int(seconds * fps) + 1
        lean = rate = 0.0

        def then(at, lean, rate):
            if lag == 0.0:
                return lean, rate
            back = at - lag
            if back <= 0.0:
                return 0.0, 0.0
            i, f = int(back), back - int(back)
            a, b = history[i], history[min(i + 1, len(history) - 1)]
            # Cubic (Hermite) in the lean, whose rate is known, and linear in the rate.
            slope = h * a[1], h * b[1]
            between = (a[0] * (1 + 2 * f) * (1 - f)**2 + slope[0] * f * (1 - f)**2 + b[0] * f * f * (3 - 2 * f)
                       - slope[1] * f * f * (1 - f))
            return between, a[1] + f * (b[1] - a[1])

        out, step = [], 0
        for _ in range(frames):
            t = step * h
            torque = self.ankles(lean, rate, then(step, lean, rate) if history else (0.0, 0.0))
            out.append((t, lean, *self.reaction(lean, rate, torque, push(t), ground(t))))
            for _ in range(substeps):
                history.append((lean, rate))
                t = step * h

                def slope(s, lean, rate, t=t, step=step):
                    torque = self.ankles(lean, rate, then(step + s, lean, rate))
                    return self.angular(lean, torque, push(t + s * h), ground(t + s * h))

                a1 = slope(0.0, lean, rate)
                r2, l2 = rate + h / 2 * a1, lean + h / 2 * rate
                a2 = slope(0.5, l2, r2)
                r3, l3 = rate + h / 2 * a2, lean + h / 2 * r2
                a3 = slope(0.5, l3, r3)
                r4, l4 = rate + h * a3, lean + h * r3
                a4 = slope(1.0, l4, r4)
                lean += h / 6 * (rate + 2 * r2 + 2 * r3 + r4)
                rate += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
                step += 1
                if abs(lean) > 0.4:
                    raise FloatingPointError("falls")
        return np.array(out).T

    def reaction(self, lean, rate, torque, push, ground):
        """Shear and centre of pressure before the ankles, of feet without mass of their own but 0.03 M that goes with the ground."""
        turn = self.angular(lean, torque, push, ground)
        along = self.height * (math.cos(lean) * turn - math.sin(lean) * rate * rate)
        up = -self.height * (math.sin(lean) * turn + math.cos(lean) * rate * rate)
        shear = self.mass * ground + self.above * along - push
        vertical = self.mass * G + self.above * up
        return shear, vertical, -(torque + ANKLE_HEIGHT * shear) / vertical


def write_person(folder, name, person, motion, shift, noise, centre_noise, random):
    """Points in the laboratory, the platform's motion and what it measured; -> keys of the manifest."""
    times, lean, shear, vertical, centre = motion
    ground = np.array([shift(t) for t in times])
    feet = np.column_stack([ground, np.zeros_like(ground)])
    hip = np.column_stack([ground + person.rod * np.sin(lean), np.zeros_like(lean), person.rod * np.cos(lean)])
    people.write_points(f"{folder}/{name}.csv", times, people.points_of(hip, feet, np.eye(3)), noise, random)
    keys = {"csv": [f"{name}.csv"], "length_unit": "m"}
    if np.any(ground):
        write_table(f"{folder}/{name}_ground.csv", ["time", "x"], [times, ground])
        keys["ground"] = {"csv": f"{name}_ground.csv"}
    if centre_noise is not None:
        def noisy(values, sigma):
            return values + sigma * random.standard_normal(len(values))

        zero = np.zeros_like(times)
        write_table(f"{folder}/{name}_plates.csv", ["time", "fx", "fy", "fz", "px", "py"],
                    [times, noisy(shear, 2.0), noisy(zero, 2.0), noisy(vertical, 2.0), noisy(centre, centre_noise),
                     noisy(zero, centre_noise)])
        keys["force_plates"] = {"use": "measure", "file": f"{name}_plates.csv"}
    return keys


def write_table(path, names, columns):
    with open(path, "w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(names)
        for row in zip(*columns):
            rows.writerow([f"{x:.6f}" for x in row])


class CartPole:
    """A laboratory's cart on a rail with a uniform pole on it: viscous and dry friction, a motor whose force is held for a frame by a
    controller for a frame. The pole starts upright and at rest, and falls."""

    def __init__(self, cart=0.5, pole=0.2, length=0.4, drag=0.8, dry=0.01):
        self.cart, self.pole, self.length, self.drag, self.dry = cart, pole, length, drag, dry

    def slope(self, state, force):
        """Of place (m), speed, angle from upright (rad) and its rate, by Lagrange's equations."""
        _, speed, angle, rate = state
        m, c, total = self.pole, 0.5 * self.length, self.cart + self.pole
        inertia = m * self.length**2 / 3.0
        sine, cosine = math.sin(angle), math.cos(angle)
        friction = self.drag * speed + self.dry * total * G * math.tanh(speed / 2e-3)
        along, about = force - friction + m * c * sine * rate * rate, m * G * c * sine
        det = total * inertia - (m * c * cosine)**2
        return np.array([speed, (inertia * along - m * c * cosine * about) / det, rate,
                         (total * about - m * c * cosine * along) / det])

    def run(self, shake, seconds, fps):
        """shake(t): N. -> times, place, angle, and the motor's force from each frame on."""
        substeps = max(1, round(1.0 / (fps * 5e-4)))
        h, state, out = 1.0 / (fps * substeps), np.zeros(4), []
        for frame in range(int(seconds * fps) + 1):
            force = shake(frame / fps)
            out.append((frame / fps, state[0], state[2], force))
            for _ in range(substeps):
                a = self.slope(state, force)
                b = self.slope(state + h / 2 * a, force)
                d = self.slope(state + h / 2 * b, force)
                e = self.slope(state + h * d, force)
                state = state + h / 6 * (a + 2 * b + 2 * d + e)
        return np.array(out).T
