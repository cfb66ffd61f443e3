#!/usr/bin/env bash
# script/check_rooms finds what it is there to find: one include planted in an otherwise empty house, again and again.
#
#   tests/house/rooms_test.sh ROOT
set -euo pipefail
root=$1
house=$(mktemp -d)
trap 'rm -rf "$house"' EXIT

wrong=0
plant() {  # yes or no: may it; file; its line
  local may=$1 file=$2 line=$3 says=yes
  rm -rf "${house:?}"/*
  mkdir -p "$house/src" "$house/$(dirname "$file")"
  touch "$house/$(dirname "$file")/own.h"
  echo "$line" > "$house/$file"
  "$root/script/check_rooms" "$house" > "$house/answer" || says=no
  if [[ $says != "$may" ]]; then
    echo "$file with $line: expected $may, got $says: $(cat "$house/answer")"
    wrong=$((wrong + 1))
  fi
}

plant yes src/math/a.h '#include <cmath>'
plant yes src/math/a.h '#include "math/vec.h"'
plant no src/math/a.h '#include "scene/scene.h"'
plant no src/math/a.h '#include "lambent/diagnostics.h"'
plant no src/math/a.h '#include <fmt/format.h>'
plant no src/math/a.h '#include <immintrin.h>'
plant no src/math/a.h '  #  include "lights/light.h"'
plant yes src/illumination/models/a.h '#include "illumination/model.h"'
plant no src/illumination/models/a.h '#include "model.h"'
plant no src/illumination/models/a.h '#include "../model.h"'
plant no src/illumination/models/a.h '#include "accel/world.h"'
plant yes src/illumination/models.h '#include "generated/illumination_models.h"'
plant no src/scene/scene.h '#include "generated/illumination_models.h"'
plant no src/lights/a.h '#include "illumination/model.h"'
plant yes src/scene/a.cpp '#include "lights/lights.h"'
plant no src/scene/a.cpp '#include <scenefile/load.h>'
plant yes src/accel/a.cpp '#include <embree4/rtcore.h>'
plant yes src/accel/a.cpp '#include "lambent/diagnostics.h"'
plant no src/accel/a.cpp '#include "lambent/lambent.h"'
plant no src/integrators/a.cpp '#include <embree4/rtcore.h>'
plant yes src/integrators/a.cpp '#include "film/film.h"'
plant no src/film/a.cpp '#include "integrators/frame.h"'
plant no src/image/a.cpp '#include "scene/scene.h"'
plant yes src/sheet/a.cpp '#include <stb_truetype.h>'
plant yes src/sheet/a.cpp '#include "lambent/sheet.h"'
plant no src/sheet/a.cpp '#include "image/srgb.h"'
plant no src/import/a.cpp '#include "scenefile/load.h"'
plant no src/nowhere/a.cpp '#include "math/vec.h"'
plant yes src/render.cpp '#include "integrators/kernels.h"'
plant no src/render.cpp '#include <embree3/rtcore.h>'
plant yes include/lambent/a.h '#include "lambent/image.h"'
plant no include/lambent/a.h '#include "scene/scene.h"'
plant no include/lambent/a.h '#include <fmt/format.h>'
plant yes apps/lambent/a.cpp '#include <CLI/CLI.hpp>'
plant yes apps/lambent/a.cpp '#include "own.h"'
plant no apps/lambent/a.cpp '#include "math/vec.h"'
plant no apps/lambent/a.cpp '#include "diagnostics.h"'
plant no examples/a.cpp '#include <scene/scene.h>'

((wrong == 0)) && echo "rooms_test: script/check_rooms answers as it should"
