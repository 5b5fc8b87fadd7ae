#!/usr/bin/env bash
# Compares the table of naive marching in bench/README.md with the recorded results that it names.
#
# usage: naive_table.sh ROOT
set -euo pipefail

readme=$1/bench/README.md results=$1/bench/results
failures=0 count=0

# row CSV COLUMN: "3.9 / 4.2 / 4.4 | ...", the ratio of the mode naive-position at each exaggeration, by class
row() {
  awk -F, -v column="$2" '
    /^#/ { next }
    !head { for (i = 1; i <= NF; ++i) at[$i] = i; head = 1; next }
    $at["mode"] == "naive-position" {
      class = $at["class"]
      before = class in text ? text[class] " / " : ""
      text[class] = before sprintf("%.1f", $at[column])
    }
    END { printf "%s | %s | %s | %s |\n", text["primary"], text["shadow"], text["chunk"], text["grazing"] }' "$1"
}

for file in $(grep -o '`[0-9-]*-naive-[0-9]*`' "$readme" | tr -d '`' | sort -u); do
  samples=${file##*-}
  for rays in 'single rays' batches; do
    column=max_mip_ratio
    [[ $rays == batches ]] && column=max_mip_simd_ratio
    wanted="| $samples^2 | $rays | $(row "$results/$file.csv" $column)"
    count=$((count + 1))
    if ! grep -qF -- "$wanted" "$readme"; then
      echo "bench/README.md lacks '$wanted'"
      failures=$((failures + 1))
    fi
  done
done
echo "$count rows, $failures failures"
[[ $failures -eq 0 && $count -gt 0 ]]
