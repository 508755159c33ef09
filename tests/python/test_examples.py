"""The examples run as they stand; the notebooks by Jupyter where it is there."""
import glob
import importlib.util
import json
import os
import runpy
import shutil
import subprocess

import pytest

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../apps/python/examples")
NOTEBOOKS = sorted(glob.glob(os.path.join(EXAMPLES, "*.ipynb")))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=os.path.basename)
def test_cells_run(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with open(path, encoding="utf-8") as file:
        cells = json.load(file)["cells"]
    names = {}
    for cell in cells:
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), names)  # pylint: disable=exec-used


@pytest.mark.skipif(shutil.which("jupyter") is None or importlib.util.find_spec("ipykernel") is None,
                    reason="Jupyter is not there")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=os.path.basename)
def test_notebooks_execute(path, tmp_path):
    subprocess.run(["jupyter", "nbconvert", "--to", "notebook", "--execute", f"--output-dir={tmp_path}", path], check=True)


def test_online(capsys):
    runpy.run_path(os.path.join(EXAMPLES, "online.py"))
    assert "median" in capsys.readouterr().out
