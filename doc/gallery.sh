#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of doc/user by the commands there, in the current folder. Called by ./dev gallery and golden_test.
#
#   doc/gallery.sh SCARP DEM [quick]    SCARP: the program; DEM: the model of ./dev demo; quick: only pictures that take
#                                       no more than a few seconds
#
# Each command is a line of the page; lines that end in a backslash go on. Only those about the demo's model make pictures.
set -euo pipefail
program=$1 dem=$2 which=${3:-all}
root="$(dirname -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")")"
made=0
while IFS= read -r line; do
  line=${line#"${line%%[! ]*}"}
  [[ "$line" =~ ^scarp\ (render|viewshed|shadow|profile)\ jacksboro_fault_dem.npz\  ]] || continue
  subcommand=${BASH_REMATCH[1]}
  line=${line#"${BASH_REMATCH[0]}"}
  line=${line//..\/..\/examples/$root/examples}  # from doc/images
  [[ "$which" == all || ! "$line" =~ --samples|--look\ error|--contours ]] || continue
  # Commands in a loop over exaggerations.
  loop=('')
  [[ "$line" != *\$x* ]] || loop=(1 4 16)
  for x in "${loop[@]}"; do
    mapfile -t words < <(xargs -n 1 printf '%s\n' <<<"${line//\$x/$x}")  # knows quotes
    "$program" "$subcommand" "$dem" "${words[@]}"
    made=$((made + 1))
  done
done < <(sed -e ':join' -e '/\\$/{N;s/\\\n//;bjoin' -e '}' "$root"/doc/user/{comanche,meshes,naive,pictures,profile,shadow,viewshed}.md)
rm -f seen.tif shadow.tif  # which viewshed.png and shadow.png show
((made > 0))  # otherwise no page has such a command any more
