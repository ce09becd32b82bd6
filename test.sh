#!/usr/bin/env bash
# Sets up (installs what is missing, builds) and runs every test; closes with ctest's summary.
# Arguments go to ctest, e.g. ./test.sh -L core or ./test.sh -R Closing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
./setup.sh --tests
exec ctest --test-dir build --output-on-failure -j "$(nproc)" "$@"
