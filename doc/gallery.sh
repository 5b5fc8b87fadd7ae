#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of doc/user by the commands there, in the current folder. Called by ./dev gallery and golden_test.
#
#   doc/gallery.sh SCARP DEM [quick]    SCARP: the program; DEM: the model of ./dev demo; quick: only pictures that take
#                                       no more than a few seconds
#
# Each command is a line of the page; lines that end in a backslash go on. Only those about the demo's model make pictures.
# Of the pages on the founding texts, every command runs, in a scratch folder.
set -euo pipefail
program=$1 dem=$2 which=${3:-all}
root="$(dirname -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")")"
# The pages on the founding texts.
founding=(naive relaxed voxel-marches semi-voxel from-height-to-distance)
made=0

# Whether a command is quick enough, or all are wanted.
wanted() { [[ "$which" == all || ! "$*" =~ --samples|--look\ error|--contours ]]; }

while IFS= read -r line; do
  line=${line#"${line%%[! ]*}"}
  [[ "$line" =~ ^scarp\ (render|viewshed|shadow|horizon|skyview|sunhours|profile)\ jacksboro_fault_dem.npz\  ]] || continue
  subcommand=${BASH_REMATCH[1]}
  line=${line#"${BASH_REMATCH[0]}"}
  line=${line//..\/..\/examples/$root/examples}  # from doc/images
  wanted "$line" || continue
  mapfile -t words < <(xargs -n 1 printf '%s\n' <<<"$line")  # knows quotes
  "$program" "$subcommand" "$dem" "${words[@]}"
  made=$((made + 1))
done < <(sed -e ':join' -e '/\\$/{N;s/\\\n//;bjoin' -e '}' "$root"/doc/user/{comanche,horizon,meshes,pictures,profile,shadow,viewshed}.md)
rm -f seen.tif shadow.tif sky.tif sun.tif  # which viewshed.png, shadow.png, skyview.png and sunhours.png show
((made > 0))  # otherwise no page has such a command any more

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
ln -s "$dem" "$scratch/jacksboro_fault_dem.npz"
ln -s "$root/examples" "$scratch/examples"
scarp() { ! wanted "$*" || "$program" "$@"; }
for page in "${founding[@]}"; do
  text=$(sed -n '/^```sh$/,/^```$/{/^```/!p}' "$root/doc/user/$page.md")
  [[ -n "$text" ]]
  (cd "$scratch" && eval "$text")
done
mv "$scratch"/*.png "$scratch"/*.svg .
