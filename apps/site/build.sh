#!/usr/bin/env bash
# The documentation site, in build/site/html, without a network: the READMEs, and what programs say of themselves.
#   bash apps/site/build.sh        needs mkdocs (Debian: apt-get install mkdocs) and the built programs
# PUSHID_BIN: where the programs are (default build/release/bin).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if ! command -v mkdocs >/dev/null; then
  echo "mkdocs is not installed: apt-get install --no-install-recommends mkdocs" >&2
  exit 77  # skipped, for ctest
fi
bin=${PUSHID_BIN:-build/release/bin}
if [ ! -x "$bin/pushid-fit" ]; then
  echo "$bin has no pushid-fit; build the programs (bash apps/quickstart.sh), or set PUSHID_BIN" >&2
  exit 1
fi
rm -rf build/site
python=/usr/bin/python3  # Debian's, which the module is built for
export PYTHONDONTWRITEBYTECODE=1
[ -x $python ] || python=python3
$python apps/site/pages.py "$bin"
mkdocs build --quiet --config-file apps/site/mkdocs.yml
$python apps/site/links.py build/site/html
