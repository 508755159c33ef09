"""LDP (Yue et al., CVPR 2024) as published, beside pushid's own models, on any recordings with masses and pushes.

    python3 tests/studies/ldp.py [BLOCK ...] [--recordings=MANIFEST] [--folds=4] [--jobs=N] [--write]

single     the five metrics of held-out single people (models/README.md); 40 minutes of one core
groups     the same of groups; an hour
strength   MPJPE by the strength of the push; the runs of single and groups
quarter    groups, all folds, trained on a quarter of the recordings; those of groups and half an hour
ablation   groups, all folds, parts of the restoration left out; those of groups and an hour and a half
strong     1.3736 times the strongest push, and a weak, a medium and a strong one at frames 0, 15 and 50, on the first
           fold's held-out single people; a minute
people     ten people in a line, and 13 in a diamond of whom three are pushed, from recorded people; a quarter of an hour
sizes      number of weights beside the paper's; a minute
split      the release's own split, by pushid's own models (README.md); PUSHID_LDP is a checkout of the release; some minutes.
           Not a choice was made on its other list, and none may be

Without --recordings the published recordings of PUSHID_RECORDINGS. Where the manifest's recordings have a `split` (train or
eval, as python3 -m pushid.ldp writes it), that is used; otherwise folds, stratified by setting and strength. As published
means: --preset=ldp_published, then --kind=cvae --training=published on the recorded pendulums, nothing post-processed.
Everything is trained anew in every fold. What was run is kept (studies.py). Needs pushid-train-restoration, which is built
where LibTorch is found.
"""
import collections
import concurrent.futures
import csv
import datetime
import functools
import hashlib
import json
import math
import os
import statistics
import subprocess
import sys

import studies
from studies import number, with_error

METRICS = [("MPJPE_m", "MPJPE, m"), ("hipADE_m", "hipADE, m"), ("hipFDE_m", "hipFDE, m"), ("MBLE_m", "MBLE, m"),
           ("FSE_cm", "FSE, cm a frame")]
# The paper's tables, on its own split; what its released weights gave on that split (hips alone).
CLAIMS = {"single": (0.097, 0.086, 0.171, 0.002, 0.131), "groups": (0.106, 0.092, 0.218, 0.003, 0.069)}
# Its released weights lack the interaction network, which was never released.
RELEASED = {"single": (None, 0.212, 0.352, None, None), "groups": (None, 0.125, 0.280, None, None)}
RELEASED_NAME = {"single": "its released weights, its split",
                 "groups": "its released weights, without the interaction network, its split"}
EXTRA_STRONG = 1.3736  # of the strongest push

PUBLISHED_FIT = ["--preset=ldp_published"]
PUBLISHED_BODIES = ["--kind=cvae", "--training=published", "--coordinates=ldp"]
OWN_BODIES = {"single": [], "groups": ["--sees=neighbours"]}


def option(name, default):
    given = [a for a in sys.argv[1:] if a.startswith(f"--{name}=")]
    for a in given:
        sys.argv.remove(a)
    return given[-1].partition("=")[2] if given else default


MANIFEST = os.path.abspath(option("recordings", studies.MANIFEST))
FOLDS = int(option("folds", 4))
JOBS = int(option("jobs", os.cpu_count()))


def entries(setting):
    """Of the manifest, with paths that hold anywhere."""
    if not os.path.exists(MANIFEST):
        sys.exit(f"{MANIFEST} is missing: name the recordings by --recordings=MANIFEST")
    with open(MANIFEST, encoding="utf-8") as file:
        all_entries = json.load(file)["recordings"]
    folder = os.path.dirname(MANIFEST)
    found = []
    for e in all_entries:
        if (len(e["subjects"]) > 1) != (setting == "groups"):
            continue
        e = dict(e, bvh=[os.path.join(folder, b) for b in e["bvh"]])
        if "push_csv" in e:
            e["push_csv"] = os.path.join(folder, e["push_csv"])
        e["pushes"] = [dict(p, csv=os.path.join(folder, p["csv"])) for p in e.get("pushes", [])]
        if not e["pushes"]:
            del e["pushes"]
        found.append(e)
    if not found:
        sys.exit(f"{MANIFEST} has no recordings of {setting}")
    return found


def written(recordings):
    """The path of a manifest with these recordings, named after what it holds."""
    os.makedirs(studies.KEPT, exist_ok=True)
    text = json.dumps({"recordings": recordings}, indent=1)
    path = os.path.join(studies.KEPT, f"ldp-{hashlib.sha256(text.encode()).hexdigest()[:16]}.json")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def folds(setting):
    """(name, training, held out) of each."""
    recordings = entries(setting)
    train, held = ([e for e in recordings if e.get("split") == split] for split in ("train", "eval"))
    if train and held:
        return [("split", train, held)]
    order = sorted(recordings, key=lambda e: (e["setting"], e.get("magnitude", ""), e["id"]))
    return [(f"fold{k + 1}", [e for i, e in enumerate(order) if i % FOLDS != k],
             [e for i, e in enumerate(order) if i % FOLDS == k]) for k in range(FOLDS)]


class Trained:
    """A pendulum's model and, once asked for, a restoration, trained on a fold."""

    def __init__(self, fold, fit, bodies):
        _, train, held = fold
        self.train, self.held, self.flags = written(train), written(held), bodies
        self.fitted = studies.run("pushid-fit", f"--recordings={self.train}", *fit, out="model_out")

    @functools.cached_property
    def restoration(self):
        program = studies.program_bytes(os.path.join(studies.BIN, "pushid-train-restoration"))
        key = hashlib.sha256(program + "\0".join([self.fitted.path, *self.flags]).encode()).hexdigest()[:16]
        folder = os.path.join(studies.KEPT, f"ldp-bodies-{key}")
        self.seconds = studies.run("pushid-train-restoration", f"--recordings={self.train}", f"--model={self.fitted.path}",
                                   f"--out={folder}", *self.flags, out=None).seconds
        return folder

    def hips(self):
        return studies.run("pushid-evaluate", f"--recordings={self.held}", f"--model={self.fitted.path}").json

    def scores(self, *flags):
        return studies.run("pushid-evaluate", f"--recordings={self.held}", f"--model={self.fitted.path}",
                           f"--restoration={self.restoration}", *flags).json


def own(setting, fold):
    return Trained(fold, [], OWN_BODIES[setting])


def published(_, fold):
    return Trained(fold, PUBLISHED_FIT, PUBLISHED_BODIES)


def in_parallel(calls):
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        return [done.result() for done in [pool.submit(call) for call in calls]]


def clustered(rows, metric):
    """The mean over recordings and its standard error by the pushed person."""
    values = [r[metric] for r in rows]
    mean = statistics.mean(values)
    groups = collections.defaultdict(float)
    for r in rows:
        groups[r["person"]] += r[metric] - mean
    g = len(groups)
    error = math.sqrt(g / (g - 1) * sum(v * v for v in groups.values())) / len(values) if g > 1 else math.nan
    return mean, error


def mean_cell(rows, metric):
    if not rows:
        return None
    mean, error = clustered(rows, metric)
    return "0" if mean < 1e-6 else with_error(mean, error)


def rows_of(json_of_fold, held):
    """Scores by recording; one that could not be rolled out has none and is counted."""
    person = {e["id"]: e["subjects"][e["pushed_person"]]["id"] for e in held}
    strength = {e["id"]: e.get("magnitude", "") for e in held}
    return [dict(r, person=person[r["id"]], strength=strength[r["id"]]) for r in json_of_fold["recordings"]]


def trained_on(made, train, setting):
    """Of these folds, in parallel, with their bodies."""
    def one(fold):
        trained = train(setting, fold)
        return trained, trained.restoration

    return [trained for trained, _ in in_parallel([lambda f=f: one(f) for f in made])]


def evaluated(setting, train, *flags, made=None):
    """Of all folds: recordings' scores, and the seconds that pendulum and bodies took."""
    made = made or folds(setting)
    trained = trained_on(made, train, setting)
    rows = []
    for one, fold in zip(trained, made):
        rows += rows_of(one.scores(*flags), fold[2])
    return rows, [t.fitted.seconds for t in trained], [t.seconds for t in trained]


def cells(rows):
    scored = [r for r in rows if "MPJPE_m" in r]
    return [f"{len(scored)} of {len(rows)}"] + [mean_cell(scored, key) for key, _ in METRICS]


def minutes(seconds):
    return f"{statistics.mean(seconds) / 60:.1f}"


def claim(values):
    return [number(v) if v is not None else None for v in values]


def tables(setting):
    rows = [["claim of the paper, its split", None, *claim(CLAIMS[setting]), "900, with bodies", None],
            [RELEASED_NAME[setting], None, *claim(RELEASED[setting]), None, None]]
    for name, train, flags in [("as published, z its mean", published, ["--postprocess=none"]),
                               ("as published, z drawn", published, ["--postprocess=none", "--latent=draw"]),
                               ("pushid's own", own, [])]:
        scores, fit_seconds, body_seconds = evaluated(setting, train, *flags)
        rows.append([name, *cells(scores), minutes(fit_seconds), minutes(body_seconds)])
    hips = [r for fold in folds(setting) for r in rows_of(published(setting, fold).hips(), fold[2]) if "hipADE_m" in r]
    rows.insert(2, ["as published, the pendulum alone", str(len(hips)), None, mean_cell(hips, "hipADE_m"),
                    mean_cell(hips, "hipFDE_m"), None, None, None, None])
    header = ["", "rolled out", *[title for _, title in METRICS], "pendulum, minutes", "bodies, minutes"]
    return studies.table(header, rows)


def strength():
    rows = []
    for setting in CLAIMS:
        found = {name: evaluated(setting, train, *flags)[0]
                 for name, train, flags in [("published", published, ["--postprocess=none"]), ("own", own, [])]}
        for kind in sorted({r["strength"] for r in found["own"]}):
            cell = []
            for name in found:
                scored = [r for r in found[name] if r["strength"] == kind and "MPJPE_m" in r]
                cell += [mean_cell(scored, key) for key in ("MPJPE_m", "hipADE_m", "hipFDE_m")]
            rows.append([setting, kind, *cell])
    metrics = ["MPJPE, m", "hipADE, m", "hipFDE, m"]
    return studies.table(["", "push", *[f"{m}, {n}" for n in ("as published", "own") for m in metrics]], rows)


def quarter():
    rows = []
    for name, part in [("all", 1), ("a quarter", 4)]:
        less = [(n, train[::part], held) for n, train, held in folds("groups")]
        scores, _, _ = evaluated("groups", published, "--postprocess=none", made=less)
        rows.append([f"{name} ({len(less[0][1])} recordings)", *cells(scores)])
    return studies.table(["as published, groups, trained on", "rolled out", *[title for _, title in METRICS]], rows)


# The paper's Table 2: MPJPE, hipADE and hipFDE of groups, its split.
ABLATION = [("lower then upper, pendulum", [], (0.106, 0.092, 0.218)),
            ("one network, pendulum", ["--nohalves"], (0.110, 0.094, 0.242)),
            ("lower then upper, no pendulum, three draws averaged", ["--sees=pose"], (0.206, 0.184, 0.320)),
            ("one network, no pendulum, three draws averaged", ["--sees=pose", "--nohalves"], (0.217, 0.195, 0.341))]


def ablation():
    rows = []
    for name, bodies, said in ABLATION:
        own_flags = [b for b in PUBLISHED_BODIES if not (b.startswith("--coordinates") and "--sees=pose" in bodies)]
        scores, _, _ = evaluated("groups", lambda _, fold, b=[*own_flags, *bodies]: Trained(fold, PUBLISHED_FIT, b),
                                 "--postprocess=none")
        rows.append([name, *cells(scores), " / ".join(number(v) for v in said)])
    return studies.table(["as published, groups", "rolled out", *[title for _, title in METRICS],
                          "claim: MPJPE / hipADE / hipFDE"], rows)


def peak(e):
    """The largest horizontal force of a recording's push, N."""
    files = [e["push_csv"]] if "push_csv" in e else [p["csv"] for p in e["pushes"]]
    forces = []
    for path in files:
        with open(path, encoding="utf-8") as file:
            forces += [math.hypot(float(r["fx"]), float(r["fy"])) for r in csv.DictReader(file)]
    return max(forces)


def pushed_as(e, other):
    """A recording with the push of another."""
    def of_push(key):
        return key.startswith("push") and key != "pushed_person"

    return {**{k: v for k, v in e.items() if not of_push(k)}, **{k: v for k, v in other.items() if of_push(k)}}


def path_of(trained, manifest, recording, *flags):
    """Hip by frame of person 0, or None where the rollout left the domain."""
    done = studies.run("pushid-predict", f"--recordings={manifest}", f"--model={trained.fitted.path}",
                       f"--id={recording}", *flags, out="out", keep=True, ending="csv", may_fail=True)
    if done.failed:
        return None
    with open(done.path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def strong():
    fold = folds("single")[0]
    _, train, held = fold
    strongest = written([pushed_as(e, max(train, key=peak)) for e in held])
    means = {kind: statistics.mean(peak(e) for e in train if e["magnitude"] == kind)
             for kind in ("weak", "medium", "strong")}
    again = ",".join(f"{at}:{means[kind] / means['weak']:.3f}" for at, kind in [(15, "medium"), (50, "strong")])
    every, weak = [e["id"] for e in held], [e["id"] for e in held if e["magnitude"] == "weak"]
    rows = []
    for system, trained in [("as published", published("single", fold)), ("pushid's own", own("single", fold))]:
        for name, manifest, ids, flags in [
                ("as recorded", trained.held, every, []),
                (f"{EXTRA_STRONG} times the strongest", strongest, every, [f"--push_scale={EXTRA_STRONG}"]),
                (f"weak ones, again at {again}", trained.held, weak, [f"--push_again={again}"])]:
            paths = [path_of(trained, manifest, i, "--frames=240", *flags) for i in ids]
            whole = [p for p in paths if p]
            lean = [max(abs(float(row["theta_rad"])) for row in p) for p in whole]
            way = [math.hypot(*(float(p[-1][k]) - float(p[0][k]) for k in ("hip_x_m", "hip_y_m"))) for p in whole]
            speed = [math.hypot(float(p[-1]["xd_m_s"]), float(p[-1]["yd_m_s"])) for p in whole]
            still = sum(v < 0.1 for v in speed)
            rows.append([system, name, f"{len(whole)} of {len(paths)}", number(statistics.median(lean), 2) if lean else None,
                         number(statistics.median(way), 2) if way else None, f"{still} of {len(whole)}"])
    return studies.table(["", "push", "rolled out", "largest lean, rad (median)", "way of the hip, m (median)",
                          "slower than 0.1 m/s at the end"], rows)


def people():
    fold = folds("groups")[0]
    rows = []
    for system, trained in [("as published", published("groups", fold)), ("pushid's own", own("groups", fold))]:
        for name, flags in [("ten in a line", ["--formation=line", "--people=10"]),
                            ("13 in a diamond, three pushed", ["--formation=diamond", "--people=13", "--pushed=0,1,2"])]:
            done = studies.run("pushid-formation", f"--model={trained.fitted.path}", *flags,
                               f"--recordings={trained.train}", f"--restoration={trained.restoration}", "--push=80",
                               "--duration=4", out="csv_out", ending="csv", may_fail=True)
            if done.failed:
                rows.append([system, name, "left the domain", None, None])
                continue
            with open(done.path, encoding="utf-8") as file:
                path = list(csv.DictReader(file))
            by_person = collections.defaultdict(list)
            for row in path:
                by_person[row["person"]].append(row)
            fastest = [max(math.hypot(float(r["xd_m_s"]), float(r["yd_m_s"])) for r in p) for p in by_person.values()]
            rows.append([system, name, f"{sum(v > 0.1 for v in fastest)} of {len(fastest)}", number(max(fastest), 2),
                         number(done.seconds / max(len(p) for p in by_person.values()) * 1e3, 2)])
    return studies.table(["80 N s on each who is pushed", "", "faster than 0.1 m/s", "fastest, m/s",
                          "ms a frame, with reading and bodies"], rows)


def sizes():
    # Of two recordings and hardly any step: sizes are the same.
    alone, groups = (Trained(("two", folds(s)[0][1][:2], []), PUBLISHED_FIT, [*PUBLISHED_BODIES, "--effort=0.001"])
                     for s in CLAIMS)
    with open(os.path.join(alone.restoration, "restoration.json"), encoding="utf-8") as file:
        counted = json.load(file)["training"]["parameters"]
    bodies = sum(counted.values())
    counted["self force, rod"] = len(alone.fitted.json["self_network"]["weights"])
    counted["self force, rod, interaction"] = len(groups.fitted.json["self_network"]["weights"])
    counted["single people, in all"] = bodies + counted["self force, rod"]
    counted["groups, in all"] = bodies + counted["self force, rod, interaction"]
    others = {"lower autoencoder": "865,536 (release)", "upper autoencoder": "1,097,904 (release)",
              "single people, in all": "2.67 M (Table 3)", "groups, in all": "2.94 M (Table 3)"}
    return studies.table(["network", "weights", "LDP"], [[n, f"{count:,}", others.get(n)] for n, count in counted.items()])


def split():
    checkout = os.environ.get("PUSHID_LDP") or sys.exit("ldp.py split: PUSHID_LDP names a checkout of LDP's release")
    part = {}
    for name in ("train", "eval"):
        folder = os.path.join(studies.KEPT, f"ldp-{name}-{hashlib.sha256(os.path.abspath(checkout).encode()).hexdigest()[:8]}")
        if not os.path.exists(folder):
            os.makedirs(studies.KEPT, exist_ok=True)
            subprocess.run([sys.executable, "-m", "pushid.ldp", f"--split={name}", checkout, folder], check=True,
                           stdout=sys.stderr, env=dict(os.environ, PYTHONPATH=os.path.join(studies.SOURCE, "apps/python")))
        part[name] = f"--recordings={folder}/manifest.json"

    def physics(setting):
        fitted = studies.run("pushid-fit", part["train"], f"--setting={setting}", out="model_out").path
        return studies.run("pushid-evaluate", part["eval"], f"--setting={setting}", f"--model={fitted}").json["mean"]

    generator = studies.run("pushid-train-generator", part["train"], "--setting=groups", "--kind=diffusion", out="out").path
    diffused = studies.run("pushid-generate", part["eval"], "--setting=groups", f"--model={generator}").json["mean"]

    def cell(hip, last):
        return f"{number(hip)} / {number(last)}"

    def mean(found):
        return cell(found["hipADE_m"], found["hipFDE_m"])

    version = studies.run("pushid-fit", "--version", out=None, keep=False).text.strip().replace("-fit", "")
    return studies.table([f"LDP's own split ({version}, {datetime.date.today():%d %B %Y})", "single people", "groups"],
                         [["physics (`tail`, `group`)", mean(physics("single")), mean(physics("groups"))],
                          ["diffusion alone", None, f"{mean(diffused)}, MPJPE {number(diffused['MPJPE_m'])}"],
                          ["LDP (Yue et al., CVPR 2024), claimed", cell(*CLAIMS["single"][1:3]),
                           f"{cell(*CLAIMS['groups'][1:3])}, MPJPE {number(CLAIMS['groups'][0])}"],
                          ["its released weights (groups: without the interaction network)",
                           *(cell(*RELEASED[s][1:3]) for s in ("single", "groups"))]])


if __name__ == "__main__":
    studies.main(__file__, {"single": lambda: tables("single"), "groups": lambda: tables("groups"),
                            "strength": strength, "quarter": quarter, "ablation": ablation, "strong": strong,
                            "people": people, "sizes": sizes, "split": split})
