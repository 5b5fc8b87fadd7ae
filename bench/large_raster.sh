#!/usr/bin/env bash
# Pictures of a raster with many more samples than pixels, compared with averages by gdal_translate: see README.md.
# usage: large_raster.sh SCARP [SIDE [OUT.csv]]
set -euo pipefail

scarp=$(readlink -f -- "${1:?usage: large_raster.sh SCARP [SIDE [OUT.csv]]}")
side=${2:-16384}
out=$(readlink -m -- "${3:-/dev/stdout}")
picture=(--size 1280x720 --no-shadows --threads 0)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# Prints wall-clock and processor time in seconds, and peak memory in MB, of a command.
measured() {
  /usr/bin/time -o times -f '%e %U %S %M' "$@" >/dev/null 2>&1
  awk '{ printf "%.2f %.2f %d", $1, $2 + $3, $4 / 1024 }' times
}

"$scarp" generate --size 2048 --seed 1 --feature-size 512 -o small.tif >/dev/null 2>&1
{
  echo "# machine: $(sed -n '/^model name/{s/.*: //p;q}' /proc/cpuinfo), $(nproc) cores, Linux $(uname -r), $(gdalinfo --version)"
  echo "# command: large_raster.sh SCARP $side"
  echo "# date: $(date -u +%FT%TZ)"
  echo "type,layout,compression,side,decimated_side,scarp_s,scarp_cpu_s,scarp_mb,translate_s,translate_cpu_s,translate_mb,decimated_s,decimated_cpu_s,ratio,cpu_ratio"
  for type in Int16 Float32; do
    for layout in YES NO; do
      for compression in NONE DEFLATE; do
        gdal_translate -q -ot $type -r bilinear -outsize "$side" "$side" -co TILED=$layout -co COMPRESS=$compression \
          -co ZLEVEL=1 small.tif large.tif
        "$scarp" render large.tif -o a.png --size 16x9 2>note >/dev/null
        reduced=$(sed -n 's/.*rendered from \([0-9]*\) x.*/\1/p' note)
        cat large.tif >/dev/null
        read -r all all_cpu all_mb <<<"$(measured "$scarp" render large.tif -o a.png "${picture[@]}")"
        read -r peer peer_cpu peer_mb <<<"$(measured gdal_translate -q -r average -outsize "$reduced" "$reduced" large.tif few.tif)"
        read -r few few_cpu _ <<<"$(measured "$scarp" render few.tif -o b.png "${picture[@]}")"
        # Time of the reduction, relative to that of gdal_translate.
        awk -v OFS=, -v a="$all" -v p="$peer" -v f="$few" -v ac="$all_cpu" -v pc="$peer_cpu" -v fc="$few_cpu" -v head="$type,$([[ $layout == YES ]] && echo tiled || echo striped),${compression,,},$side,$reduced" \
          -v am="$all_mb" -v pm="$peer_mb" 'BEGIN { print head, a, ac, am, p, pc, pm, f, fc, sprintf("%.2f", (a - f) / p), sprintf("%.2f", (ac - fc) / pc) }'
        rm -f large.tif few.tif
      done
    done
  done
} >"$out"
