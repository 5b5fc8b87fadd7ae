#!/usr/bin/env bash
# run.sh of ./dev gpu-bundle, in a bundle of stand-ins: a step that hangs or fails does not stop the others, and the
# table reports it.
# usage: bundle.sh ROOT WORK
set -euo pipefail

root=$1 work=$2
rm -rf "$work"
mkdir -p "$work/bundle/bin" "$work/bundle/lib/spare"
cp "$root/bench/bundle/run.sh" "$work/bundle"
cd "$work/bundle"
echo 1 >version.txt
cat >bin/scarp-bench <<'TEXT'
#!/bin/sh
case $1 in
  devices) printf '   device   type\n*  A (card)  discrete GPU\n' ;;
  functions) exit 1 ;;
  voxels) trap '' TERM; sleep 30 ;;
  *)
    for file; do :; done
    printf '# machine: m\n# command: %s\n# date: d\nsize,class,mode,mrays_per_s,max_mip_ratio\n' "$*" >"$file"
    printf '1025,chunk,max-mip,5100.4,1\n1025,chunk,naive-position,2550,2\n' >>"$file"
    ;;
esac
TEXT
printf '#!/bin/sh\necho "[ RUN      ] Drawing.Hangs"\nsleep 30\n' >bin/hangs
printf '#!/bin/sh\necho "[ RUN      ] Good.One"\necho "[       OK ] Good.One (1 ms)"\n' >bin/good
chmod +x bin/*
printf 'hangs_test hangs \ngood_test good good_test.cpp\n' >tests.txt

begin=$SECONDS
if ./run.sh --limit 1 "$work/out folder" >"$work/printed.txt" 2>&1; then
  echo "run.sh reports success"
  exit 1
fi
((SECONDS - begin < 25)) || { echo "took $((SECONDS - begin)) s"; exit 1; }
expect() {
  grep -qE -- "$1" "$2" || { echo "not in $2: $1"; cat "$2"; exit 1; }
}
summary="$work/out folder/summary.txt"
expect '^devices +ok +[0-9]+  A \(card\)' "$summary"
expect '^gpu-1025 +ok +[0-9]+  chunk 5100 Mrays/s, naive x 2.00$' "$summary"
expect '^voxels +ended after 1 s' "$summary"
expect '^functions +failed' "$summary"
expect '^hangs_test +ended after 1 s .*0 passed, 0 failed, 0 skipped; in Drawing.Hangs$' "$summary"
expect '^good_test +ok +[0-9]+  1 passed, 0 failed, 0 skipped$' "$summary"
csv=$(echo "$work/out folder"/*-gpu-1025-a-card.csv)
expect '^# command: gpu .* --csv FILE$' "$csv"
expect '^good_test,ok,1,0,0,' "$(echo "$work/out folder"/*-device-tests-a-card.csv)"
