#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Renders the pictures of doc/user/techniques.md and fills in its tables, which are between "<!-- table NAME -->" and
# "<!-- end -->". Called by ./dev gallery.
#
#   doc/techniques.sh SCARP DEM        SCARP: the program; DEM: the model of ./dev demo
set -euo pipefail
scarp=$1 dem=$2
root=$(cd "$(dirname "$0")/.." && pwd)
page=$root/doc/user/techniques.md
images=$root/doc/images
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
small=288x180 large=480x300

# Prints the time in seconds to render a large picture of heights (camera rays only): the fastest of three runs.
seconds() {
  local i
  for i in 1 2 3; do
    "$scarp" render "$@" --look height --size $large -o "$scratch/large.png" | sed -n 's/.* render \([0-9.]*\) s.*/\1/p'
  done | sort -n | sed -n 1p
}

# row TABLE NAME RANGE OPTIONS...: prints a table row. Reads `field` (input options) and `judged` (whether to render
# errors).
row() {
  local file=techniques-$1-$2 range=$3 steps pictures counts=''
  shift 3
  "$scarp" render "${field[@]}" "$@" --size $small -o "$images/$file.png" >/dev/null
  steps=$("$scarp" render "${field[@]}" "$@" --size $small --look steps --steps-range "$range" \
    -o "$images/$file-steps.png" | sed -n 's/steps per ray: .*mean \([0-9.]*\).*/\1/p')
  pictures="![](../images/$file.png) | ![](../images/$file-steps.png)"
  if $judged; then
    "$scarp" render "${field[@]}" "$@" --size $small --look error -o "$images/$file-error.png" >"$scratch/errors"
    count() { awk -v what="$1" '$0 ~ "^  " what {for (i = 1; i <= NF; ++i) if ($i ~ /^[0-9]+$/) {print $i; exit}}' "$scratch/errors"; }
    pictures="$pictures | ![](../images/$file-error.png)"
    counts=" | $(count lost) | $(count late) | $(count early) | $(count 'gave up')"
  fi
  echo "| \`${*}\` | $pictures | $steps | $(seconds "${field[@]}" "$@") s$counts |"
}

# Replaces the rows of a table on the page; keeps its two header lines.
fill() {
  awk -v table="$1" -v rows="$scratch/rows" '
    $0 == "<!-- table " table " -->" { print; getline; print; getline; print; while ((getline line < rows) > 0) print line; skip = 1; next }
    $0 == "<!-- end -->" { skip = 0 }
    !skip { print }' "$page" >"$scratch/page"
  cp "$scratch/page" "$page"
}

judged=true
"$scarp" render "$dem" --crs EPSG:4326 --bounds=-84.41375,36.44625,-84.0779166667,36.7329166667 --exaggeration 4 \
  --view 195,40,0.7 --no-plinth --size 400x180 --compare naive,max-mip -o "$images/techniques-compare.png" >/dev/null
field=("$dem" --crs EPSG:4326 --bounds=-84.41375,36.44625,-84.0779166667,36.7329166667 --exaggeration 4 --view 195,40 --no-plinth)
{
  row heights naive 0,100 --march naive
  row heights naive-fine 0,100 --march naive --naive-min-step 0.00005 --naive-tolerance 0 --naive-max-steps 20000 --refine bisect
  row heights fixed-step 0,100 --march fixed-step
  row heights relaxed 0,100 --march relaxed
  row heights lipschitz 0,100 --march lipschitz
  row heights max-mip-bisect 0,100 --march max-mip-bisect
  row heights max-mip 0,100 --march max-mip
} >"$scratch/rows"
fill heights

field=(--function ridges --view 250,22,0.8)
small=192x120 large=192x120  # heights of functions take long
{
  row functions castle 0,300 --preset castle
  row functions elevated 0,300 --preset elevated
  row functions shrink 0,300 --march lipschitz --shrink 0.5
  row functions lipschitz 0,300 --march lipschitz
  row functions lipschitz-local 0,300 --march lipschitz-local
} >"$scratch/rows"
fill functions

judged=false small=288x180 large=480x300
field=("$root/examples/scenes/church.vox" --view 215,25)
{
  for march in planes spheres cubes octants bricks; do row voxels $march 0,40 --march voxel-$march; done
} >"$scratch/rows"
fill voxels
