#!/usr/bin/env bash
# From data to a STEP file: ./demo.sh [FILE [OPTIONS]] writes out/ (model, report, pictures) and prints a summary.
# FILE is a CT volume (then an iso value may follow), a scan or polylines; without it a digital fiber is made and
# reconstructed. Options are those of Examples/fiber.py, scan.py and femur.py.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
args=()
if (($# >= 1)); then
  args+=("$(realpath "$1")")
fi
args+=("${@:2}")
"$here/setup.sh"
cd "$here"
exec xvfb-run -a -s "-screen 0 1400x1000x24 -noreset" \
  pvpython Examples/demo.py "${args[@]}" \
  --plugin build/lib/BSplineReconstruction/BSplineReconstruction.so --output out
