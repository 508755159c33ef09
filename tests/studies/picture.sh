#!/usr/bin/env bash
# Draws the picture of README.md, tests/studies/pictures/wave.svg, from synthetic recordings alone: people
# are simulated and fitted, contact has its default parameters, and a push goes through a line of ten.
# Two seconds. PUSHID_BIN is the folder of the programs (default build/release/bin).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bin=${PUSHID_BIN:-build/release/bin}
export OPENBLAS_NUM_THREADS=1  # results repeat bit by bit
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$bin/pushid-simulate" --out="$work/recordings" --overwrite >/dev/null
# Nobody is touched in these recordings: contact is held, and acts in the line.
"$bin/pushid-fit" --recordings="$work/recordings/manifest.json" --interaction=contact \
  --fix=contact_stiffness,contact_damping,contact_distance,contact_kappa --model_out="$work/model.json" >/dev/null
mkdir -p tests/studies/pictures
"$bin/pushid-simulate" --model="$work/model.json" --formation=line --people=10 --spacing=0.45 --push=80 \
  --svg_out=tests/studies/pictures/wave.svg
