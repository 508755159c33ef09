"""The examples run as they stand."""
import os
import runpy

import pytest

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../apps/python/examples")


@pytest.mark.parametrize("name, says", [("first_steps.py", "without drag"), ("online.py", "median")])
def test_they_run(name, says, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    runpy.run_path(os.path.join(EXAMPLES, name))
    assert says in capsys.readouterr().out
