#!/usr/bin/env bash
# From a fresh machine to identified parameters and a prediction: installs what is missing, builds the
# programs, makes recordings of synthetic people whose parameters are known, fits them, compares, and
# predicts pushes that were held out. May be run again and again, from any folder.
#   --out=FOLDER   default quickstart-output
# PUSHID_BIN: use the programs in this folder, and build nothing.
set -euo pipefail
out=quickstart-output
for word in "$@"; do
  case $word in
    --out=?*) out=$(realpath -m "${word#*=}") ;;
    *) echo "quickstart.sh: '$word' is not --out=FOLDER" >&2; exit 1 ;;
  esac
done
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=tests/install_packages.sh
source tests/install_packages.sh
bin=${PUSHID_BIN:-build/release/bin}
export OPENBLAS_NUM_THREADS=1  # results repeat bit by bit

say() { printf '\n== %s\n' "$*"; }

if [ -z "${PUSHID_BIN:-}" ]; then
  say "Packages"
  install_packages "${build_packages[@]}"
  skip_unusable_ccache
  echo "all packages are installed"

  say "Building the programs that are called here into $bin (some minutes the first time)"
  generator=()
  if [ ! -f build/release/CMakeCache.txt ] && command -v ninja >/dev/null; then generator=(-G Ninja); fi
  cmake --preset release "${generator[@]}" >/dev/null
  cmake --build build/release --parallel "$(nproc)" --target pushid_quickstart
fi

# The study FOLDER SEED: recordings of eight people, and a fit with default flags, whose priors do not depend on the truth.
study() {
  "$bin/pushid-simulate" --out="$1/recordings" --people=8 --recordings_per_person=6 --seed="$2" --overwrite
  "$bin/pushid-fit" --recordings="$1/recordings/manifest.json" --setting=single --quiet --model_out="$1/model.json" \
    >"$1/report.txt"
  "$bin/pushid-report" --model="$1/model.json" --truth="$1/recordings/manifest.json" >"$1/identified.txt"
}

say "Making recordings of eight synthetic people with known parameters, with 2 mm of noise on the joints; a fit of them"
echo "These data come from the model that is fitted below: an example of the commands, and no test of the model."
study "$out" 1
cat "$out/identified.txt"

say "Repeating the study with 20 other seeds: people, pushes and noise are drawn anew"
repeated=$(mktemp -d -p /dev/shm 2>/dev/null || mktemp -d)  # thousands of small files: not on a disk
trap 'rm -r "$repeated"' EXIT
for seed in {2..21}; do
  study "$repeated" "$seed" >/dev/null
  tail -n 1 "$repeated/identified.txt"
done >"$out/studies.txt"

say "Making recordings of two other people, held out: the same parameters, other bodies and pushes"
"$bin/pushid-simulate" --out="$out/held-out" --people=2 --recordings_per_person=3 --seed=2 --overwrite | tail -n 1

say "Predicting the held-out pushes: mean and last error of the hip, compared with two baselines"
"$bin/pushid-evaluate" --model="$out/model.json" --recordings="$out/held-out/manifest.json" \
  --json_out="$out/scores.json" | tee "$out/errors.txt"

say "Writing one of the predictions as a trajectory"
"$bin/pushid-predict" --model="$out/model.json" --recordings="$out/held-out/manifest.json" \
  --id=S01_00_weak --out="$out/trajectory.csv"

say "Writing the report as a page, and the same prediction as an animation"
"$bin/pushid-report" --model="$out/model.json" --recordings="$out/recordings/manifest.json" \
  --html_out="$out/report.html" 2>/dev/null
"$bin/pushid-animate" --model="$out/model.json" --recordings="$out/held-out/manifest.json" \
  --id=S01_00_weak --out="$out/motion.html" >/dev/null
echo "  $(realpath "$out")/report.html"
echo "  $(realpath "$out")/motion.html"

say "Done. In $(realpath "$out"):"
echo "  recordings/      BVH, push CSV and manifest.json: the format for your own recordings"
echo "  held-out/        the recordings that were predicted"
echo "  model.json       the identified model"
echo "  report.txt       the report as text: status, errors, parameters that the data cannot separate"
echo "  report.html      the report as a page with pictures; it needs no network"
echo "  studies.txt      how many intervals covered in 20 other studies"
echo "  scores.json      prediction errors on the held-out pushes"
echo "  trajectory.csv   a predicted push: states, hip and forces over time"
echo "  motion.html      animation of the recorded and the predicted person"
printf '\nYour own recordings (README.md, Your own recordings; cmake --build --preset programs builds the other programs):\n'
echo "  $(realpath "$bin")/pushid-fit --recordings=YOUR/manifest.json --setting=single --model_out=model.json"

say "Result"
grep -E '^(parameter|mu|Kp_theta) |intervals cover' "$out/identified.txt"
awk -F '   *' '/^mean over recordings/ {
  for (i = 2; i <= 4; ++i) sub(/ .*/, "", $i)
  print "mean error of the hip on held-out pushes: " $2 " m (static " $3 ", constant velocity " $4 ")"
}' "$out/errors.txt"
awk '{ inside += $1; all += $3; whole += $1 == $3 } END {
  print NR " further studies with other seeds: " inside " of " all " intervals cover the truth; in " whole " of them all do"
}' "$out/studies.txt"
