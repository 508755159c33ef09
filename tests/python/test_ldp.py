"""python3 -m pushid.ldp on checkouts made here, opcode by opcode, and on the layout of the release where it is."""
import json
import os
import pickle
import shutil
import struct
import subprocess
import sys
import warnings

import pytest

from pushid import _tensor_files, ldp

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
RECORDINGS = os.path.abspath(os.environ.get("PUSHID_RECORDINGS", os.path.join(SOURCE, "../shared/fzj_push")))
LAYOUT = os.path.join(os.path.dirname(RECORDINGS), "ldp_layout")
SINGLE = "single-person/data/raw_data/"
GROUPS = "multi-people/data/raw_data/"
FORCES, PUSHES = SINGLE + "indiv_forces/forces.pkl", GROUPS + "group_forces/row_1/pushes.pkl"


def plain(value):
    """The opcodes that put a plain value on the stack."""
    return pickle.dumps(value, 2)[2:-1]


def storage(numbers, name=b"torch\nDoubleStorage", letter="d", count=None):
    saved = [pickle.dumps(value, 2) for value in (0x1950A86A20F9469CFC6C, 1001, {"little_endian": True})]
    saved.append(b"\x80\x02(" + plain("storage") + b"c" + name + b"\n" + plain("7") + plain("cpu") +
                 plain(len(numbers) if count is None else count) + b"NtQ.")
    return b"".join(saved) + pickle.dumps(["7"], 2) + struct.pack(f"<q{len(numbers)}{letter}", len(numbers), *numbers)


def tensor(data, size, stride, offset=0):
    return (b"ctorch._utils\n_rebuild_tensor_v2\n(ctorch.storage\n_load_from_bytes\n" +
            b"B" + struct.pack("<I", len(data)) + data + b"\x85R" + plain(offset) + plain(size) + plain(stride) +
            b"\x89ccollections\nOrderedDict\n)RtR")


def push(rows):
    return tensor(storage([value for row in rows for value in row]), (len(rows), 4), (4, 1))


def listed(items):
    return b"](" + b"".join(items) + b"e"


def pickled(opcodes):
    return b"\x80\x02" + opcodes + b"."


def rows(seed, count):
    return [[seed + t + i / 3 for i in range(4)] for t in range(count)]


def write(path, content):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)


def lists(folder, train, held_out):
    for name, given in [("train", train), ("eval", held_out)]:
        text = "".join(f"{key}:\n  {numbers}\n\n\n" for key, numbers in given.items())  # the release's style
        write(folder / f"{name}_list.yaml", text.encode())


@pytest.fixture
def checkout(tmp_path):
    """Two takes of X09, seven of row_1 and four of row_2."""
    root = tmp_path / "checkout"
    motion = b"HIERARCHY\nMOTION\nFrames: 40\nFrame Time: 0.016667\n"
    for take in ["Tue_07_m_01_s", "Tue_03_p_02_w"]:
        write(root / SINGLE / "indiv_data" / "X09" / f"{take}_X-09.bvh", motion + take.encode())
    lists(root / SINGLE / "indiv_data", {"X09": [1]}, {"X09": [0]})
    write(root / FORCES, pickled(b"}" + plain("X09") + listed([push(rows(10, 3)), push(rows(20, 9))]) + b"s"))
    write(root / SINGLE / "indiv_forces/duration.pkl", pickle.dumps({"X09": [3, 9]}))
    people = {"row_1": ["07", "08", "05", "09"], "row_2": ["18", "11", "19", "09", "10"]}
    ids = {}
    for setting, count, durations in [("row_1", 7, [5, 5, 5, 5, 5, 5, 8]), ("row_2", 4, [6, 6, 6, 11])]:
        for n in range(count):
            for order, person in enumerate(people[setting]):
                write(root / GROUPS / "group_data" / setting / str(n) / f"{order}_X-{person}.bvh", motion)
        ids[setting] = [[f"{setting}_{person}" for person in people[setting]]] * count
        forces = root / GROUPS / "group_forces" / setting
        write(forces / "pushes.pkl", pickled(listed([push(rows(100 * n, 39)) for n in range(count)])))
        write(forces / "duration.pkl", pickle.dumps(durations))
    write(root / GROUPS / "group_mass_id_set.pkl", pickle.dumps(ids))
    lists(root / GROUPS / "group_data", {"row_1": [0, 1, 2, 3, 4, 5], "row_2": [0, 1, 2]}, {"row_1": [6], "row_2": [3]})
    return root


def refused(checkout, capsys, *words):
    """Nothing is written, the code is 1 and the error has these words."""
    out = checkout.parent / "refused"
    with pytest.raises(SystemExit) as end:
        ldp.main([str(checkout), str(out)])
    message = capsys.readouterr().err
    assert end.value.code == 1
    assert sorted(os.listdir(checkout.parent)) == ["checkout"]
    for word in words:
        assert word in message, message


def imported(checkout):
    out = checkout.parent / "out"
    ldp.main([str(checkout), str(out)])
    manifest = json.loads((out / "manifest.json").read_text())
    return out, {recording["id"]: recording for recording in manifest["recordings"]}


def test_single_people_by_their_sorted_files(checkout):
    out, recordings = imported(checkout)
    assert len(recordings) == 13
    weak, strong = recordings["single_X09_00"], recordings["single_X09_01"]
    assert weak["bvh"] == ["bvh/single/X09/Tue_03_p_02_w_X-09.bvh"]
    assert (out / weak["bvh"][0]).read_bytes().endswith(b"Tue_03_p_02_w")
    assert (weak["magnitude"], weak["condition"], weak["split"], weak["push_kind"]) == ("weak", "p", "eval", "net")
    assert (strong["magnitude"], strong["condition"], strong["split"]) == ("strong", "m", "train")
    assert strong["subjects"] == [{"order": 0, "id": "X-09", "mass_kg": 63.0}]
    assert (strong["frames"], strong["fps"], strong["push_frames"]) == (40, 60, 9)
    lines = (out / weak["push_csv"]).read_text().splitlines()
    assert lines[0] == "frame,fx,fy,ftheta,fphi" and len(lines) == 4
    assert [float(cell) for cell in lines[2].split(",")] == [1, *rows(10, 3)[1]]


def test_groups_with_the_loaders_durations(checkout):
    out, recordings = imported(checkout)
    assert [(s["id"], s["mass_kg"]) for s in recordings["row_2_00"]["subjects"]] == [
        ("X-18", 81.0), ("X-11", 105.3), ("X-19", 78.0), ("X-09", 63.0), ("X-10", 68.0)]
    for name, published, duration in [("row_1_05", 5, 5), ("row_1_06", 8, 15), ("row_2_02", 6, 6),
                                      ("row_2_03", 11, 20)]:
        recording = recordings[name]
        assert (recording["push_frames_published"], recording["push_frames"]) == (published, duration)
        assert len((out / recording["push_csv"]).read_text().splitlines()) == 1 + duration
        assert recording["push_kind"] == "net_without_friction" and recording["pushed_person"] == 0
    assert recordings["row_1_06"]["split"] == "eval" and recordings["row_1_05"]["split"] == "train"


def test_tensors_by_offset_stride_and_type(tmp_path):
    path = tmp_path / "tensors.pkl"
    floats = storage([9, 1, 2, 3, 4, 5, 6], b"torch\nFloatStorage", "f")
    path.write_bytes(pickled(listed([tensor(floats, (3, 2), (1, 3), 1), tensor(storage([]), (0, 4), (4, 1))])))
    assert _tensor_files.load(path) == [[[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]], []]


@pytest.mark.parametrize("opcodes, name", [
    (b"cos\nsystem\n(" + plain("touch MARK") + b"tR", "os.system"),
    (plain("builtins") + plain("eval") + b"\x93(" + plain("open('MARK', 'w')") + b"tR", "builtins.eval"),
    (b"(" + plain("touch MARK") + b"ios\nsystem\n", "os.system"),
    (b"ctorch\nload\n", "torch.load"),
    (b"cpushid.ldp\nmain\n", "pushid.ldp.main"),
    (tensor(b"cos\nsystem\n(" + plain("touch MARK") + b"tR.", (1, 4), (4, 1)), "os.system"),
    (tensor(storage([0.0], b"posix\nsystem"), (1, 1), (1, 1)), "posix.system"),
    (tensor(storage([0.0], b"torch.storage\n_load_from_bytes"), (1, 1), (1, 1)), "torch.storage._load_from_bytes"),
])
def test_code_in_pickles_is_refused(checkout, capsys, monkeypatch, opcodes, name):
    monkeypatch.chdir(checkout)
    for file in (FORCES, PUSHES, GROUPS + "group_mass_id_set.pkl", SINGLE + "indiv_forces/duration.pkl"):
        kept = (checkout / file).read_bytes()
        write(checkout / file, pickled(opcodes))
        refused(checkout, capsys, file, f"asks for {name}", "nothing was run")
        write(checkout / file, kept)
    assert not (checkout / "MARK").exists()


def test_damaged_pickles_name_the_file(checkout, capsys):
    whole = (checkout / FORCES).read_bytes()
    for length in [*range(0, len(whole), 37), len(whole) - 1]:
        write(checkout / FORCES, whole[:length])
        refused(checkout, capsys, FORCES, "take the file from the release")


@pytest.mark.parametrize("opcodes, reason", [
    (tensor(storage([1.0] * 12), (3, 4), (4, 1), 1), "a tensor of size (3, 4) in a storage of 12 numbers"),
    (tensor(storage([1.0]), (10**9, 4), (0, 0)), "in a storage of 1 numbers"),
    (tensor(storage([1.0] * 4, count=5), (1, 4), (4, 1)), "a storage of 5 numbers"),
    (tensor(storage([1.0] * 12), (12,), (1,)), "expected rows and columns"),
    (tensor(storage([float("nan")] * 4), (1, 4), (4, 1)), "not finite"),
    (tensor(storage([1.0] * 9), (3, 3), (3, 1)), "rows of other than 4 numbers"),
    (push(rows(0, 2)), "a duration of 5 frames, and its push 2 rows"),
])
def test_other_shapes_are_told_of(checkout, capsys, opcodes, reason):
    write(checkout / PUSHES, pickled(listed([opcodes] * 7)))
    refused(checkout, capsys, "row_1", reason, "take the file from the release")


@pytest.mark.parametrize("text", ["", "Frames: 40\nFrame Time: 0.0.1\n", "Frames: 40\nFrame Time: 0\n", "Frames: all"])
def test_motion_that_is_none(checkout, capsys, text):
    (checkout / GROUPS / "group_data/row_2/1/3_X-09.bvh").write_text(text)
    refused(checkout, capsys, "row_2/1/3_X-09.bvh", "no BVH file")


def test_people_of_one_recording_have_one_length(checkout, capsys):
    (checkout / GROUPS / "group_data/row_2/1/3_X-09.bvh").write_text("Frames: 39\nFrame Time: 1.6667e-2\n")
    refused(checkout, capsys, "row_2/1", "another number of frames")


def test_missing_files_are_named(checkout, capsys):
    for file in [FORCES, PUSHES, SINGLE + "indiv_data", GROUPS + "group_data/train_list.yaml",
                 GROUPS + "group_mass_id_set.pkl", GROUPS + "group_data/row_1/3", GROUPS + "group_forces/row_2"]:
        (checkout / file).rename(checkout / "aside")
        refused(checkout, capsys, file.rsplit("/", 1)[0], "release")
        (checkout / "aside").rename(checkout / file)
    imported(checkout)


def test_lists_as_the_release_has_them_and_a_number_a_line(tmp_path):
    path = tmp_path / "train_list.yaml"
    path.write_text("X05:\n  [0, 2, 3, 5,\n    6, 7, 9]\n\n\nX09:\n  [1]  # alone\n\nrow_1:\n")
    assert ldp.read_list(path) == {"X05": [0, 2, 3, 5, 6, 7, 9], "X09": [1], "row_1": []}
    path.write_bytes(b"\xef\xbb\xbfX05:\r\n- 0\r\n- 2\r\nX09:\r\n  - 1\r\n")
    assert ldp.read_list(path) == {"X05": [0, 2], "X09": [1]}


@pytest.mark.parametrize("text, words", [
    ("row_1:\n- 0\n- one\n", ["'row_1'", "'one'"]),
    ("row_1: [true]\n", ["'row_1'", "[True]"]),
    ("row_1: 3\n", ["'row_1'", "3"]),
    ("row_1:\n- 0\n- 0\n", ["'row_1' has a number twice"]),
    ("- 0\n", ["no names with a list of numbers each"]),
    ("row_1:\n  [0, 1\n", ["line 2"]),
    ("row_1: [0]\n\x01", ["release"]),
    ("!!python/object/apply:os.system ['touch MARK']\n", ["python/object/apply:os.system"]),
    ("row_1:\n- 7\n", ["row_1 number 7 has no recording"]),
    ("row_1:\n- 6\n", ["eval_list.yaml", "row_1 number 6 is in the train list as well"]),
])
def test_other_lists_are_refused(checkout, capsys, text, words):
    (checkout / GROUPS / "group_data/train_list.yaml").write_text(text)
    refused(checkout, capsys, "_list.yaml", *words)


def test_recordings_in_neither_list_say_so(checkout):
    (checkout / GROUPS / "group_data/train_list.yaml").write_text("# none yet\nrow_1:\n- 0\n")
    assert imported(checkout)[1]["row_1_01"]["split"] == "unlisted"


def test_one_split_alone(checkout):
    out = checkout.parent / "held_out"
    ldp.main(["--split=eval", str(checkout), str(out)])
    assert [r["id"] for r in json.loads((out / "manifest.json").read_text())["recordings"]] == [
        "single_X09_00", "row_1_06", "row_2_03"]
    assert sorted(os.listdir(out / "push")) == ["row_1_06.csv", "row_2_03.csv", "single_X09_00.csv"]


def test_a_folder_that_exists_is_kept(checkout, capsys):
    out, _ = imported(checkout)
    (out / "manifest.json").write_text("mine")
    with pytest.raises(SystemExit) as end:
        ldp.main([str(checkout), str(out) + "/"])
    assert end.value.code == 1 and "exists; name another folder" in capsys.readouterr().err
    assert (out / "manifest.json").read_text() == "mine"


def hidden(tmp_path, *arguments, package="numpy"):
    """Python with the package of the source alone: without the compiled module, without NumPy or another package."""
    shutil.copytree(os.path.join(SOURCE, "apps/python/pushid"), tmp_path / "alone/pushid",
                    ignore=shutil.ignore_patterns("*.so", "__pycache__"))
    (tmp_path / f"alone/{package}.py").write_text("raise ImportError('this package is hidden')\n")
    environment = {**os.environ, "PYTHONPATH": str(tmp_path / "alone"), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run([sys.executable, *arguments], env=environment, text=True, capture_output=True, cwd=tmp_path)


def test_it_runs_without_the_compiled_module(checkout, tmp_path):
    run = hidden(tmp_path, "-m", "pushid.ldp", "checkout", "out")
    assert run.returncode == 0, run.stderr
    assert run.stdout == "13 recordings (train: 10, eval: 3), written to out/manifest.json\n"


def test_without_yaml_the_package_is_named(checkout, tmp_path):
    run = hidden(tmp_path, "-m", "pushid.ldp", "checkout", "out", package="yaml")
    assert run.returncode == 1 and "train_list.yaml is YAML" in run.stderr and "python3-yaml" in run.stderr
    assert not (tmp_path / "out").exists()


def test_everything_else_says_what_it_needs(tmp_path):
    run = hidden(tmp_path, "-c", "import pushid; print(hasattr(pushid, 'fitt')); pushid.fit")
    assert run.stdout == "False\n"
    assert "ImportError: pushid.fit needs the compiled module" in run.stderr and "README" in run.stderr


@pytest.mark.skipif(not (os.path.isdir(LAYOUT) and os.path.isdir(RECORDINGS)), reason=f"{LAYOUT} is not there")
def test_the_release_gives_the_published_recordings(tmp_path):
    out = tmp_path / "out"
    ldp.main([LAYOUT, str(out)])
    published = os.path.join(RECORDINGS, "manifest.json")
    with open(published, encoding="utf-8") as file:
        known = {recording["id"]: recording for recording in json.load(file)["recordings"]}
    both = [r for r in json.loads((out / "manifest.json").read_text())["recordings"] if r["id"] in known]
    assert len(both) == 20 and all(r["split"] == "train" for r in both)
    for recording in both:
        of = known[recording["id"]]
        for key in set(recording) - {"split", "frames", "magnitude_source"}:
            assert recording[key] == of[key], (recording["id"], key)
        pushes = [[[float(cell) for cell in line.split(",")] for line in open(path, encoding="utf-8").readlines()[1:]]
                  for path in (out / recording["push_csv"], os.path.join(RECORDINGS, of["push_csv"]))]
        assert len(pushes[0]) == len(pushes[1]) == recording["push_frames"]
        for row, other in zip(*pushes):  # those have nine digits
            assert row == pytest.approx(other, rel=5e-9, abs=1e-6)
    pushid = pytest.importorskip("pushid")
    pytest.importorskip("pushid._pushid")
    whole = [r["id"] for r in both if r["frames"] == known[r["id"]]["frames"]]  # the layout has some as placeholders
    assert len(whole) == 11
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read = pushid.read(out / "manifest.json", ids=whole)
    for mine, theirs in zip(read, pushid.read(published, ids=whole)):
        assert mine.id == theirs.id and mine.subjects == theirs.subjects and mine.mass == theirs.mass
        for part in ("hip", "left_ankle", "right_ankle"):
            assert abs(getattr(mine, part) - getattr(theirs, part)).max() <= 1e-9
        assert abs(mine.push - theirs.push).max() <= 1e-6
