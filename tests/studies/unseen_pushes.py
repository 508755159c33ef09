"""People whose push goes on after what was measured of it: a simulator of its own, without any code of pushid.

A pendulum on a cart in one plane, in continuous time (Runge-Kutta, 600 steps a second); feet with friction, balance about
the ankles from the initial posture, a measured push at the hip (a half-sine), and after its first frames a force at the
hip that nobody measures: an Ornstein-Uhlenbeck process of a standard deviation of `hidden` m/s^2 over the mass and a time
of 0.15 s. Places have errors of 1 mm that are correlated over 0.1 s.
"""
import math
import random

FPS, SUBSTEPS, GRAVITY = 60, 10, 9.81
HIDDEN_TIME = 0.15  # s


class Person:
    def __init__(self, rng):
        self.mass = rng.uniform(55, 100)
        self.rod = rng.uniform(0.85, 1.02)
        self.drag = 30 * math.exp(0.2 * rng.gauss(0, 1))
        self.stiffness = 1800 * math.exp(0.15 * rng.gauss(0, 1))
        self.damping = 200 * math.exp(0.15 * rng.gauss(0, 1))
        self.follow = -9 + 1.5 * rng.gauss(0, 1)

    def rates(self, state, lean, force):
        """Accelerations of cart and lean under a horizontal force at the hip, N."""
        _, theta, speed, rate = state
        m, l, scale = 0.9 * self.mass, self.rod, self.mass / 85
        hold = -m * GRAVITY * l * math.sin(lean)
        cart = force - scale * self.drag * speed + self.mass * self.follow * (theta - lean) + m * l * math.sin(theta) * rate ** 2
        turn = (force * l * math.cos(theta) + hold - scale * l / 0.95 * self.stiffness * (theta - lean)
                - scale * (l / 0.95) ** 2 * self.damping * rate + m * GRAVITY * l * math.sin(theta))
        a, b, c = self.mass, m * l * math.cos(theta), m * l * l
        determinant = a * c - b * b
        return (c * cart - b * turn) / determinant, (a * turn - b * cart) / determinant


def step(person, state, lean, force, dt):
    def slope(s):
        return (s[2], s[3], *person.rates(s, lean, force))

    def moved(s, k, h):
        return tuple(x + h * y for x, y in zip(s, k))

    k1 = slope(state)
    k2 = slope(moved(state, k1, dt / 2))
    k3 = slope(moved(state, k2, dt / 2))
    k4 = slope(moved(state, k3, dt))
    return tuple(x + dt / 6 * (p + 2 * q + 2 * r + s) for x, p, q, r, s in zip(state, k1, k2, k3, k4))


def recording(person, rng, hidden, frames=100, push_frames=12):
    """Hip and ankles (frames, 3), and the measured rows, N."""
    strength = rng.uniform(150, 450)
    rows = [strength * math.sin(math.pi * (t + 0.5) / push_frames) for t in range(push_frames)]
    lean = 0.03 + 0.01 * rng.gauss(0, 1)
    state, unknown = (0.0, lean, 0.0, 0.0), 0.0
    hip, left, right = [], [], []
    keep, error = math.exp(-1 / FPS / 0.1), [rng.gauss(0, 1e-3) for _ in range(3)]
    decay = math.exp(-1 / FPS / HIDDEN_TIME)
    for t in range(frames):
        x, theta = state[0], state[1]
        noise = [0.0] * 3 if t == 0 else error
        hip.append((x + person.rod * math.sin(theta) + noise[0], noise[1], 0.08 + person.rod * math.cos(theta)))
        left.append((x + noise[2], 0.1, 0.08))
        right.append((x + noise[2], -0.1, 0.08))
        error = [keep * e + math.sqrt(1 - keep ** 2) * rng.gauss(0, 1e-3) for e in error]
        force = unknown + (rows[t] if t < push_frames else 0.0)
        for _ in range(SUBSTEPS):
            state = step(person, state, lean, force, 1 / FPS / SUBSTEPS)
        if t >= push_frames // 2:
            unknown = decay * unknown + math.sqrt(1 - decay ** 2) * hidden * person.mass * rng.gauss(0, 1)
    return hip, left, right, rows


def study(seed, people=4, each=6, hidden=1.0):
    """[(name, mass, recording)] of every person."""
    rng = random.Random(seed)
    made = []
    for p in range(people):
        person = Person(rng)
        for _ in range(each):
            made.append((f"P{p}", person.mass, recording(person, rng, hidden)))
    return made
