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
for program in fit simulate report formation batch check; do  # quickstart.sh builds some of them
  if [ ! -x "$bin/pushid-$program" ]; then
    echo "$bin has no pushid-$program; build all programs (cmake --preset release && cmake --build --preset release)," >&2
    echo "or set PUSHID_BIN to where they are" >&2
    exit 1
  fi
done
rm -rf build/site
python=/usr/bin/python3  # Debian's, which the module is built for
export PYTHONDONTWRITEBYTECODE=1
[ -x $python ] || python=python3
$python apps/site/pages.py "$bin"
mkdocs build --quiet --config-file apps/site/mkdocs.yml
$python apps/site/links.py build/site/html
