"""Identified people as agents of a crowd simulation, step by step. Python alone: no NumPy, no compiled module.

    crowd = pushid.agents.Crowd("agents.json")        # of pushid-formation --agents_out
    while crowd.time < 3.0:
        crowd.iterate()
    print([agent.position for agent in crowd.agents])  # the hips, m

`PendulumModel` has the division of JuPedSim's C++ class OperationalModel (ComputeNewPosition gives an update without changing
anybody, ApplyUpdate applies it), so that a simulation calls it for each of its agents: compute_new_state(dt, agent,
neighbours), then apply_update(update, agent). It was not tried with JuPedSim itself; `Crowd` is the loop around it. Walls, goals and ways are not modelled: these people are pushed, they do
not walk.

The equations are those of pushid's models (ipm.h, self_terms.h, contact.h): an inverted pendulum on a cart whose feet slide.
Angles: theta about y (leaning forwards is positive), phi about x (leaning to the right is positive).
"""
import json
import math
from dataclasses import dataclass, field

G = 9.81  # m/s^2


@dataclass
class Agent:
    """q: cart x, y (m), theta, phi (rad); qd: its rate. parameters: the agent's entry of the file."""
    id: str
    parameters: dict
    q: list
    qd: list = field(default_factory=lambda: [0.0] * 4)
    first: list = None  # q at the start

    def __post_init__(self):
        self.first = self.first or list(self.q)

    @property
    def position(self):
        """Position of the hip, m."""
        rod, (x, y, theta, phi) = self.parameters["rod_m"], self.q
        return x + rod * math.sin(theta), y - rod * math.cos(theta) * math.sin(phi)


def agent_of(entry):
    return Agent(entry["id"], entry, [*entry["position_m"], *entry["lean_rad"]])


def rest_speed(*parts):
    """|v| that is smooth at rest."""
    return math.sqrt(sum(part * part for part in parts) + 1e-6)


class PendulumModel:
    """contact: the file's entry, or None for people who do not touch."""

    def __init__(self, contact=None):
        self.contact = contact

    def compute_new_state(self, dt, agent, neighbours, push=(0.0, 0.0, 0.0, 0.0)):
        """(q, qd) after dt seconds; nobody is changed. push: a generalized force (N, N, N m, N m)."""
        force = [a + b for a, b in zip(self.own_force(agent), push)]
        for other in neighbours:
            if other is not agent and self.contact:
                force = [a + b for a, b in zip(force, self.contact_force(agent, other))]
        qd = [v + dt * a for v, a in zip(agent.qd, self.acceleration(agent, force))]
        return [x + dt * v for x, v in zip(agent.q, qd)], qd

    @staticmethod
    def apply_update(update, agent):
        """Gives the agent what compute_new_state returned."""
        agent.q, agent.qd = update

    @staticmethod
    def own_force(agent):
        """Drag of the feet, balance, and how the feet follow the lean: (N, N, N m, N m)."""
        p, (xd, yd, thd, phd) = agent.parameters, agent.qd
        balance, steps = p["balance"], p["steps"]
        lean = [agent.q[2 + i] - balance["posture_rad"][i] for i in (0, 1)]
        drag = [d + steps["speed_drag_Ns2_per_m2"] * rest_speed(xd, yd) for d in steps["drag_Ns_per_m"]]
        torque = [balance["hold_Nm"][i] - balance["stiffness_Nm_per_rad"][i] * lean[i]
                  - (balance["damping_Nms_per_rad"][i] + steps["rate_drag_Nms2_per_rad2"] * rest_speed(rate)) * rate
                  for i, rate in enumerate((thd, phd))]
        follow = [steps["lean_N_per_rad"][i] * lean[i] + steps["lean_rate_Ns_per_rad"][i] * rate
                  for i, rate in enumerate((thd, phd))]
        return [follow[0] - drag[0] * xd, -follow[1] - drag[1] * yd,
                torque[0] + steps["speed_torque_Ns"][0] * xd, torque[1] - steps["speed_torque_Ns"][1] * yd]

    def point(self, agent, q):
        """(x, y) where the agent, at q, may touch others, m."""
        reach = self.contact["height_of_rod"] * agent.parameters["rod_m"]
        return q[0] + reach * math.sin(q[2]), q[1] - reach * math.cos(q[2]) * math.sin(q[3])

    def point_velocity(self, agent):
        """(x, y) of that point's velocity, m/s."""
        reach = self.contact["height_of_rod"] * agent.parameters["rod_m"]
        (_, _, theta, phi), (xd, yd, thd, phd) = agent.q, agent.qd
        return (xd + reach * math.cos(theta) * thd,
                yd + reach * (math.sin(theta) * math.sin(phi) * thd - math.cos(theta) * math.cos(phi) * phd))

    def distance(self, along, across):
        """Distance of points that are so far apart (m), in which people are deeper than wide."""
        return math.sqrt(along * along + (self.contact["depth_over_width"] * across)**2 + 1e-12)

    def contact_force(self, agent, other):
        """By the other on the agent: (N, N, N m, N m)."""
        c = self.contact
        (x, y), (ox, oy) = self.point(agent, agent.q), self.point(other, other.q)
        d = self.distance(x - ox, y - oy)
        if d >= c["distance_m"]:
            return [0.0] * 4
        (fx, fy), (fox, foy) = self.point(agent, agent.first), self.point(other, other.first)
        stood = self.distance(fx - fox, fy - foy)  # who stood closer stood there free of load
        free = 0.5 * (c["distance_m"] + stood - math.hypot(c["distance_m"] - stood, c["softness_m"]))
        load = free - d
        if load <= 0.0:
            return [0.0] * 4
        along = (x - ox) / d, c["depth_over_width"]**2 * (y - oy) / d
        (vx, vy), (ovx, ovy) = self.point_velocity(agent), self.point_velocity(other)
        size = c["stiffness_N_per_m"] * load - c["damping_Ns_per_m"] * (along[0] * (vx - ovx) + along[1] * (vy - ovy))
        size *= load / (load + c["onset_m"])
        return self.at_point(agent, size * along[0], size * along[1])

    def at_point(self, agent, fx, fy):
        """A force (N) at the point of contact as a generalized one: (N, N, N m, N m)."""
        reach = self.contact["height_of_rod"] * agent.parameters["rod_m"]
        theta, phi = agent.q[2], agent.q[3]
        return [fx, fy, reach * (fx * math.cos(theta) + fy * math.sin(theta) * math.sin(phi)),
                -reach * fy * math.cos(theta) * math.cos(phi)]

    @staticmethod
    def acceleration(agent, force):
        """qdd of M qdd + C + G = force (m/s^2, rad/s^2), by the Schur complement of the cart's block."""
        p = agent.parameters
        m, l, total = p["point_mass_kg"], p["pendulum_m"], p["mass_kg"]
        (_, _, theta, phi), (_, _, thd, phd) = agent.q, agent.qd
        st, ct, sp, cp = math.sin(theta), math.cos(theta), math.sin(phi), math.cos(phi)
        right = [force[0] + m * l * st * thd * thd,
                 force[1] - m * l * (2.0 * st * cp * thd * phd + ct * sp * (thd * thd + phd * phd)),
                 force[2] - m * l * l * st * ct * phd * phd + m * G * l * st * cp,
                 force[3] + 2.0 * m * l * l * st * ct * thd * phd + m * G * l * ct * sp]
        b02, b12, b13 = m * l * ct, m * l * st * sp, -m * l * ct * cp
        s22 = m * l * l - (b02 * b02 + b12 * b12) / total
        s23, s33 = -b12 * b13 / total, m * l * l * ct * ct - b13 * b13 / total
        r2 = right[2] - (b02 * right[0] + b12 * right[1]) / total
        r3 = right[3] - b13 * right[1] / total
        det = s22 * s33 - s23 * s23
        a2, a3 = (s33 * r2 - s23 * r3) / det, (s22 * r3 - s23 * r2) / det
        return [(right[0] - b02 * a2) / total, (right[1] - b12 * a2 - b13 * a3) / total, a2, a3]


class Crowd:
    """The agents, contact and pushes of a file, in steps of its time_step_s."""

    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            content = json.load(file)
        if content.get("schema") != "pushid-agents/1":
            raise ValueError(f"{path} is no file of pushid-formation --agents_out")
        self.dt, self.pushes, self.steps = content["time_step_s"], content["pushes"], 0
        self.model = PendulumModel(content.get("contact"))
        self.agents = [agent_of(entry) for entry in content["agents"]]

    @property
    def time(self):
        """Time since the start, s."""
        return self.steps * self.dt

    def push_on(self, agent):
        """What pushes of the file do at this time: (N, N, N m, N m)."""
        total = [0.0] * 4
        for push in self.pushes:
            row = self.steps - round(push["start_s"] / self.dt)
            if push["agent"] == agent.id and 0 <= row < len(push["force_N_N_Nm_Nm"]):
                total = [a + b for a, b in zip(total, push["force_N_N_Nm_Nm"][row])]
        return total

    def iterate(self):
        """One step of everybody."""
        updates = [self.model.compute_new_state(self.dt, agent, self.agents, self.push_on(agent)) for agent in self.agents]
        for update, agent in zip(updates, self.agents):
            self.model.apply_update(update, agent)
        self.steps += 1
