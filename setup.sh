#!/usr/bin/env bash
# Installs what is missing (Debian 12, by apt), configures and builds into build/. Used by demo.sh and
# test.sh; safe to run again. Options: --tests also builds the tests.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

packages=(
  g++ cmake ninja-build pkg-config git clang-format
  # ParaView with its VTK, its Python, and what its CMake files look for
  paraview paraview-dev python3-paraview python3-dev python3-numpy
  qtbase5-dev libqt5svg5-dev qttools5-dev qttools5-dev-tools qhelpgenerator-qt5 qtxmlpatterns5-dev-tools
  libqt5opengl5-dev libutfcpp-dev libogg-dev libtheora-dev libavcodec-dev libavformat-dev libavutil-dev
  libswscale-dev libopenmpi-dev openmpi-bin libgl2ps-dev libglew-dev libgdal-dev libnetcdf-dev liblz4-dev liblzma-dev
  libdouble-conversion-dev libhdf5-openmpi-dev libxcursor-dev
  # the project's own libraries (see CONTRIBUTING.md)
  libeigen3-dev libtbb-dev libspectra-dev libnanoflann-dev libocct-data-exchange-dev
  # tests and pictures
  libgtest-dev xvfb xauth imagemagick gmsh
)

install_missing()
{
  local missing=()
  for p in "${packages[@]}"; do
    dpkg-query -W -f='${Status}' "$p" 2>/dev/null | grep -q '^install ok installed' || missing+=("$p")
  done
  if ((${#missing[@]} == 0)); then
    return
  fi
  echo "== Installing: ${missing[*]}"
  local run=()
  if ((EUID != 0)); then
    run=(sudo)
  fi
  "${run[@]}" apt-get update -qq
  "${run[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

tests=OFF
if [[ "${1:-}" == "--tests" ]]; then
  tests=ON
fi
install_missing
echo "== Building into build/"
cmake --preset default -DBSR_BUILD_TESTING="$tests" >build-configure.log 2>&1 || {
  tail -n 40 build-configure.log >&2
  exit 1
}
mv build-configure.log build/configure.log
cmake --build build
