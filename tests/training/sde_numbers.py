"""Numbers of SDE's Eq. 6 and Eq. 12 for losses_torch_test.cc, by another way than the code: loops over scalars, and
derivatives by central differences in 60 digits (Eq. 6), in double precision where a critic is evaluated (Eq. 12)."""
from decimal import Decimal, getcontext
from math import cos, exp, sin, sqrt

getcontext().prec = 60
TINY = Decimal(10) ** -25

MISSES = [["0.5", "-1.0", "0.25"], ["-0.75", "0.5", "1.5"]]  # p - f, [frame][coordinate]
LOG_DIAGONAL = [["0.1", "-0.4", "0.3"], ["-0.2", "0.0", "-0.5"]]  # log g^ii
BELOW = [["0.2", "-0.3", "0.4"], ["0.6", "0.1", "-0.5"]]  # g^10, g^20, g^21
DRAWN = [["1.0", "-0.5", "2.0"], ["0.3", "-1.2", "-0.7"]]  # w


def values():
    return {name: [[Decimal(v) for v in row] for row in rows]
            for name, rows in (("misses", MISSES), ("log diagonal", LOG_DIAGONAL), ("below", BELOW), ("drawn", DRAWN))}


def noise_matrix(of, t):
    a, b, c = of["below"][t]
    d = [x.exp() for x in of["log diagonal"][t]]
    return [[d[0], 0, 0], [a, d[1], 0], [b, c, d[2]]]


def as_printed(of):
    """Mean over frames and coordinates of (p^i - f^i - sum_j g^ij w^j)^2."""
    total = Decimal(0)
    for t in range(2):
        g = noise_matrix(of, t)
        for i in range(3):
            total += (of["misses"][t][i] - sum(g[i][j] * of["drawn"][t][j] for j in range(3))) ** 2
    return total / 6


def with_determinant(of):
    """Mean of log g^ii + v_i^2 / 2, where g v = p - f."""
    total = Decimal(0)
    for t in range(2):
        g, v = noise_matrix(of, t), []
        for i in range(3):
            v.append((of["misses"][t][i] - sum(g[i][j] * v[j] for j in range(i))) / g[i][i])
        total += sum(of["log diagonal"][t]) + sum(x * x for x in v) / 2
    return total / 6


def derivatives(loss, name):
    found = []
    for t in range(2):
        for i in range(3):
            sides = []
            for step in (TINY, -TINY):
                of = values()
                of[name][t][i] += step
                sides.append(loss(of))
            found.append((sides[0] - sides[1]) / (2 * TINY))
    return found


WIDTH, INPUTS = 256, 6
FORECAST = [[0.3, -0.2, 0.5, 0.1, -0.4, 0.6], [-0.5, 0.2, 0.1, 0.7, 0.3, -0.1]]
TRUTH = [[0.1, 0.4, -0.3, 0.2, 0.2, 0.5], [0.6, -0.6, 0.2, -0.2, 0.4, 0.3]]
SHARE = [0.25, 0.7]  # of the way from forecast to truth


def critic(x):
    """Three fully connected layers; weight (i, j) of layer l is 2 sin(1 + i + 3 j + l) / sqrt(inputs), bias 0.1 cos(i + l)."""
    for l, (outputs, inputs) in enumerate([(WIDTH, INPUTS), (WIDTH, WIDTH), (1, WIDTH)]):
        scale = 2.0 / sqrt(inputs)
        x = [0.1 * cos(i + l) + scale * sum(sin(1 + i + 3 * j + l) * x[j] for j in range(inputs)) for i in range(outputs)]
        if l < 2:
            x = [v if v > 0 else exp(v) - 1 for v in x]
    return x[0]


def slope(x, step=1e-5):
    total = 0.0
    for k in range(INPUTS):
        sides = [critic([v + s * step * (k == i) for i, v in enumerate(x)]) for s in (1, -1)]
        total += ((sides[0] - sides[1]) / (2 * step)) ** 2
    return sqrt(total)


def equation_12():
    made, real = (sum(map(critic, motions)) / 2 for motions in (FORECAST, TRUTH))
    between = [[s * t + (1 - s) * f for t, f in zip(truth, forecast)]
               for s, truth, forecast in zip(SHARE, TRUTH, FORECAST)]
    return made, real, made - real + 10 * sum((slope(x) - 1) ** 2 for x in between) / 2


if __name__ == "__main__":
    for title, loss in (("Eq. 6 as printed", as_printed), ("Eq. 6 with the determinant", with_determinant)):
        print(f"{title}: {loss(values()):.12f}")
        for name in ("misses", "log diagonal", "below"):
            print(f"  by {name}: " + ", ".join(f"{d:.12f}" for d in derivatives(loss, name)))
    made, real, loss = equation_12()
    print(f"Eq. 12: score of the forecasts {made:.9f}, of the truths {real:.9f}, the critic's loss {loss:.7f}")
