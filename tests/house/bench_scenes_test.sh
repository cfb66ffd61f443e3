#!/usr/bin/env bash
# The scenes of the benchmark can be made on a machine that has none yet, and are without fault.
#
#   tests/house/bench_scenes_test.sh ROOT LAMBENT
set -euo pipefail
root=$1 lambent=$2
if ! command -v python3 >/dev/null; then
  echo "there is no python3: script/bootstrap --bench installs it"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

PYTHONDONTWRITEBYTECODE=1 python3 "$root/bench/make_scenes.py" "$folder" --compared 1000 --triangles 2000 --lights 3 --peers
for scene in "$folder"/*.yaml; do "$lambent" check "$scene"; done
"$lambent" info "$folder/big.obj" >/dev/null
