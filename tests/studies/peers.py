"""Forecasters without a pendulum and a push beside the chain of physics and bodies: MRT and siMLPe, in PyTorch.

groups    both and the chain on all groups, five folds (models/restoration/README.md); three quarters of an hour
sizes     what an epoch of MRT costs in its two sizes (models/restoration/README.md); five minutes

MRT: Wang et al., Multi-person 3D motion prediction with multi-range transformers, NeurIPS 2021. Two encoders, over the
cosine coefficients of the displacements of the person asked for and of everybody, with where everybody is seen from
that person; a decoder whose query is that person's last pose; 20 frames given, 20 predicted at once, and on. Apart from
the paper one linear layer gives the output, the decoder has no self-attention (its query is one), and there is no
discriminator: errors are judged, not looks. siMLPe: Guo et al., Back to MLP, WACV 2023: a perceptron over cosine
coefficients of 12 frames, person by person. PUSHID_PEERS=published takes the published widths of both (hours);
PUSHID_PEERS_EFFORT multiplies the length of the training.

Both see the recordings as they are published: 22 joints in the order of models/restoration/body.h, in mm, at 60 Hz. Folds are stratified by
setting and strength, as those of the chain, but are not the same. The metrics are those of ident/bodies/body_evaluation.cc.
Times are those of one core. Needs Debian's python3-torch (study_packages of tests/install_packages.sh) and
pushid-train-restoration.
"""
import json
import math
import os
import statistics
import sys
import time

import studies
from studies import number, with_error

try:
    import torch
    from torch import nn
except ImportError:
    sys.exit("peers.py is skipped: there is no PyTorch (apt-get install python3-torch, and run it by /usr/bin/python3)")

PARENTS = [0, 0, 1, 2, 3, 4, 3, 6, 7, 8, 3, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20]
HIP, RIGHT_HIP, LEFT_HIP, ANKLES = 0, 14, 18, (16, 20)
GIVEN = 20  # frames, of MRT; as many are predicted at once
SIMLPE_GIVEN = 12
PUBLISHED = os.environ.get("PUSHID_PEERS") == "published"
EFFORT = float(os.environ.get("PUSHID_PEERS_EFFORT", "1"))
SIZES = {"small": (64, 128, 2, 4, 16), "published": (128, 1024, 3, 8, 64)}  # width, inner, layers, heads, width of one
FOLDS = 5


def read_bvh(path):
    """Joint positions [frame, joint, 3], m."""
    with open(path, encoding="utf-8") as file:
        head, _, motion = file.read().partition("MOTION")
    parents, offsets, open_joints = [], [], []
    for line in map(str.split, head.splitlines()):
        if line[:1] in (["ROOT"], ["JOINT"]):
            parents.append(open_joints[-1] if open_joints else -1)
            open_joints.append(len(offsets))
        elif line[:1] == ["End"]:
            open_joints.append(None)
        elif line[:1] == ["OFFSET"] and open_joints[-1] is not None:
            offsets.append(torch.tensor([float(v) for v in line[1:]]))
        elif line[:1] == ["}"]:
            open_joints.pop()
    rows = torch.tensor([[float(v) for v in line.split()] for line in motion.splitlines()[3:] if line.strip()])
    angles = torch.deg2rad(rows[:, 3:]).view(len(rows), -1, 3)  # about z, y, x
    turns, places = [], []
    for j, parent in enumerate(parents):
        (cz, cy, cx), (sz, sy, sx) = angles[:, j].cos().T, angles[:, j].sin().T
        own = torch.stack([cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx, sz * cy, sz * sy * sx + cz * cx,
                           sz * sy * cx - cz * sx, -sy, cy * sx, cy * cx], 1).view(-1, 3, 3)
        turns.append(own if parent < 0 else turns[parent] @ own)
        places.append(rows[:, :3] + offsets[j] if parent < 0 else places[parent] + turns[parent] @ offsets[j])
    return torch.stack(places, 1) / 1000.0


def load():
    """(entry of the manifest, motions [person, frame, joint, 3]) of every group."""
    with open(studies.MANIFEST, encoding="utf-8") as file:
        entries = [e for e in json.load(file)["recordings"] if len(e["subjects"]) > 1]
    return [(e, torch.stack([read_bvh(os.path.join(studies.RECORDINGS, b)) for b in e["bvh"]])) for e in entries]


def folds(recordings, count, seed=1):
    """Indices of what each fold holds out, by setting and strength."""
    order = sorted(range(len(recordings)), key=lambda i: (recordings[i][0]["setting"], recordings[i][0].get("magnitude", ""),
                                                         hash((seed, recordings[i][0]["index"]))))
    return [[i for place, i in enumerate(order) if place % count == k] for k in range(count)]


def mirrored(motions):
    swapped = list(range(6)) + [10, 11, 12, 13, 6, 7, 8, 9, 18, 19, 20, 21, 14, 15, 16, 17]
    return motions[..., swapped, :] * torch.tensor([1.0, -1.0, 1.0])


def cosines(count):
    """The orthonormal transform: a row for each coefficient."""
    k, t = torch.arange(count).view(-1, 1), torch.arange(count) + 0.5
    rows = math.sqrt(2.0 / count) * torch.cos(math.pi * k * t / count)
    return torch.cat([rows[:1] / math.sqrt(2.0), rows[1:]])


def heading(pose):
    across = pose[..., LEFT_HIP, :2] - pose[..., RIGHT_HIP, :2]
    return torch.atan2(-across[..., 0], across[..., 1])


def turn(angle):
    c, s, o = angle.cos(), angle.sin(), torch.zeros_like(angle)
    return torch.stack([c, -s, o, s, c, o, o, o, o + 1], -1).view(*angle.shape, 3, 3)


class Scaling:
    def __init__(self, rows):
        self.mean, self.spread = rows.mean(0), rows.std(0).clamp_min(1e-4)

    def __call__(self, values):
        return ((values - self.mean) / self.spread).clamp(-5, 5)


def rate(done):
    """Share of the largest: up by a cosine over the first 30 %, then down."""
    floor, phase = (0.04, 1 - done / 0.3) if done < 0.3 else (1e-4, (done - 0.3) / 0.7)
    return floor + (1 - floor) * 0.5 * (1 + math.cos(math.pi * phase))


class Layer(nn.Module):
    def __init__(self, width, inner, heads, head):
        super().__init__()
        self.heads, self.head = heads, head
        self.query, self.key, self.value = (nn.Linear(width, heads * head) for _ in range(3))
        self.join, self.drop = nn.Linear(heads * head, width), nn.Dropout(0.1)
        self.dense = nn.Sequential(nn.Linear(width, inner), nn.ReLU(), nn.Linear(inner, width), nn.Dropout(0.1))
        self.after, self.last = nn.LayerNorm(width), nn.LayerNorm(width)

    def forward(self, x, to):
        q, k, v = (layer(of).unflatten(-1, (self.heads, self.head)).transpose(1, 2)
                   for layer, of in ((self.query, x), (self.key, to), (self.value, to)))
        shares = torch.softmax(q @ k.transpose(2, 3) / math.sqrt(self.head), -1)
        x = self.after(x + self.drop(self.join((self.drop(shares) @ v).transpose(1, 2).flatten(2))))
        return self.last(x + self.dense(x))


class Mrt(nn.Module):
    def __init__(self, size, motions):
        super().__init__()
        width, inner, layers, heads, head = SIZES[size]
        self.local, self.everybody = (nn.ModuleList(Layer(width, inner, heads, head) for _ in range(layers)) for _ in range(2))
        self.decoder = nn.ModuleList(Layer(width, inner, heads, head) for _ in range(layers))
        self.local_token, self.global_token = nn.Linear(66, width), nn.Linear(66, width)
        self.place, self.query = nn.Linear(5, width), nn.Linear(132, width)
        self.coefficients = nn.Parameter(0.1 * torch.randn(GIVEN - 1, width))
        self.output = nn.Linear(width, 66 * GIVEN)
        nn.init.zeros_(self.output.weight)
        nn.init.zeros_(self.output.bias)  # starts with the mean motion
        self.to_steps = cosines(GIVEN).T
        windows = [m[:, s:s + 2 * GIVEN] for m in motions for s in range(0, m.shape[1] - 2 * GIVEN + 1, 4)]
        seen = [self.view(w[n:n + 1, :GIVEN].unsqueeze(0)) for w in windows for n in range(len(w))]
        self.of_tokens = Scaling(torch.cat([tokens.view(1, GIVEN - 1, 66) for tokens, _, _, _ in seen]))
        self.of_query = Scaling(torch.cat([query.view(1, 132) for _, _, query, _ in seen]))
        steps = torch.cat([(w[:, GIVEN - 1:].diff(dim=1) @ turn(-heading(w[:, GIVEN - 1])).transpose(1, 2).unsqueeze(1)).flatten(2)
                           for w in windows])
        self.of_output = Scaling(torch.einsum("kt,btr->bkr", cosines(GIVEN), steps))

    @staticmethod
    def view(given):
        """Of [group, person, frame, joint, 3], seen by everybody: tokens, places, queries and the turns to their headings."""
        last, steps = given[:, :, -1], given.diff(dim=2)
        facing = heading(last)
        to_own = turn(-facing)
        coefficients = torch.einsum("kt,bptjc->bpkjc", cosines(GIVEN - 1), steps)
        tokens = torch.einsum("bnij,bpkuj->bnpkui", to_own, coefficients).flatten(-2)
        hip = last[:, :, HIP]
        away = torch.einsum("bnij,bnpj->bnpi", to_own, hip.unsqueeze(1) - hip.unsqueeze(2))
        other = facing.unsqueeze(1) - facing.unsqueeze(2)
        near = torch.exp(-away[..., :2].square().sum(-1))
        places = torch.stack([away[..., 0], away[..., 1], near, other.sin(), other.cos()], -1)
        pose = torch.einsum("bnij,bnuj->bnui", to_own, last - hip.unsqueeze(2))
        pose[..., HIP, 2] = hip[..., 2]
        step = torch.einsum("bnij,bnuj->bnui", to_own, steps[:, :, -1])
        return tokens, places, torch.cat([pose.flatten(-2), step.flatten(-2)], -1), to_own

    def forward(self, given, noise=0.0):
        """The next 20 frames of [group, person, 20, joint, 3]."""
        tokens, places, query, to_own = self.view(given)
        groups, people = tokens.shape[:2]
        tokens, query = self.of_tokens(tokens), self.of_query(query)
        own = tokens[:, torch.arange(people), torch.arange(people)]
        own, tokens, query = (x + noise * torch.randn_like(x) if noise else x for x in (own, tokens, query))
        local = (self.local_token(own) + self.coefficients).flatten(0, 1)
        for layer in self.local:
            local = layer(local, local)
        seen = (self.global_token(tokens) + self.coefficients + self.place(places).unsqueeze(3)).flatten(2, 3).flatten(0, 1)
        for layer in self.everybody:
            seen = layer(seen, seen)
        both, asked = torch.cat([local, seen], 1), self.query(query).flatten(0, 1).unsqueeze(1)
        for layer in self.decoder:
            asked = layer(asked, both)
        out = self.output(asked).view(groups, people, GIVEN, 66) * self.of_output.spread + self.of_output.mean
        ways = (self.to_steps @ out).cumsum(2).unflatten(-1, (22, 3))
        return given[:, :, -1:] + ways @ to_own.unsqueeze(2)

    def go_on(self, motions, given, frames):
        motions = motions[:, :given].unsqueeze(0)
        while motions.shape[2] < frames:
            motions = torch.cat([motions, self(motions[:, :, -GIVEN:])], 2)
        return motions[0, :, :frames]


def train_mrt(motions, held, size="published" if PUBLISHED else "small", epochs=40):
    """The network of the epoch that forecasts what is held best, its error there (m) and the seconds of an epoch."""
    torch.manual_seed(1)
    learnt = [m for of in motions if of.shape[1] >= 2 * GIVEN for m in (of, mirrored(of))]
    net, epochs = Mrt(size, learnt), max(1, round(epochs * EFFORT))
    windows = [(g, last) for g, m in enumerate(learnt) for last in range(GIVEN - 1, m.shape[1] - GIVEN)]
    optimizer = torch.optim.AdamW(net.parameters(), lr=1e-3, weight_decay=1e-2)
    best, kept, since, begin = math.inf, None, 0, time.process_time()
    for epoch in range(epochs):
        net.train()
        drawn = [windows[i] for i in torch.randperm(len(windows))[:512]]
        said = torch.randint(3, (len(drawn),)).tolist()  # how often it has gone on by itself before
        alike = {}
        for (g, last), steps in zip(drawn, said):
            steps = min(steps, (last + 1 - GIVEN) // GIVEN)
            alike.setdefault((len(learnt[g]), steps), []).append((g, last))
        batches = [(steps, of[i:i + 8]) for (_, steps), of in alike.items() for i in range(0, len(of), 8)]
        for b in torch.randperm(len(batches)).tolist():
            steps, batch = batches[b]
            for group in optimizer.param_groups:
                group["lr"] = 1e-3 * rate((epoch + b / len(batches)) / epochs)
            given = torch.stack([learnt[g][:, last + 1 - GIVEN * (steps + 1):last + 1] for g, last in batch])[:, :, :GIVEN]
            with torch.no_grad():
                net.eval()
                for _ in range(steps):
                    given = net(given)
                net.train()
            truth = torch.stack([learnt[g][:, last + 1:last + 1 + GIVEN] for g, last in batch])
            weights = torch.tensor([1.0 / learnt[g].shape[1] for g, _ in batch])
            misses = (net(given, noise=0.1) - truth).norm(dim=-1).mean((1, 2, 3))
            loss = (misses * weights).sum() / weights.sum()
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
        error = statistics.mean((after(net, m, GIVEN)[:, GIVEN:] - m[:, GIVEN:]).norm(dim=-1).mean().item() for m in held)
        since += 1
        if error < best:
            best, since = error, 0
            kept = {k: v.clone() for k, v in net.state_dict().items()}
        if since >= 15:
            break
    net.load_state_dict(kept)
    return net, best, (time.process_time() - begin) / (epoch + 1)


class Simlpe(nn.Module):
    def __init__(self, poses):
        super().__init__()
        self.scale, self.transform = Scaling(poses), cosines(SIMLPE_GIVEN)
        self.input, self.output = nn.Linear(66, 66), nn.Linear(66, 66)
        self.mixes = nn.ModuleList(nn.Linear(SIMLPE_GIVEN, SIMLPE_GIVEN) for _ in range(48 if PUBLISHED else 24))
        self.norms = nn.ModuleList(nn.LayerNorm(66) for _ in self.mixes)
        for layer in (self.output, *self.mixes):
            nn.init.xavier_uniform_(layer.weight, 1e-2)  # the first forecast stands nearly still
            nn.init.zeros_(layer.bias)

    def forward(self, past):
        """As many frames again of [person, frame, coordinate]."""
        state = self.input(self.transform @ ((past - self.scale.mean) / self.scale.spread))
        for mix, norm in zip(self.mixes, self.norms):
            state = state + norm(mix(state.transpose(1, 2)).transpose(1, 2))
        return past[:, -1:] + self.scale.spread * (self.transform.T @ self.output(state))

    def go_on(self, motions, given, frames):
        origin = motions[:, :1, HIP] * torch.tensor([1.0, 1.0, 0.0])
        people = (motions[:, :given] - origin.unsqueeze(2)).flatten(2)
        while people.shape[1] < frames:
            people = torch.cat([people, self(people[:, -SIMLPE_GIVEN:])], 1)
        return people[:, :frames].unflatten(2, (22, 3)) + origin.unsqueeze(2)


def train_simlpe(motions):
    torch.manual_seed(1)
    people = [(m - m[:, :1, HIP:HIP + 1] * torch.tensor([1.0, 1.0, 0.0])).flatten(2)
              for of in motions for m in (of, mirrored(of))]
    windows = torch.cat([m.unfold(1, 2 * SIMLPE_GIVEN, 1).flatten(0, 1).transpose(1, 2) for m in people])
    net, steps = Simlpe(windows.flatten(0, 1)), max(1, round((35000 if PUBLISHED else 1500) * EFFORT))
    optimizer = torch.optim.AdamW(net.parameters(), lr=1e-3, weight_decay=1e-4)
    for step in range(steps):
        for group in optimizer.param_groups:
            up = min(100, max(1, steps // 2))
            group["lr"] = 1e-3 * ((step + 1) / up if step < up else 0.5 * (1 + math.cos(math.pi * (step - up) / max(1, steps - up))))
        drawn = windows[torch.randint(len(windows), (256 if PUBLISHED else 64,))]
        truth, made = (x.unflatten(2, (22, 3)) for x in (drawn[:, SIMLPE_GIVEN:], net(drawn[:, :SIMLPE_GIVEN])))
        loss = (made - truth).norm(dim=-1).mean() + (made.diff(dim=1) - truth.diff(dim=1)).norm(dim=-1).mean()
        optimizer.zero_grad()
        (1000 * loss).backward()
        nn.utils.clip_grad_norm_(net.parameters(), 1.0)
        optimizer.step()
    return net


def after(net, motions, given):
    """The first frames as they are, then the forecast."""
    net.eval()
    with torch.no_grad():
        return net.go_on(motions, given, motions.shape[1])


def scores(recorded, predicted, first):
    """The metrics of one recording, over the frames from `first` on."""
    error = predicted[:, first:] - recorded[:, first:]
    bones = [(m - m[:, :, PARENTS]).norm(dim=-1) for m in (predicted[:, first:], recorded[:, first:])]
    feet = []
    for motion in predicted:
        ankles = motion[:, list(ANKLES)]
        height = (ankles[..., 2] - ankles[0, :, 2])[max(1, first):]
        way = ankles[..., :2].diff(dim=0).norm(dim=-1)[max(1, first) - 1:]
        low = height < 0.025
        if low.any():
            feet.append(100 * (way * (2 - torch.exp2(height.clamp_min(0) / 0.025)))[low].mean().item())
    return {"MPJPE_m": error.norm(dim=-1).mean().item(), "hipADE_m": error[:, :, HIP].norm(dim=-1).mean().item(),
            "hipFDE_m": error[:, -1, HIP].norm(dim=-1).mean().item(),
            "MBLE_m": (bones[0] - bones[1]).abs()[:, :, 1:].mean().item(), "FSE_cm": statistics.mean(feet or [0.0])}


def mean_of(found):
    mean = {key: statistics.mean(f[key] for f in found) for key in found[0]}
    for key in ("MPJPE_m", "hipADE_m", "hipFDE_m"):
        mean[key.replace("_m", "_standard_error_m")] = statistics.stdev(f[key] for f in found) / math.sqrt(len(found))
    return {"mean": mean}


def crossvalidated():
    """Of MRT, then siMLPe: errors after the given frames, of all frames, and the seconds of each fold."""
    recordings = load()
    rows = [([], [], []), ([], [], [])]
    for held in folds(recordings, FOLDS):
        learnt = [r for i, r in enumerate(recordings) if i not in held]
        early = folds(learnt, 7)[0]  # stop the training of MRT early
        begin = time.process_time()
        mrt = train_mrt([m for i, (_, m) in enumerate(learnt) if i not in early], [learnt[i][1] for i in early])[0]
        between = time.process_time()
        simlpe = train_simlpe([m for _, m in learnt])
        for (later, whole, seconds), net, given, took in [
                (rows[0], mrt, GIVEN, between - begin), (rows[1], simlpe, SIMLPE_GIVEN, time.process_time() - between)]:
            seconds.append(took)
            for i in held:
                made = after(net, recordings[i][1], given)
                later.append(scores(recordings[i][1], made, given))
                whole.append(scores(recordings[i][1], made, 1))
    return rows


def at_seconds(left_out, effort=0.1):
    """MRT's total, root and pose errors up to 1, 2 and 3 s of the recordings that it has not seen; None: none lasts."""
    recordings = load()
    learnt = [r for r in recordings if r[0]["id"] not in left_out]
    early = folds(learnt, 7)[0]
    net = train_mrt([m for i, (_, m) in enumerate(learnt) if i not in early], [learnt[i][1] for i in early],
                    epochs=40 * effort)[0]
    total, root, pose = ({1: [], 2: [], 3: []} for _ in range(3))
    for entry, motions in recordings:
        error = (after(net, motions, GIVEN) - motions) if entry["id"] in left_out else motions[:, :0]
        for second in root:
            until = error[:, GIVEN:GIVEN + 60 * second]
            if until.shape[1] < 60 * second:
                continue
            for of, part in ((total, until), (root, until[:, :, HIP]), (pose, until - until[:, :, HIP:HIP + 1])):
                of[second].append(part.norm(dim=-1).mean().item())
    return [statistics.mean(of[s]) if of[s] else None for of in (total, root, pose) for s in of]


HEADER = ["held out, 5 folds", "given", "frames that count", "MPJPE, m", "hipADE, m", "hipFDE, m", "MBLE, m",
          "FSE, cm a frame", "training, s a fold (median)"]


def cells(name, given, frames, summary, seconds=None):
    m = summary["mean"]
    return [name, given, frames, with_error(m["MPJPE_m"], m["MPJPE_standard_error_m"]),
            with_error(m["hipADE_m"], m["hipADE_standard_error_m"]),
            with_error(m["hipFDE_m"], m["hipFDE_standard_error_m"]), f"{m['MBLE_m']:.4f}", f"{m['FSE_cm']:.2f}",
            seconds and number(statistics.median(seconds), 2)]


def chain(model, *flags):
    return studies.on_recordings("pushid-train-restoration", "groups", f"--model={model}", f"--crossvalidate={FOLDS}",
                                 "--sees=neighbours", "--quiet", *flags).json


def groups():
    model = studies.fit("groups", "--preset=group").path
    first, seen = chain(model), chain(model, "--observed=20")
    physics = "physics and `window --sees=neighbours`"
    rows = [cells("the last pose held", "20 frames", "after those", seen["baselines"]["static"]),
            cells("constant velocity", "20 frames", "after those", seen["baselines"]["constant_velocity"])]
    mrt, simlpe = crossvalidated()
    for title, given, (later, whole, seconds) in [("siMLPe", "12 frames", simlpe), ("MRT", "20 frames", mrt)]:
        rows.append(cells(title, given, "after those", mean_of(later), seconds))
        rows.append(cells(title, given, "all", mean_of(whole)))
    rows.append(cells(physics, "1 frame, the push", "all", first, first["run"]["training_seconds"]))
    rows.append(cells(physics, "20 frames, the push", "after those", seen))  # trained as before
    rows.append(cells(physics, "20 frames, the push", "all", seen["baselines"]["restoration_all_frames"]))
    return studies.table(HEADER, rows)


def sizes():
    recordings = load()
    held = folds(recordings, 7)[0]
    rows = []
    for size in SIZES:
        net, error, seconds = train_mrt([m for i, (_, m) in enumerate(recordings) if i not in held],
                                        [recordings[i][1] for i in held], size, epochs=2 / EFFORT)
        weights = sum(p.numel() for p in net.parameters())
        rows.append([size, f"{weights / 1e6:.2f} million", number(seconds, 2), number(error)])
    return studies.table(["MRT", "weights", "s an epoch", "held-out distance of joints after 2 epochs, m"], rows)


if __name__ == "__main__":
    torch.set_num_threads(1)
    studies.main(__file__, {"groups": groups, "sizes": sizes})
