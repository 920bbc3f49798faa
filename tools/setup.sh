#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing and builds. Usage: tools/setup.sh [PRESET [TARGET...]]
# `tools/setup.sh --packages` installs alone. EXTRA_PACKAGES names Debian packages beyond tools/packages.txt.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
# Clones share what they compile, wherever they lie.
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=true
[ $# -gt 0 ] && shift

read -ra extra <<< "${EXTRA_PACKAGES:-}"
mapfile -t packages < <(grep -v '^#' tools/packages.txt)
packages+=("${extra[@]}")
missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
# The page of reports is built with Node, which a machine may have from elsewhere than Debian.
command -v node > /dev/null || missing+=(nodejs)
command -v npm > /dev/null || missing+=(npm)
if [ ${#missing[@]} -gt 0 ]; then
  echo "Installing: ${missing[*]}" >&2
  as_root=()
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
fi

[ "$preset" = --packages ] && exit 0
modules=tools/viewer/node_modules/.package-lock.json
if [ ! -e "$modules" ] || [ tools/viewer/package-lock.json -nt "$modules" ]; then
  npm --prefix tools/viewer ci --ignore-scripts --no-audit --no-fund > /dev/null ||
    echo "No viewer page: npm could not fetch its packages; everything else goes on." >&2
  rm -f "build/$preset/build.ninja"  # configure again: the page can be built now
fi
[ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" >&2
if [ $# -gt 0 ]; then
  cmake --build --preset "$preset" --target "$@" >&2
else
  cmake --build --preset "$preset" >&2
fi
