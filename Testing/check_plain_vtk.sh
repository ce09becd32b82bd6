#!/usr/bin/env bash
# Builds the filters against the distribution's plain VTK (without ParaView) and runs the tests of
# Core and Filters. Not part of continuous integration: it takes a full build.
#
#   Testing/check_plain_vtk.sh [work folder, default build-plain-vtk]
#
# Debian's libvtk9-dev cannot be installed beside python3-paraview, so its packages are downloaded
# and extracted into the work folder; nothing is installed. Run ./setup.sh first for everything else.
set -euo pipefail
source_dir="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
work="$(realpath -m "${1:-$source_dir/build-plain-vtk}")"
mkdir -p "$work/packages"

if ! compgen -G "$work/prefix/usr/lib/*/cmake/vtk-*" >/dev/null; then
  # python3-vtk9, vtk9 and libvtk9-java only because VTK's CMake files insist on their presence.
  (cd "$work/packages" && apt-get download libvtk9-dev libvtk9.1 python3-vtk9 vtk9 libvtk9-java)
  for package in "$work"/packages/*.deb; do
    dpkg -x "$package" "$work/prefix"
  done
fi
vtk_dir="$(compgen -G "$work/prefix/usr/lib/*/cmake/vtk-*" | head -n 1)"
# VTK's libraries look for each other in the system's folders only.
export LD_LIBRARY_PATH="$(dirname "$(dirname "$vtk_dir")")${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"

cmake -S "$source_dir" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DBSR_BUILD_PLUGIN=OFF -DBSR_WRAP_PYTHON=OFF "-DVTK_DIR=$vtk_dir"
cmake --build "$work/build"
ctest --test-dir "$work/build" --output-on-failure -j "$(nproc)" -L "core|filters"
