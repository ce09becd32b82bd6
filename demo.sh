#!/usr/bin/env bash
# From a CT volume to a STEP file: ./demo.sh [VOLUME [ISO]] writes out/ (model, report, pictures) and prints a
# summary. Without arguments a digital fiber is made and reconstructed. VOLUME: any image ParaView reads.
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
  pvpython Examples/fiber.py --plugin build/lib/BSplineReconstruction/BSplineReconstruction.so --output out "${args[@]}"
