#!/usr/bin/env bash
# From a fresh machine to identified parameters and a prediction: installs what is missing, builds the
# programs, makes recordings of synthetic people whose parameters are known, fits them, compares, and
# predicts a push that was held out. May be run again and again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source tests/install_packages.sh
out=quickstart-output
bin=build/quickstart/bin
export OPENBLAS_NUM_THREADS=1  # results repeat bit by bit

say() { printf '\n== %s\n' "$*"; }

say "Packages"
install_packages "${build_packages[@]}"
echo "all there"

say "Building the programs (build/quickstart)"
generator=()
command -v ninja >/dev/null && [ ! -f build/quickstart/CMakeCache.txt ] && generator=(-G Ninja)
cmake --preset quickstart "${generator[@]}" >/dev/null
cmake --build --preset quickstart --parallel "$(nproc)" --target \
  pushid-simulate pushid-fit pushid-report pushid-evaluate pushid-predict

say "Recordings of four synthetic people with known parameters, joints noisy by 2 mm"
"$bin/pushid-simulate" --out="$out/recordings" --people=4 --recordings_per_person=6 --seed=1
say "Recordings of two other people, held out"
"$bin/pushid-simulate" --out="$out/held-out" --people=2 --recordings_per_person=3 --seed=2

say "Identifying friction, balance gains and the push tail (no priors: the truth must come from the data)"
"$bin/pushid-fit" --recordings="$out/recordings/manifest.json" --setting=single \
  --preset_priors=false --settling_weight=0 --model_out="$out/model.json" >"$out/report.txt"
"$bin/pushid-report" --model="$out/model.json" --truth="$out/recordings/manifest.json"

say "Predicting the held-out pushes"
"$bin/pushid-evaluate" --model="$out/model.json" --recordings="$out/held-out/manifest.json" \
  --per_recording=false --json_out="$out/scores.json"
id=S01_00_weak
"$bin/pushid-predict" --model="$out/model.json" --recordings="$out/held-out/manifest.json" \
  --id="$id" --out="$out/trajectory.csv"

say "Done. Written to $out/"
echo "  recordings/      BVH, push CSV and manifest.json: the format for your own recordings"
echo "  model.json       the identified model;  report.txt: the whole report"
echo "  scores.json      prediction errors on the held-out pushes"
echo "  trajectory.csv   a predicted push: states, hip and forces over time"
echo "Your own recordings:"
echo "  $bin/pushid-fit --recordings=YOUR/manifest.json --setting=single --model_out=model.json"
