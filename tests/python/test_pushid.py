"""The Python module as its users call it (pytest, through ctest)."""
import copy
import gc
import json
import os
import pickle
import subprocess
import sys
import types

import numpy as np
import pytest

import pushid

BIN = os.environ.get("PUSHID_BIN", "")


def arrays(recording):
    return recording.hip[:, 0], recording.left_ankle[:, 0], recording.right_ankle[:, 0]


def from_arrays(recording, **changed):
    hip, left, right = arrays(recording)
    given = dict(hip=hip, left_ankle=left, right_ankle=right, mass=recording.mass[0], fps=recording.fps,
                 push=recording.push[:20, 0], push_kind=recording.push_kind, id=recording.id,
                 subjects=recording.subjects[0])
    given.update(changed)
    return pushid.Recording(**given)


def test_recordings_are_read_only_arrays(made):
    recording = made[0][0]
    assert recording.hip.shape == (90, 1, 3) and recording.states.shape == (90, 1, 8)
    assert recording.push.shape == (90, 1, 4)
    for array in (recording.hip, recording.left_ankle, recording.states, recording.push):
        assert array.dtype == np.float64
        with pytest.raises(ValueError):
            array[0] = 0
    assert "person" in repr(made[0]) or "people" in repr(made[0])


def test_ground_and_plates_are_made_from_arrays_and_read_back(made):
    recording = made[0][0]
    assert recording.ground is None and recording.plates is None
    frames, weight = recording.num_frames, recording.mass[0] * 9.81
    seconds = np.arange(frames) / recording.fps
    ground = np.zeros((frames, 4))
    ground[:, 0] = 0.03 * np.clip(seconds - 0.3, 0.0, 0.4) ** 2
    ground[:, 2] = 0.1 * ground[:, 0]
    feet = 0.5 * (recording.left_ankle[0, 0] + recording.right_ankle[0, 0])
    plates = np.tile([1.0, -2.0, weight, feet[0], feet[1]], (frames, 1))
    plates[10] = np.nan
    again = from_arrays(recording, ground=ground, plates=plates)
    assert again.ground.shape == (frames, 4) and again.plates.shape == (frames, 1, 5)
    assert np.array_equal(again.ground, ground) and np.array_equal(again.plates[:, 0], plates, equal_nan=True)
    assert np.array_equal(from_arrays(recording, ground=ground[:, :2]).ground[:, 0], ground[:, 0])
    assert again.content_hash != from_arrays(recording).content_hash
    pickled = pickle.loads(pickle.dumps(again))
    assert np.array_equal(pickled.ground, ground) and np.array_equal(pickled.plates, again.plates, equal_nan=True)
    for changed, said in ((dict(ground=ground[1:]), "rows"), (dict(ground=ground[:, :3]), "theta and phi"),
                          (dict(plates=plates[:, :4]), "px, py"), (dict(plates=1.2 * plates), "kg weigh"),
                          (dict(ground=0.3 * np.stack([seconds, seconds], 1)), "at frame 0")):
        with pytest.raises(pushid.DataError, match=said):
            from_arrays(recording, **changed)


def test_arrays_outlive_their_recording():
    hip = pushid.simulate(people=1, recordings_per_person=1)[0][0].hip
    gc.collect()
    assert np.isfinite(hip).all() and abs(hip[0, 0, 2] - 0.95) < 0.3


def test_tracks_are_read_only_by_frame_and_person(made):
    recording = made[0][0]
    assert recording.hip.shape == (recording.num_frames, 1, 3) and not recording.hip.flags.writeable
    row = pushid.simulate(people=2, people_in_row=2, recordings_per_person=1)[0][0]
    assert row.hip.shape[1:] == (2, 3) and not row.hip.flags.writeable


def test_the_default_fit_finds_the_truth(made, result):
    assert result.converged
    inside = [result[name].interval[0] <= value <= result[name].interval[1] for name, value in made[1].items()]
    assert sum(inside) >= len(inside) - 1
    assert result["mu"].unit == "N s/m" and not result["mu"].fixed
    assert abs(sum(result["mu"].shares.values()) - 1.0) < 1e-9
    names, matrix = result.covariance
    assert matrix.shape == (len(names), len(names)) and (np.linalg.eigvalsh(matrix) > 0).all()
    assert "mu" in str(result) and "mu" in repr(result)


def test_a_misspelt_parameter_is_guessed(result):
    with pytest.raises(KeyError, match="Kp_theta"):
        result["Kp_teta"]


def test_options_are_those_of_the_flags(made):
    with pytest.raises(pushid.UsageError, match="did you mean 'friction'"):
        pushid.fit(made[0], fricton="anisotropic")
    with pytest.raises(pushid.UsageError, match="preset"):
        pushid.fit(made[0], preset="nonsense")
    with pytest.raises(pushid.UsageError, match="not a parameter"):
        pushid.fit(made[0], fix={"nu": 3})
    held = pushid.fit(made[0], fix={"mu": np.float64(25)}, prior={"Kp_theta": (1500, np.float32(300))})
    assert held["mu"].value == 25.0 and held["mu"].fixed
    assert "tail" in pushid.options()["preset"][0]
    assert not [name for name, (meaning, _) in pushid.options().items() if "--" in meaning], "flags in Python's words"


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_arrays_of_any_layout(made, order, dtype):
    recording = made[0][0]
    changed = {name: np.asarray(array, dtype=dtype, order=order)
               for name, array in zip(("hip", "left_ankle", "right_ankle"), arrays(recording))}
    wide = np.zeros((90, 6))
    wide[:, ::2] = changed["hip"]
    changed["hip"] = wide[:, ::2]
    again = from_arrays(recording, **changed)
    assert np.allclose(again.hip, recording.hip, atol=1e-6)
    assert np.allclose(again.push, from_arrays(recording).push)


@pytest.mark.parametrize("changed, says", [
    (dict(hip=np.zeros((90, 2))), r"hip has the shape \(90, 2\)"),
    (dict(hip=np.zeros((80, 3))), "frames"),
    (dict(hip=np.full((90, 3), np.nan)), "missing"),
    (dict(hip=np.full((90, 3), "a")), "must hold numbers"),
    (dict(mass=-3.0), "mass"),
    (dict(mass=[70.0, 80.0]), "as many"),
    (dict(fps=0.0), "fps"),
    (dict(push=np.zeros((20, 7))), "push has the shape"),
    (dict(push=np.zeros(400)), "is not within"),
    (dict(push=[np.nan, 1.0]), "not finite"),
    (dict(push_kind="hard"), "push_kind"),
    (dict(pushed_person=3), "pushed_person"),
    (dict(push_height=1.2), r"push_height is 1.2; it is a fraction.*push_height_m"),
    (dict(push_height=-0.1), "push_height"),
    (dict(push_height_m=85.0), "push_height_m"),
])
def test_bad_arrays_are_told(made, changed, says):
    with pytest.raises((pushid.DataError, pushid.UsageError), match=says):
        from_arrays(made[0][0], **changed)


def test_units_masks_and_names(made):
    recording = made[0][0]
    mm = {name: 1000.0 * track for name, track in zip(("hip", "left_ankle", "right_ankle"), arrays(recording))}
    with pytest.raises(pushid.DataError, match='looks like mm, pass length_unit="mm"'):
        from_arrays(recording, **mm)
    again = from_arrays(recording, **mm, length_unit="mm", id=7, subjects=3)
    assert np.allclose(again.hip, recording.hip) and again.id == "7" and again.subjects == ["3"]
    hidden = np.ma.array(arrays(recording)[0].copy())
    hidden[30:33] = np.ma.masked
    assert np.abs(from_arrays(recording, hip=hidden).hip[30:33] - recording.hip[30:33]).max() < 0.01


def test_what_is_no_recording_is_told(made, result):
    for call in (lambda: pushid.fit(made[0][0].hip), lambda: result.predict("a"), lambda: result.evaluate([1])):
        with pytest.raises((pushid.UsageError, TypeError), match="recording"):
            call()
    with pytest.raises(pushid.UsageError, match="no recordings"):
        pushid.fit([])


def test_gaps_are_filled(made):
    hip = arrays(made[0][0])[0].copy()
    hip[30:33] = np.nan
    filled = from_arrays(made[0][0], hip=hip)
    assert np.abs(filled.hip[30:33, 0] - made[0][0].hip[30:33, 0]).max() < 0.01


def test_many_gaps_are_warned_of_and_count_less(made):
    rng = np.random.default_rng(1)
    found = []
    for share in (0.0, 0.5):
        some = []
        for recording in made[0]:
            hip = arrays(recording)[0].copy()
            hip[1:][rng.random(len(hip) - 1) < share] = np.nan
            if share:
                with pytest.warns(UserWarning, match=f"recording '{recording.id}'.*these count less"):
                    some.append(from_arrays(recording, hip=hip))
            else:
                some.append(from_arrays(recording))
        found.append(pushid.fit(some, fix={"tail_base": 0}, preset_priors=False, settling_weight=0))
    whole, half = (next(row["standard_error_naive"] for row in one.table if row["name"] == "mu") for one in found)
    assert half > 1.01 * whole  # 0.75 of the frames, of which neighbours say the same


def test_exchanged_ankles_are_doubted(made):
    _, left, right = arrays(made[0][0])
    with pytest.warns(UserWarning, match="ankles not exchanged"):
        from_arrays(made[0][0], left_ankle=right, right_ankle=left)


def test_recordings_need_ids_of_their_own(made, result):
    twins = [from_arrays(recording, id="recording") for recording in made[0][:2]]
    for call in (lambda: pushid.fit(twins), lambda: pushid.fit([made[0][0]] * 2), lambda: pushid.crossvalidate(twins)):
        with pytest.raises(pushid.UsageError, match="two recordings are called"):
            call()


def test_recordings_are_pickled_and_copied(made, result):
    for again in (pickle.loads(pickle.dumps(made[0])), copy.deepcopy(made[0])):
        assert again.warnings == made[0].warnings and repr(again) == repr(made[0])
        for one, other in zip(again, made[0]):
            for name in ("id", "setting", "magnitude", "fps", "content_hash", "push_kind", "subjects", "mass"):
                assert getattr(one, name) == getattr(other, name)
            for name in ("hip", "left_ankle", "right_ankle", "states", "push"):
                assert np.array_equal(getattr(one, name), getattr(other, name))
        assert pushid.fit(again)["mu"] == result["mu"]


def test_a_height_in_metres(made):
    recording = made[0][0]
    metres = recording.hip[0, 0, 2] - 1e-9
    by_fraction = from_arrays(recording, push=np.full(10, 100.0))
    by_metres = from_arrays(recording, push=np.full(10, 100.0), push_height_m=metres)
    assert np.allclose(by_metres.push, by_fraction.push, rtol=1e-6)
    lower = from_arrays(recording, push=np.full(10, 100.0), push_height_m=0.7 * metres)
    assert 0 < lower.push[0, 0, 2] < by_fraction.push[0, 0, 2]


def test_the_verdict_is_data(result):
    assert result.verdict["fails"] in (True, False)
    row = next(row for row in result.table if row["name"] == "mu")
    assert result["mu"].interval == tuple(row["interval"]) == tuple(row.get("total", row)["interval_95"])
    assert row["interval"][0] <= row["interval_95"][0] and row["interval_95"][1] <= row["interval"][1]


def test_fixed_and_derived_values(result):
    fixed = result["Kp_x"]
    assert fixed.fixed and fixed.interval is None and fixed.standard_error is None
    c_x = result["c_x"]
    assert c_x.status == "derived" and c_x.interval[0] < c_x.value < c_x.interval[1] and c_x.unit == "N s/m"
    assert c_x.value == pytest.approx(result["mu"].value + result["Kp_x"].value)
    damping = result["Kd_theta/(m l^2)"]
    assert damping.interval[0] < damping.value < damping.interval[1]
    with pytest.raises(KeyError, match="c_x"):
        result["cx"]


def test_a_frame_is_flat(result, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", types.SimpleNamespace(DataFrame=list))
    rows = {row["name"]: row for row in result.table.to_frame()}
    mu = rows["mu"]
    assert (mu["interval_lower"], mu["interval_upper"]) == result["mu"].interval
    assert mu["shares_data"] == result["mu"].shares["data"]
    assert not any(isinstance(cell, (dict, list)) for row in rows.values() for cell in row.values())
    assert "interval_lower" not in rows["Kp_x"]
    designs = result.design("mu")["pushes"].to_frame()
    assert "error_ratio_mu" in designs[0]


def test_what_is_printed_names_calls(result):
    for text in (str(result), result.details, *result.warnings, *(sentence for sentence, _ in result.advice)):
        assert "--" not in text and "pushid-" not in text
    assert "result.profile()" in result.details and len(str(result).splitlines()) <= 24


def test_hints_are_calls():
    said = pushid._options.in_python
    for text, call in {
            "leave them out (--leave_out=a,b)": 'leave them out (leave_out=["a", "b"])',
            "--preset=group or --seed=8 adds one.": 'preset="group" or seed=8 adds one.',
            "use --fix=mu=0, then see": 'use fix={"mu": 0}, then see',
            "--fix: 'a' is unknown": "fix: 'a' is unknown",
            "repeat it by pushid-check --bootstrap=199": "repeat it by result.bootstrap(199)",
            "--bootstrap and --profile refit": "result.bootstrap() and result.profile() refit",
            "see pushid-push --person": "see pushid.estimate_push(recording, person)",
            "(pushid-fit --setting=groups --interaction=contact)":
                '(pushid.fit(recordings, setting="groups", interaction="contact"))',
            "pushid-fit --model_out writes one": "result.save writes one",
            "pushid-train-restoration wrote": "pushid-train-restoration wrote"}.items():
        assert said(text) == call


def test_forces_become_generalized_ones(made):
    recording = from_arrays(made[0][0], push=np.full(10, 100.0), push_start=5, push_kind="external")
    assert (recording.push[5:15, 0, 0] == 100.0).all() and (recording.push[:5] == 0).all()
    assert (recording.push[5:15, 0, 2] > 60.0).all()  # times the rod


def test_files_in_odd_units(tmp_path, made):
    inches = 1.0 / 0.0254
    recording = made[0][0]
    tracks = [inches * track for track in arrays(recording)]
    lines = ["time,hip_x,hip_y,hip_z,left_ankle_x,left_ankle_y,left_ankle_z,right_ankle_x,right_ankle_y,right_ankle_z"]
    for t in range(recording.num_frames):
        lines.append(",".join([repr(t / 60), *(repr(float(x)) for track in tracks for x in track[t])]))
    (tmp_path / "a.csv").write_text("\n".join(lines))
    (tmp_path / "p.csv").write_text("frame,fx,fy,ftheta,fphi\n0,90,0,90,0\n1,90,0,90,0\n")
    joints = ("hip", "left_ankle", "right_ankle")
    (tmp_path / "m.json").write_text(json.dumps({"recordings": [
        {"id": "a", "setting": "single", "magnitude": "weak", "subjects": [{"id": "S", "mass_kg": 70.0}], "fps": 60,
         "pushed_person": 0, "csv": ["a.csv"], "push_csv": "p.csv", "push_kind": "net", "joints": {name: name for name in joints}}]}))
    read = pushid.read(tmp_path / "m.json", length_scale=0.0254)
    assert np.allclose(read[0].hip, recording.hip, atol=1e-9)
    for wrong in (dict(length_scale=-1.0), dict(length_scale=0.0254, length_unit="mm"), dict(length_unit="ell")):
        with pytest.raises(pushid.UsageError, match="length_"):
            pushid.read(tmp_path / "m.json", **wrong)
    with pytest.raises(pushid.DataError) as told:
        pushid.read(tmp_path / "m.json", length_unit="m")
    assert "--" not in str(told.value)


def test_errors_say_file_and_line(tmp_path):
    path = tmp_path / "manifest.json"
    path.write_text('{"recordings": [\n{"id": "a"}]}')
    with pytest.raises(pushid.DataError) as told:
        pushid.read(path)
    assert told.value.file == str(path) and told.value.line == 2
    with pytest.raises(pushid.DataError):
        pushid.load(tmp_path / "none.json")


def test_a_recording_without_push_is_told(made):
    with pytest.raises(pushid.DataError, match="no push"):
        pushid.fit(from_arrays(made[0][0], push=None))
    rows, first, kind = pushid.estimate_push(made[0][0])
    assert rows.shape[1] == 4 and first >= 0 and kind == "net"


def test_what_cannot_be_right_is_found(made):
    assert pushid.findings(made[0]) == []
    found = pushid.findings(from_arrays(made[0][0], mass=18.0, push=-made[0][0].push[:20, 0]))
    kinds = {one["kind"]: one for one in found}
    assert kinds["push against motion"]["value"] > 150 and kinds["mass"]["value"] == 18.0
    assert kinds["mass"]["unit"] == "kg" and "mass_kg" in kinds["mass"]["advice"]


def test_predictions(made, result):
    recording = made[0][1]
    predicted = result.predict(recording)
    assert predicted["hip"].shape == (90, 1, 3)
    assert np.abs(predicted["hip"][1:, 0, 0] - recording.hip[1:, 0, 0]).mean() < 0.05
    seen = result.predict(recording, observed=20)
    assert (seen["lower90"] <= seen["upper90"]).all() and seen["observed"] == 20
    less = result.predict(recording, set={"mu": 0.0})
    assert less["hip"][-1, 0, 0] > predicted["hip"][-1, 0, 0]
    harder = result.predict(recording, push_scale=1.37)
    assert harder["hip"][-1, 0, 0] > predicted["hip"][-1, 0, 0]
    thrice = result.predict(recording, push_again=[40, 80], frames=150)["hip"]
    once = result.predict(recording, frames=150)["hip"]
    assert np.allclose(thrice[:41], once[:41], atol=1e-12) and thrice[-1, 0, 0] > once[-1, 0, 0] + 0.1
    for wrong in ({"push_scale": 0.0}, {"push_again": [2]}, {"push_again": [89]}, {"push_scale": 2.0, "observed": 20}):
        with pytest.raises(pushid.UsageError, match=f"{[*wrong][0]}[ :]"):
            result.predict(recording, **wrong)
    with pytest.raises(pushid.UsageError, match="observed"):
        result.predict(recording, observed=91)
    with pytest.raises(pushid.UsageError, match="negative"):
        result.predict(recording, samples=-5)
    scores = result.evaluate(made[0])
    assert 0 < scores["mean"]["hipADE_m"] < 0.05
    assert "static" in repr(scores) and len(repr(scores)) < 4000  # a table, and no dump
    assert str(pickle.loads(pickle.dumps(scores))) == str(scores)


def test_online(made, result):
    recording = made[0][1]
    online = pushid.OnlinePredictor(result, recording, 90)
    first = online.predict()["hip"]
    assert np.array_equal(first, result.predict(recording)["hip"])
    for t in range(1, 20):
        online.observe(recording.hip[t], recording.left_ankle[t], recording.right_ankle[t])
    assert online.observed == 20
    assert np.allclose(online.predict()["hip"], result.predict(recording, observed=20)["hip"], atol=1e-9)
    with pytest.raises(pushid.DataError):
        online.observe(np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3)))


def test_saved_loaded_and_pickled(made, result, tmp_path):
    result.save(tmp_path / "model.json")
    loaded = pushid.load(tmp_path / "model.json")
    assert loaded["mu"] == result["mu"]
    assert pickle.loads(pickle.dumps(result))["mu"] == result["mu"]
    with pytest.raises(pushid.UsageError, match="recordings"):
        loaded.profile("mu")
    assert loaded.attach(made[0]).profile("mu")
    for others in (made[0][:3], made[0][::-1], [from_arrays(made[0][0])] + made[0][1:]):
        with pytest.raises(pushid.UsageError, match="not the 12 recordings"):
            loaded.attach(others)


def test_report_is_a_page(result, tmp_path):
    page = result.report(tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.lstrip().startswith("<!DOCTYPE html>") and "mu" in page
    assert "result.profile()" in page and "pushid-check" not in page
    with pytest.raises(pushid.UsageError, match="let its name end in .html"):
        result.report(tmp_path / "report.pdf")
    assert not (tmp_path / "report.pdf").exists()


@pytest.mark.skipif(not BIN, reason="PUSHID_BIN names no programs")
def test_results_are_the_programs(tmp_path):
    made = tmp_path / "made"
    subprocess.run([f"{BIN}/pushid-simulate", f"--out={made}", "--people=2"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([f"{BIN}/pushid-fit", f"--recordings={made}/manifest.json", f"--model_out={tmp_path}/m.json"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(tmp_path / "m.json", encoding="utf-8") as file:
        program = json.load(file)
    here = pushid.fit(pushid.read(made / "manifest.json"))
    assert here.json["values"] == program["values"]
    assert here.json["parameters"] == program["parameters"]
    here.save(tmp_path / "here.json")
    report = subprocess.run([f"{BIN}/pushid-report", f"--model={tmp_path}/here.json"], check=True,
                            stdout=subprocess.PIPE, text=True).stdout
    assert "mu" in report


def test_stubs_name_everything():
    folder = os.path.dirname(pushid.__file__)
    with open(os.path.join(folder, "__init__.pyi"), encoding="utf-8") as file:
        stubs = file.read()
    for name in pushid.__all__:
        assert f"class {name}" in stubs or f"def {name}" in stubs, name
        assert (getattr(pushid, name).__doc__ or "").strip(), name
    for owner in (pushid.Result, pushid.OnlinePredictor, pushid.Restoration, pushid.Design):
        for name, member in vars(owner).items():
            if name.startswith("_"):
                continue
            assert f"def {name}(" in stubs or f"    {name}: " in stubs, f"{owner.__name__}.{name}"
            assert (member.__doc__ or "").strip(), f"{owner.__name__}.{name}"
    compile(stubs, "__init__.pyi", "exec")


def test_pip_installs_this_version():
    with open(os.path.join(os.path.dirname(__file__), "../../apps/python/pyproject.toml"), encoding="utf-8") as file:
        assert f'version = "{pushid.__version__}"' in file.read()


if __name__ == "__main__":
    sys.exit(pytest.main([__file__]))
