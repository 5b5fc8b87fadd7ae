#!/bin/sh
# Computes a map in parts by a SLURM job array, and merges the parts when all of them have ended:
#
#   examples/slurm/map_parts.sh 16 shadow.tif shadow country.vrt --sun 135,20
#
# 16 parts, the output, then a subcommand of scarp with its input and options. Parts are written beside the output, on a
# disk that all nodes reach. Options of sbatch for the parts: SBATCH_PARTITION, SBATCH_TIMELIMIT and others in the
# environment. A part that is killed or requeued goes on where it stopped (--resume).
set -eu

case ${1:-} in
  --part)
    output=$2
    shift 2
    exec "${SCARP:-scarp}" "$@" --part auto --resume -o "$output.part-$SLURM_ARRAY_TASK_ID.tif"
    ;;
  --merge)
    output=$2 parts=$3
    shift 3
    for part in $(seq "$parts"); do set -- "$@" "$output.part-$part.tif"; done
    "${SCARP:-scarp}" merge "$@" -o "$output"
    rm "$@"
    ;;
  *)
    if [ $# -lt 4 ] || ! [ "$1" -ge 1 ] 2>/dev/null; then
      echo "usage: $0 PARTS OUTPUT.tif SUBCOMMAND INPUT [OPTIONS]" >&2
      exit 2
    fi
    parts=$1 output=$2
    shift 2
    job=$(sbatch --parsable --job-name=scarp-part --array="1-$parts" --requeue "$0" --part "$output" "$@")
    sbatch --parsable --job-name=scarp-merge --dependency="afterok:${job%%;*}" --kill-on-invalid-dep=yes "$0" \
      --merge "$output" "$parts"
    ;;
esac
