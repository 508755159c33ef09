#!/usr/bin/env bash
# Draws the pictures of README.md in tests/studies/pictures:
#   report.png  the top of a report page, of synthetic people; photographed in a browser (chromium)
#   row.png     a push through a row of five people, predicted over recorded. The recording is in neither the fit nor the
#               training of the restoration. Two minutes; needs the published recordings, LibTorch and matplotlib
# A picture whose needs are missing stays as it is. PUSHID_BIN is the folder of the programs (default build/release/bin),
# PUSHID_RECORDINGS that of the recordings.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bin=${PUSHID_BIN:-build/release/bin}
recordings=${PUSHID_RECORDINGS:-../shared/fzj_push}/manifest.json
pictures=tests/studies/pictures
export OPENBLAS_NUM_THREADS=1  # results repeat bit by bit
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if command -v chromium >/dev/null; then
  "$bin/pushid-simulate" --out="$work/recordings" --overwrite >/dev/null
  "$bin/pushid-fit" --recordings="$work/recordings/manifest.json" --model_out="$work/single.json" >/dev/null
  "$bin/pushid-report" --model="$work/single.json" --recordings="$work/recordings/manifest.json" \
    --html_out="$work/report.html" 2>/dev/null
  chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="$work/browser" \
    --window-size="1200,760" --screenshot="$pictures/report.png" "file://$work/report.html" 2>/dev/null
fi
python=/usr/bin/python3  # which Debian's matplotlib belongs to
if [ -f "$recordings" ] && [ -x "$bin/pushid-train-restoration" ] && $python -c "import matplotlib" 2>/dev/null; then
  id=row_2_07
  model=("--model=$work/row.json" "--recordings=$recordings" --quiet)
  "$bin/pushid-fit" --recordings="$recordings" --setting=groups --leave_out=$id --quiet \
    --model_out="$work/row.json" >/dev/null
  "$bin/pushid-train-restoration" "${model[@]}" --setting=groups --leave_out=$id --sees=neighbours --out="$work/restoration" >/dev/null
  "$bin/pushid-animate" "${model[@]}" --id=$id --restoration="$work/restoration" --out="$work/row.html" >/dev/null
  $python $pictures/draw_row.py "$work/row.html" $pictures/row.png
fi
