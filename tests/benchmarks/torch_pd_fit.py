"""Baseline: the six-parameter PD model of scipy_pd_fit.py fitted with PyTorch.

The same recordings, physics, starts and robust loss; all recordings are rolled out side by side, and the
gradient is autograd's through all frames. The optimizer is torch.optim.LBFGS with its Wolfe line search,
until the cost stands still by 1e-9. Run by hand (packages: python3-numpy python3-torch); it is no part of
the tests:

  OMP_NUM_THREADS=1 python3 tests/benchmarks/torch_pd_fit.py ../shared/fzj_push/manifest.json
"""
import argparse
import time

import numpy as np
import torch

from scipy_pd_fit import G, NAMES, REFERENCE_MASS, STARTS, load


def rollout(parameters, data):
    """Hip positions [recording, frame, 3]; people who pass 1.4 rad stay where they are."""
    mass, l = data["mass"], data["length"]
    m = 0.9 * mass
    scale = mass / REFERENCE_MASS
    c_x, c_y, kp_th, kp_ph, kd_th, kd_ph = (p * scale for p in parameters)
    q, qd = data["q0"], torch.zeros_like(data["q0"])
    standing = torch.ones(len(mass), 1, dtype=torch.float64)
    zero = torch.zeros_like(mass)
    path = [q]
    for t in range(data["push"].shape[1] - 1):
        s, c = torch.sin(q[:, 2]), torch.cos(q[:, 2])
        sp, cp = torch.sin(q[:, 3]), torch.cos(q[:, 3])
        thd, phd = qd[:, 2], qd[:, 3]
        own = torch.stack([-c_x * qd[:, 0], -c_y * qd[:, 1], -kp_th * q[:, 2] - kd_th * thd,
                           -kp_ph * q[:, 3] - kd_ph * phd], 1)
        pushed = (t < data["push_frames"])[:, None]
        inertia = torch.stack([m * l * s * thd**2,
                               -m * l * (2 * s * cp * thd * phd + c * sp * (thd**2 + phd**2)),
                               -m * l**2 * s * c * phd**2 + m * G * l * s * cp,
                               2 * m * l**2 * s * c * thd * phd + m * G * l * c * sp], 1)
        force = torch.where(pushed, data["push"][:, t], own) + inertia
        matrix = torch.stack([mass, zero, m * l * c, zero,
                              zero, mass, m * l * s * sp, -m * l * c * cp,
                              m * l * c, m * l * s * sp, m * l**2, zero,
                              zero, -m * l * c * cp, zero, m * l**2 * c**2], 1).reshape(-1, 4, 4)
        qd = (qd + data["dt"] * torch.linalg.solve(matrix, force)) * standing
        new_q = q + data["dt"] * qd
        standing = standing * (new_q[:, 2:].abs().amax(1, keepdim=True) < 1.4)
        qd, q = qd * standing, torch.where(standing > 0, new_q, q)
        path.append(q)
    path = torch.stack(path, 1)
    lr = l[:, None]
    return torch.stack([path[:, :, 0] + lr * torch.sin(path[:, :, 2]),
                        path[:, :, 1] - lr * torch.cos(path[:, :, 2]) * torch.sin(path[:, :, 3]),
                        data["height"][:, None] + lr * torch.cos(path[:, :, 2]) * torch.cos(path[:, :, 3])], 2)


def cost(parameters, data):
    """Half of least_squares' soft_l1 of every coordinate, f_scale 0.1 m."""
    squares = ((rollout(parameters, data) - data["hip"])[data["valid"]] / 0.1)**2
    return 0.1**2 * (torch.sqrt(1.0 + squares) - 1.0).sum()


def fit(start, data):
    scale = torch.tensor([100.0, 100.0, 1500.0, 1500.0, 70.0, 70.0], dtype=torch.float64)
    z = (torch.tensor(start, dtype=torch.float64) / scale).requires_grad_(True)
    optimizer = torch.optim.LBFGS([z], max_iter=200, tolerance_change=1e-9, line_search_fn="strong_wolfe")
    evaluations = 0

    def closure():
        nonlocal evaluations
        evaluations += 1
        optimizer.zero_grad()
        value = cost(z * scale, data)
        value.backward()
        return value

    optimizer.step(closure)
    with torch.no_grad():
        return z * scale, cost(z * scale, data).item(), evaluations


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("manifest")
    parser.add_argument("--start", choices=sorted(STARTS))
    arguments = parser.parse_args()
    torch.set_num_threads(1)
    begin = time.perf_counter()
    data = {key: torch.as_tensor(value) if isinstance(value, np.ndarray) else value
            for key, value in load(arguments.manifest).items()}
    print("%d recordings read in %.2f s" % (len(data["mass"]), time.perf_counter() - begin))
    for name in [arguments.start] if arguments.start else STARTS:
        begin = time.perf_counter()
        parameters, value, evaluations = fit(STARTS[name], data)
        seconds = time.perf_counter() - begin
        print("start '%s': cost %.4f, %d evaluations, %.2f s" % (name, value, evaluations, seconds))
        print("  " + ", ".join("%s %.4g" % pair for pair in zip(NAMES, parameters.tolist())))


if __name__ == "__main__":
    main()
