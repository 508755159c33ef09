"""python3 -m pushid.ldp [--split=train] CHECKOUT OUT: the recordings of LDP (Yue et al., CVPR 2024) with a manifest.

CHECKOUT is a clone of github.com/realcrane/Human-Motion-Prediction-under-Unexpected-Perturbation. Motion is copied as
it is, pushes become CSV files, and the label `split` of every recording is the release's own: train or eval. Needs
PyYAML, and neither NumPy nor the compiled module. In the release

    single-person/data/raw_data/indiv_data/X09/*.bvh          sorted by name: number 0, 1, ... of this person
    single-person/data/raw_data/indiv_forces/                 forces.pkl, duration.pkl: {"X09": [of number 0, ...]}
    multi-people/data/raw_data/group_data/row_1/3/0_X-07.bvh  number 3 of row_1, its people from the pushed one on
    multi-people/data/raw_data/group_forces/row_1/            pushes.pkl, duration.pkl: [of number 0, ...]
    multi-people/data/raw_data/group_mass_id_set.pkl          {"row_1": [["row_1_07", ...] of number 0, ...]}

with train_list.yaml and eval_list.yaml in both data folders.
"""
import argparse
import json
import os
import re
import shutil
import sys
import tempfile

from ._tensor_files import Problem, load

SOURCE = "github.com/realcrane/Human-Motion-Prediction-under-Unexpected-Perturbation"
UNLISTED = "unlisted"  # the split of recordings in neither list
COMPLETE = "is this a complete checkout of the release?"
SINGLE = os.path.join("single-person", "data", "raw_data")
GROUPS = os.path.join("multi-people", "data", "raw_data")

# kg, as the release's code has them. Row_2 and wait_2 give the numbers 10, 11 and 18 to different people; that both 10
# have 68 kg is doubtful, because their thighs differ by 6 cm.
_FIRST = {"05": 67.0, "07": 89.0, "08": 120.0, "09": 63.0}
MASSES = {"single": _FIRST, "row_1": _FIRST, "group_1": _FIRST,
          "row_2": {"09": 63.0, "10": 68.0, "11": 105.3, "18": 81.0, "19": 78.0},
          "wait_2": {"10": 68.0, "11": 85.8, "16": 80.2, "18": 104.0, "19": 78.0}}

# The release's loader replaces these durations (frames): published, corrected.
DURATIONS = {"row_1_06": (8, 15), "row_2_03": (11, 20)}

# Strengths. Single people have them in their file names. Those of groups are not published: these follow from the order
# of the recordings, the distances between people and the peak speeds (a dot: not told), and the paper's Table 5 has all
# of wait_2 as medium.
STRENGTHS = {"w": "weak", "m": "medium", "s": "strong", ".": "unknown"}
GROUP_STRENGTHS = {"row_1": "w.mmss.wmmwwmms.", "row_2": "www.mm.ssww.ww.m.mmmms.sw", "group_1": "ww.m.sww.mss",
                   "wait_2": "mmmmmmmmmm"}

HEAD = {
    "schema": "pushid-manifest/1",
    "name": "FZJ Push, as released with LDP (CVPR 2024)",
    "source": SOURCE,
    "units": {"bvh_length": "mm", "bvh_angle": "deg", "force": "N", "torque": "N*m", "mass": "kg"},
    "axes": "z up, x forward (direction of the push), y left",
    "frame_convention": "row t of a push drives the step from frame t to t + 1",
}


def read_list(path):
    """{"row_1": [0, 2, ...], ...}, from the lists that the release has as YAML."""
    try:
        import yaml
    except ImportError:
        raise Problem(f"{path} is YAML, which takes Debian's python3-yaml (PyYAML) to read; install it") from None
    try:
        with open(path, "rb") as file:
            lists = yaml.safe_load(file) or {}
    except OSError as error:
        raise Problem(f"{path}: {error.strerror}; {COMPLETE}") from None
    except yaml.YAMLError as error:
        raise Problem(f"{path}: {' '.join(str(error).split())}; take the file from the release") from None
    check(isinstance(lists, dict), path, "no names with a list of numbers each, as in 'row_1: [0, 3]'")
    for name, numbers in lists.items():
        lists[name] = numbers = numbers or []
        check(isinstance(numbers, list) and all(type(number) is int for number in numbers), path,
              f"{name!r} has no list of whole numbers, but {numbers!r}")
        check(len(set(numbers)) == len(numbers), path, f"{name!r} has a number twice")
    return lists


def folders(path, pattern, like):
    """The names in a folder that match, sorted: numbers by value."""
    try:
        names = [name for name in os.listdir(path) if re.fullmatch(pattern, name)]
    except OSError as error:
        raise Problem(f"{path}: {error.strerror}; {COMPLETE}") from None
    if not names:
        raise Problem(f"{path}: none of its names is like {like}; {COMPLETE}")
    return sorted(names, key=lambda name: (int(name) if name.isdigit() else 0, name))


def read_splits(folder, names):
    """{("row_1", 0): "train", ...} of the recordings that names counts: {"row_1": 16, ...}."""
    splits = {(name, number): UNLISTED for name, count in names.items() for number in range(count)}
    for split in ("train", "eval"):
        path = os.path.join(folder, f"{split}_list.yaml")
        for name, numbers in read_list(path).items():
            for number in numbers:
                if (name, number) not in splits:
                    raise Problem(f"{path}: {name} number {number} has no recording in {folder}; {COMPLETE}")
                if splits[name, number] != UNLISTED:
                    raise Problem(f"{path}: {name} number {number} is in the train list as well; a recording has one "
                                  "split")
                splits[name, number] = split
    return splits


def check(good, path, what):
    if not good:
        raise Problem(f"{path}: {what}; take the file from the release")


def is_list(value, kind, count):
    return isinstance(value, list) and len(value) == count and all(type(item) is kind for item in value)


def push_rows(forces, durations, files, name, count):
    """The rows of each push, with its published and corrected duration, of the recordings 0 to count - 1 of a name."""
    check(is_list(forces, list, count), files[0], f"no list of {count} pushes of {name}, one per recording")
    check(is_list(durations, int, count), files[1], f"no list of {count} durations of {name}, one per recording")
    pushes = []
    for number, (rows, published) in enumerate(zip(forces, durations)):
        old, new = DURATIONS.get(f"{name}_{number:02d}", (0, 0))
        duration = new if published == old else published
        check(all(is_list(row, float, 4) for row in rows), files[0],
              f"the push of {name} number {number} has rows of other than 4 numbers (fx, fy, ftheta, fphi)")
        check(0 < duration <= len(rows), files[1],
              f"{name} number {number} has a duration of {duration} frames, and its push {len(rows)} rows")
        pushes.append((rows[:duration], published, duration))
    return pushes


def entry(name, number, setting, people, motion, push):
    """A recording of the manifest, and what to write for it: {target: source or rows of a push}."""
    identity = f"{setting}_{name}_{number:02d}" if setting == "single" else f"{setting}_{number:02d}"
    rows, published, duration = push
    targets = [("bvh/single/" + name if setting == "single" else f"bvh/{setting}/{number}") + "/" +
               os.path.basename(path) for path in motion]
    heads = [bvh_head(path) for path in motion]
    check(len(set(heads)) == 1, motion[-1], "another number of frames or frame rate than the first person's file")
    for person in people:
        if person[2:] not in MASSES[setting]:
            raise Problem(f"{motion[0]}: no mass is known for {person} of {setting}; add it to MASSES in {__file__}")
    recording = {
        "id": identity, "setting": setting, "index": number,
        "subjects": [{"order": order, "id": person, "mass_kg": MASSES[setting][person[2:]]}
                     for order, person in enumerate(people)],
        "pushed_person": 0, "bvh": targets, "push_csv": f"push/{identity}.csv", "push_frames": duration,
        "push_frames_published": published, "frames": heads[0][0], "fps": heads[0][1],
        "push_kind": "net" if setting == "single" else "net_without_friction"}
    return recording, {**dict(zip(targets, motion)), recording["push_csv"]: rows}


def bvh_head(path):
    """Frames, and frames per second as a whole number: the release rounds frame times."""
    with open(path, encoding="latin-1") as file:
        head = file.read(20000)
    frames = re.search(r"^Frames:\s*(\d+)\s*$", head, re.M)
    time = re.search(r"^Frame Time:\s*(\d*\.?\d+(?:[eE][-+]?\d+)?)\s*$", head, re.M)
    check(frames and time and float(time[1]) > 0, path, "no BVH file with 'Frames:' and 'Frame Time:'")
    return int(frames[1]), round(1 / float(time[1]))


def single_people(checkout):
    data, forces = (os.path.join(checkout, SINGLE, folder) for folder in ("indiv_data", "indiv_forces"))
    files = [os.path.join(forces, "forces.pkl"), os.path.join(forces, "duration.pkl")]
    loaded = [load(path) for path in files]
    for path, value in zip(files, loaded):
        check(isinstance(value, dict), path, "no dictionary by person")
    motion = {name: folders(os.path.join(data, name), r".*\.bvh", "NAME.bvh") for name in folders(data, r"X\d+", "X09")}
    splits = read_splits(data, {name: len(takes) for name, takes in motion.items()})
    for name, takes in motion.items():
        pushes = push_rows(loaded[0].get(name), loaded[1].get(name), files, name, len(takes))
        for number, take in enumerate(takes):
            path = os.path.join(data, name, take)
            parts = re.fullmatch(r".*_([a-z])_\d+_([wms])_(X-\d+)\.bvh", take)
            check(parts, path, "not named as Tue_03_p_01_w_X-09.bvh")
            recording, content = entry(name, number, "single", [parts[3]], [path], pushes[number])
            yield {**recording, "magnitude": STRENGTHS[parts[2]], "magnitude_source": "file name",
                   "condition_code": parts[1], "condition": parts[1], "split": splits[name, number]}, content


def groups(checkout):
    raw = os.path.join(checkout, GROUPS)
    data, masses = os.path.join(raw, "group_data"), os.path.join(raw, "group_mass_id_set.pkl")
    people_of = load(masses)
    numbers = {name: folders(os.path.join(data, name), r"\d+", "0")
               for name in folders(data, "|".join(GROUP_STRENGTHS), "row_1")}
    for name, given in numbers.items():
        check(given == [str(n) for n in range(len(given))], os.path.join(data, name), "folders not numbered from 0 on")
    splits = read_splits(data, {name: len(given) for name, given in numbers.items()})
    for name, given in numbers.items():
        check(isinstance(people_of, dict) and is_list(people_of.get(name), list, len(given)), masses,
              f"no list of {len(given)} lists of people of {name}")
        forces = os.path.join(raw, "group_forces", name)
        files = [os.path.join(forces, "pushes.pkl"), os.path.join(forces, "duration.pkl")]
        pushes = push_rows(load(files[0]), load(files[1]), files, name, len(given))
        for number, label in enumerate(GROUP_STRENGTHS[name][:len(given)].ljust(len(given), ".")):
            folder = os.path.join(data, name, str(number))
            takes = folders(folder, r"\d+_X-\d+\.bvh", "0_X-07.bvh")
            people = [take[take.index("_") + 1:-4] for take in takes]
            if people_of[name][number] != [f"{name}_{person[2:]}" for person in people]:
                print(f"warning: {masses}: {name} number {number} has other people than the files in {folder}; masses "
                      "are those of the files' people", file=sys.stderr)
            recording, content = entry(name, number, name, people, [os.path.join(folder, take) for take in takes],
                                       pushes[number])
            yield {**recording, "magnitude": STRENGTHS[label], "magnitude_source": "not published; see pushid.ldp",
                   "split": splits[name, number]}, content


def write(out, recordings):
    """Writes the folder as a whole or not at all."""
    parent = os.path.dirname(os.path.abspath(out))
    os.makedirs(parent, exist_ok=True)
    made = tempfile.mkdtemp(prefix=f".{os.path.basename(out)}-", dir=parent)
    try:
        for recording, content in recordings:
            for target, source in content.items():
                path = os.path.join(made, target)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                if isinstance(source, str):
                    shutil.copyfile(source, path)
                    continue
                with open(path, "w", encoding="utf-8") as file:
                    file.write("frame,fx,fy,ftheta,fphi\n")
                    file.writelines(f"{n},{','.join(map(repr, row))}\n" for n, row in enumerate(source))
        with open(os.path.join(made, "manifest.json"), "w", encoding="utf-8") as file:
            json.dump({**HEAD, "recordings": [recording for recording, _ in recordings]}, file, indent=1)
            file.write("\n")
        os.chmod(made, 0o755)
        os.rename(made, out)
    except BaseException:
        shutil.rmtree(made, ignore_errors=True)
        raise


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="python3 -m pushid.ldp", description=__doc__.split("\n\n")[0] + f"""
        CHECKOUT: a clone of {SOURCE}. OUT: the folder to write; it must not exist.""")
    parser.error = lambda text: parser.exit(1, f"{parser.prog}: error: {text}; see --help\n")
    parser.add_argument("--split", choices=("train", "eval"), help="only the recordings of this list (default: all)")
    parser.add_argument("checkout", metavar="CHECKOUT")
    parser.add_argument("out", metavar="OUT")
    given = parser.parse_args(arguments)
    out = given.out.rstrip("/")
    try:
        if os.path.lexists(out):
            raise Problem(f"{out} exists; name another folder, or remove it")
        recordings = [one for one in (*single_people(given.checkout), *groups(given.checkout))
                      if given.split in (None, one[0]["split"])]
        write(out, recordings)
    except (Problem, OSError) as error:
        parser.exit(1, f"{parser.prog}: error: {error}\n")
    splits = [recording["split"] for recording, _ in recordings]
    counts = [f"{split}: {splits.count(split)}" for split in ("train", "eval", UNLISTED) if split in splits]
    print(f"{len(recordings)} recordings ({', '.join(counts)}), written to {os.path.join(out, 'manifest.json')}")


if __name__ == "__main__":
    main()
