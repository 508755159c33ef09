"""Agents of another simulator move as pushid-formation has them."""
import csv
import json
import os
import subprocess

import pytest

from pushid import agents

BIN = os.environ["PUSHID_BIN"]


def program(name, *flags):
    return subprocess.run([os.path.join(BIN, name), *flags], capture_output=True, text=True)


@pytest.fixture(scope="module")
def group(tmp_path_factory):
    """A group model with parameters that differ by axis, of people of several sizes; and their manifest."""
    folder = tmp_path_factory.mktemp("agents")
    manifest = folder / "manifest.json"
    assert program("pushid-simulate", f"--out={folder}", "--people=4", "--group_size=4", "--recordings_per_person=1",
                   "--seed=3").returncode == 0
    made = program("pushid-fit", f"--recordings={manifest}", "--preset=group", "--friction=anisotropic", "--directions=axes",
                   f"--model_out={folder}/model.json")
    assert made.returncode == 0, made.stderr
    done = program("pushid-formation", f"--model={folder}/model.json", "--formation=line", "--people=2", "--push=5",
                   f"--agents_out={folder}/two.json")
    assert done.returncode == 0, done.stderr
    return folder


# The table of states has nine digits.
TOLERANCE = 1e-7  # m, rad


@pytest.mark.parametrize("shape", [("--formation=line", "--people=4"), ("--formation=diamond", "--people=4", "--spacing=0.36"),
                                   ("--formation=grid", "--people=6", "--pushed=0,1", "--push=60@0,30@0.5")])
def test_the_same_paths(group, shape):
    done = program("pushid-formation", f"--model={group}/model.json", f"--people_from={group}/manifest.json", *shape,
                   "--duration=2.5", "--set=mu_y=60,a_y=-7,Kd_phi=90,t_y=4", f"--agents_out={group}/agents.json",
                   f"--csv_out={group}/paths.csv")
    assert done.returncode == 0, done.stderr
    crowd = agents.Crowd(group / "agents.json")
    with open(group / "paths.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len({agent.parameters["mass_kg"] for agent in crowd.agents}) > 1
    moved = sideways = 0.0
    for row in rows:
        while crowd.steps < int(row["frame"]):
            crowd.iterate()
        agent = crowd.agents[int(row["person"])]
        for value, key in zip(agent.q + agent.qd, ("x_m", "y_m", "theta_rad", "phi_rad", "xd_m_s", "yd_m_s", "thetad_rad_s",
                                                   "phid_rad_s")):
            assert value == pytest.approx(float(row[key]), abs=TOLERANCE * (1 + abs(value))), (row["frame"], key)
        assert agent.position == pytest.approx((float(row["hip_x_m"]), float(row["hip_y_m"])), abs=TOLERANCE)
        moved = max(moved, abs(agent.q[0] - agent.first[0]))
        sideways = max(sideways, abs(agent.q[1] - agent.first[1]))
    assert moved > 0.1
    if "--formation=diamond" in shape:
        assert sideways > 1e-3


def test_an_update_changes_nobody(group):
    crowd = agents.Crowd(group / "two.json")
    agent = crowd.agents[0]
    before = list(agent.q), list(agent.qd)
    update = crowd.model.compute_new_state(crowd.dt, agent, crowd.agents, (100.0, 0.0, 0.0, 0.0))
    assert (agent.q, agent.qd) == before
    crowd.model.apply_update(update, agent)
    assert agent.qd[0] > 0.0


def test_models_that_agents_lack_are_refused(group, tmp_path):
    model = json.loads((group / "model.json").read_text())
    model["model"]["friction"] = "coulomb"
    (tmp_path / "dry.json").write_text(json.dumps(model))
    done = program("pushid-formation", f"--model={tmp_path}/dry.json", "--formation=line", "--people=2", "--push=5",
                   f"--agents_out={tmp_path}/b.json")
    assert done.returncode == 1 and "dry friction" in done.stderr, done.stderr
    with pytest.raises(ValueError, match="agents_out"):
        agents.Crowd(group / "manifest.json")
