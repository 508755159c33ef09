#!/usr/bin/env bash
# The wheel of a build, installed in an empty virtual environment beside Debian's NumPy; the Python tutorial runs with it.
#   wheel_test.sh BUILD PYTHON
# Exit code 77, which ctest counts as skipped, without pip, venv, setuptools or wheel.
set -euo pipefail
source_dir="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
build="$1"
python="$2"
if ! "$python" -c 'import setuptools, ensurepip, pip, venv, wheel' 2>/dev/null; then
  echo "$python has no pip, venv, setuptools or wheel (python3-venv, python3-pip, python3-wheel)"
  exit 77
fi
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
unset PYTHONPATH
wheel() { PUSHID_BUILD="$1" "$python" -m pip wheel -q "$source_dir/apps/python" --no-build-isolation --no-deps -w "$scratch/wheels"; }
if wheel "$scratch/none" 2>"$scratch/refused" || ! grep -q "$scratch/none is no build" "$scratch/refused"; then
  echo "a build that is not there: no error says so"
  exit 1
fi
wheel "${build#"$source_dir/"}"  # relative, as apps/README.md says, where the build is in the project
ls "$scratch/wheels"
"$python" -m venv --system-site-packages "$scratch/venv"
"$scratch/venv/bin/python" -m pip install -q --no-index --no-deps "$scratch"/wheels/pushid-*.whl
(cd "$scratch" && venv/bin/python -c "import pushid; assert '/venv/' in pushid.__file__, pushid.__file__")
# A folder without programs, beside which no other module is found.
mkdir "$scratch/bin"
"$scratch/venv/bin/python" "$source_dir/tests/apps/tutorials.py" "$scratch/bin" python
