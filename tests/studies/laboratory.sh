#!/usr/bin/env bash
# Recordings as a laboratory has them, of people who are not the fitted model (tests/simulators/laboratory.h): two links,
# active torques that come late, feet that step. What is found of them, what is not, and which diagnostics say so.
#   bash tests/studies/laboratory.sh [FOLDER]   default quickstart-output/laboratory; programs from PUSHID_BIN
set -euo pipefail
out=${1:-quickstart-output/laboratory}
bin=${PUSHID_BIN:-$(dirname "${BASH_SOURCE[0]}")/../../build/release/bin}
export OPENBLAS_NUM_THREADS=1  # results repeat bit by bit

say() { printf '\n== %s\n' "$*"; }

say "Making a laboratory's recordings of four people: markers, two force platforms, a load cell that pulls at the hips"
"$bin/simulate-others" --out="$out" --laboratory=4 --seed=1
manifest=$out/manifest.json
ids=$(cd "$out/force" && printf '%s,' *.csv | sed 's/\.csv,/,/g; s/,$//')

say "Pushes from the load cell, whose reading at rest is subtracted"
"$bin/pushid-push" --recordings="$manifest" --ids="$ids" --sensor="$out/force/{id}.csv" --out="$out/push/{id}.csv" \
  --update --overwrite | tail -n 1

say "Who stands: feet that hold and a reaction delay, from markers and platforms"
"$bin/pushid-fit" --recordings="$manifest" --setting=standing --stance=fixed --delay=one --model_out="$out/standing.json" \
  --quiet >"$out/standing.txt"
"$bin/pushid-report" --model="$out/standing.json" --details >>"$out/standing.txt"
"$bin/pushid-report" --model="$out/standing.json" --truth="$out/truth.json" >"$out/compared.txt"
"$bin/pushid-report" --model="$out/standing.json" --recordings="$manifest" --html_out="$out/report.html" 2>/dev/null
echo "  $(realpath "$out")/report.html"

say "Who steps: predicted by the model of who stands"
"$bin/pushid-evaluate" --model="$out/standing.json" --recordings="$manifest" --setting=stepping \
  --json_out="$out/stepping.json" >"$out/stepping.txt" 2>"$out/warnings.txt"

say "Result"
awk -F '  +' '
  FILENAME ~ /standing.txt$/ {
    if (!($1 in status) && $4 ~ /^\[/) status[$1] = $6
    if (/^The model does not fit/ && !verdict) { verdict = $0; said = 1; next }
    if (said && NF) verdict = verdict " " $0; else said = 0
    if ($1 == "lag of the pushes" && !lag) lag = $3
    next
  }
  $1 == "parameter" { printf "%-18s %7s %9s  %-18s %s\n", $1, $2, $3, "95 % interval", "status"; next }
  NF >= 6 {
    printf "%-18s %7s %9s  %-18s %s\n", $1, $2, $3, $5, status[$1]
    off = $3 / $2 - 1; if (off < 0) off = -off
    text = $1 sprintf(" (%.0f %% off)", 100 * off)
    if (off <= 0.1 && status[$1] != "prior-held") found = found (found ? ", " : "") text
    else lost = lost (lost ? ", " : "") text (status[$1] == "prior-held" ? " prior-held" : "")
  }
  END {
    print "recovered within 10 %: " (found ? found : "nothing")
    print "not recovered: " (lost ? lost : "nothing")
    print "the report says: " verdict
    print "what is taken as known: the recordings ask for pushes " lag " later"
  }' "$out/standing.txt" "$out/compared.txt"
awk -F '  +' '/^mean over recordings/ {
  for (i = 2; i <= 3; ++i) sub(/ .*/, "", $i)
  print "who steps, predicted by the model of who stands: mean error of the hip " $2 " m, of one who would not move " $3 " m"
}' "$out/stepping.txt"
sed -n 's/^pushid-evaluate: warning: /the evaluation warns: /p' "$out/warnings.txt"
