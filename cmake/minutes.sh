#!/usr/bin/env bash
# Where the minutes of a run of ./dev test went: steps, files that took longest to compile, tests that took longest to run.
#   cmake/minutes.sh BUILD_FOLDER
# BUILD_FOLDER/minutes.txt has a line "SECONDS<tab>STEP" for each step; ninja and ctest keep the other figures.
set -euo pipefail
build=$1

echo "== where the minutes went"
awk -F'\t' '{ printf "%4d:%02d  %s\n", $1 / 60, $1 % 60, $2 }' "$build/minutes.txt"

# Figures of this run alone: what ninja and ctest wrote before it is older than the first step.
recent() { [[ "$1" -nt "$build/run-began" ]]; }

echo "== slowest files (wall seconds)"
for preset in clone/build/demo release dev tsan; do
  log="$build/$preset/.ninja_log"
  [[ -f "$log" ]] && recent "$log" || continue
  # start, end, time stamp, output: of each output the last line counts.
  awk -F'\t' -v preset="${preset##*/}" 'NR > 1 && $4 ~ /\.o$/ { took[$4] = ($2 - $1) / 1000 }
    END { for (file in took) printf "%7.1f  %s: %s\n", took[file], preset, file }' "$log"
done | sort -rn | sed -n -e '11,$ d' -e 's|CMakeFiles/||' -e 's|\.dir/|: |' -e 's|\.cxx\.o$||' -e 's|\.o$||'

echo "== slowest tests (wall seconds)"
for preset in release dev tsan; do
  log="$build/$preset/Testing/Temporary/LastTest.log"
  [[ -f "$log" ]] && recent "$log" || continue
  awk -v preset="$preset" '/^[0-9]+\/[0-9]+ Testing: / { name = $3 } /^Test time = / { printf "%7.1f  %s: %s\n", $4, preset, name }' "$log"
done | sort -rn | sed -n '1,10 p'
