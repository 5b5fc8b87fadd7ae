#!/usr/bin/env bash
# Measures and tests Scarp on a Vulkan device within 8 minutes. Every step has its own time limit.
# usage: run.sh [--device NAME] [--seconds N] [--limit N] [--small] [--only STEP,...] [FOLDER]
set -u

here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
usage() {
  cat <<'TEXT'
usage: run.sh [--device NAME] [--seconds N] [--limit N] [--small] [--only STEP,...] [FOLDER]

Writes DATE-STEP-DEVICE.csv of each benchmark and of the tests, summary.txt and logs/ to FOLDER (results).

  --device NAME     auto, gpu, cpu or part of a name (auto); the tests always take auto
  --seconds N       limit for everything, at least 30 (480)
  --limit N         limit for each step (20 to 90, by step)
  --small           small sizes, to check that everything runs
  --only STEP,...   only these steps: devices, gpu, voxels, render, functions, tests, or names of the summary
TEXT
}
wrong() {
  printf 'run.sh: %s (see run.sh --help)\n' "$1" >&2
  exit 2
}

device=auto seconds=480 limit=600 small='' only='' folder=''
while (($# > 0)); do
  case $1 in
    --help | -h) usage && exit ;;
    --small) small=yes ;;
    --device | --seconds | --limit | --only)
      (($# > 1)) || wrong "$1 needs a value"
      declare "${1#--}=$2"
      shift
      ;;
    -*) wrong "unknown option '$1'" ;;
    *)
      [[ -z $folder ]] || wrong "more than one folder: '$1'"
      folder=$1
      ;;
  esac
  shift
done
[[ $seconds =~ ^[1-9][0-9]{1,4}$ && $seconds -ge 30 ]] || wrong "--seconds '$seconds': expected a whole number of at least 30"
[[ $limit =~ ^[1-9][0-9]{0,4}$ ]] || wrong "--limit '$limit': expected a whole number of at least 1"
most=$limit
folder=${folder:-results}
mkdir -p "$folder/logs" || exit 1
folder=$(cd -- "$folder" && pwd)
cd "$here" || exit 1

now() { date +%s; }
started=$(now)
# Programs that do not end on a signal are abandoned after 10 more seconds.
deadline=$((started + seconds - 10))
# Leaves time for the tests.
bench_deadline=$((started + (seconds - 10) * 2 / 3))

export HOME="${HOME:-$folder/logs}" RC_PARAMS=seed=20261121
# The driver uses these libraries as well, so those of the bundle are used only if the system's are missing or too old.
use_libraries() { export LD_LIBRARY_PATH="$1${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"; }
if ldd bin/* 2>&1 | grep -q 'not found'; then use_libraries "$here/lib/spare"; fi
validation='without the validation layer'
if [[ -d layers ]]; then
  export VK_LAYER_PATH="$here/layers${VK_LAYER_PATH:+:$VK_LAYER_PATH}"
  validation='with the validation layer'
else
  export SCARP_TEST_VALIDATION=off
fi

# Keeps the lines that programs printed before they were ended.
by_lines=(env)
! stdbuf -oL true 2>/dev/null || by_lines=(stdbuf -oL)

summary=()
add_row() { summary+=("$(printf '%-24s %-18s %5s  %s' "$@")"); }

# step NAME LIMIT COMMAND...: runs the command in the remaining time, with its output in logs/NAME.log. Sets `result` and `took`.
step() {
  local name=$1 limit=$2 log="$folder/logs/$1.log" begin pid left
  shift 2
  begin=$(now)
  left=$((step_deadline - begin))
  took=0
  if ((left < 3)); then
    result='not run: no time'
    return
  fi
  ((limit <= left)) || limit=$left
  ((limit <= most)) || limit=$most
  printf '== %s (at most %d s)\n' "$name" "$limit"
  timeout --kill-after=5 "$limit" "${by_lines[@]}" "$@" >"$log" 2>&1 </dev/null &
  pid=$!
  result=''
  # Errors: bash reports processes that were killed.
  while kill -0 "$pid"; do
    if (($(now) > begin + limit + 10)); then
      result='cannot be ended'
      disown "$pid"
      break
    fi
    sleep 0.1
  done 2>/dev/null
  took=$(($(now) - begin))
  [[ -z $result ]] || return
  { wait "$pid"; } 2>/dev/null
  case $? in
    0) result=ok ;;
    124 | 137) result="ended after $limit s" ;;
    *) result=failed ;;
  esac
}

asked_for() { # NAME GROUP
  [[ -z $only || ,$only, == *,$1,* || ,$only, == *,$2,* ]]
}

# measure NAME GROUP LIMIT ARGUMENTS...: a command of scarp-bench, with its rows in DATE-NAME-DEVICE.csv.
measure() {
  local name=$1 group=$2 limit=$3 csv log="$folder/logs/$1.log" figures=''
  shift 3
  asked_for "$name" "$group" || return
  csv="$folder/$(date -u +%F)-$name-$card.csv"
  rm -f "$csv"
  step "$name" "$limit" bin/scarp-bench "$@" --csv "$csv"
  [[ $took == 0 && $result == not* ]] || cat "$log"
  if [[ -e $csv ]]; then
    sed -i '2s|--csv .*|--csv FILE|' "$csv"
    [[ $group != gpu ]] || figures=$(figures_of "$csv")
  elif [[ $result == failed ]]; then
    figures=$(tail -n 1 "$log")
  fi
  add_row "$name" "$result" "$took" "$figures"
}

# "chunk 5100 Mrays/s, naive x 2.1; primary ...": max-mip, and its speed relative to naive at equal position error.
figures_of() {
  awk -F, '$3 == "max-mip" {
      text = text (text == "" ? "" : "; ") $2 ($NF == 1 ? "" : " at exaggeration " $NF + 0)
      text = text sprintf($4 < 100 ? " %.3g Mrays/s" : " %.0f Mrays/s", $4)
    }
    $3 == "naive-position" { text = text sprintf(", naive x %.2f", $5) }
    END { print text }' "$1"
}

# test_program NAME LIMIT PROGRAM [FILES]: runs a test of ctest; skipped tests are counted separately.
test_program() {
  local name=$1 limit=$2 program=$3 files=${4:-} log="$folder/logs/$1.log" passed failed skipped last note
  asked_for "$name" tests || return
  step "$name" "$limit" env ${files:+"SCARP_TEST_FILES=$files"} GALLIVM_PERF=nopt "bin/$program" --gtest_color=no
  if [[ $result == not* ]]; then
    add_row "$name" "$result" 0 ''
    tests+=("$name,$result,,,,0")
    return
  fi
  passed=$(grep -c '^\[       OK \]' "$log")
  failed=$(grep -c '^\[  FAILED  \] .* ms)$' "$log")
  skipped=$(grep -c '^\[  SKIPPED \] .* ms)$' "$log")
  note="$passed passed, $failed failed, $skipped skipped"
  if [[ $result != ok ]]; then
    last=$(grep -E '^\[ RUN      \]|^\[       OK \]|^\[  FAILED  \]|^\[  SKIPPED \]' "$log" | tail -n 1)
    [[ $last != '[ RUN'* ]] || note+="; in ${last#*] }"
    ((failed == 0)) || note+="; $(grep '^\[  FAILED  \] .* ms)$' "$log" | head -n 3 | sed 's/^\[  FAILED  \] //; s/ (.*//' | paste -sd ' ')"
  fi
  add_row "$name" "$result" "$took" "$note"
  tests+=("$name,$result,$passed,$failed,$skipped,$took")
}

step_deadline=$bench_deadline
step devices 20 bin/scarp-bench devices --device "$device"
if grep -q 'Vulkan: no loader' "$folder/logs/devices.log"; then
  use_libraries "$here/lib/loader"
  step devices 20 bin/scarp-bench devices --device "$device"
fi
cat "$folder/logs/devices.log"
chosen=$(sed -n 's/^\*  *\(.*\)/\1/p' "$folder/logs/devices.log")
chosen=${chosen%%  *}
card=$(printf '%s' "${chosen:-none}" | tr '[:upper:]' '[:lower:]' | tr -cs 'a-z0-9\n' '-' | sed 's/^-*//; s/-*$//')
add_row devices "$result" "$took" "${chosen:-$(tail -n 1 "$folder/logs/devices.log")}"

classes=chunk,primary,shadow,ao
if [[ -z $small ]]; then
  # Fewer rays are judged than by default, 80,000 in the compared classes: the search must fit within the limits.
  measure gpu-1025 gpu 30 gpu --device "$device" --sizes 1025 --classes $classes --judged 5000
  measure gpu-4097 gpu 60 gpu --device "$device" --sizes 4097 --classes $classes --judged 5000
  measure gpu-4097-steep gpu 50 gpu --device "$device" --sizes 4097 --classes chunk,primary --exaggerations 4,16 --judged 5000 --repeats 3
  measure gpu-16385 gpu 90 gpu --device "$device" --sizes 16385 --classes $classes --judged 5000 --repeats 3
  measure voxels voxels 60 voxels --device "$device" --thousands 1,4,16
  measure render render 30 render --device "$device" --threads "$(nproc)" --cameras 2 --repeats 2
  measure functions functions 60 functions --device "$device" --width 320 --height 180 --repeats 1 --judged 200
else
  measure gpu-129 gpu 60 gpu --device "$device" --sizes 129 --classes $classes --rays small --judged 2000 --repeats 1
  measure voxels voxels 30 voxels --device "$device" --sets degenerate --thousands 1 --height 36 --repeats 1
  measure render render 30 render --device "$device" --period 64 --width 40 --height 30 --cameras 1 --repeats 1
  measure functions functions 90 functions --device "$device" --width 48 --height 27 --repeats 1 --judged 100
fi

tests=()
step_deadline=$deadline
while read -r name program files; do
  limit=30
  [[ $name != parity_vk_test ]] || limit=90
  test_program "$name" "$limit" "$program" "$files"
done <tests.txt
if ((${#tests[@]} > 0)); then
  {
    printf '# machine: "%s, %s cores, Linux %s"\n' "$(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1)" "$(nproc)" "$(uname -r)"
    printf '# command: run.sh, device tests %s on %s\n' "$validation" "${chosen:-none}"
    printf '# date: %s\ntest,result,passed,failed,skipped,seconds\n' "$(date -u +%FT%TZ)"
    printf '%s\n' "${tests[@]}"
  } >"$folder/$(date -u +%F)-device-tests-$card.csv"
fi

{
  printf '\n%s: Scarp %s, tests %s, %d s\n' "${chosen:-no device}" "$(cat version.txt)" "$validation" $(($(now) - started))
  printf '%-24s %-18s %5s  %s\n' step result s figures
  printf '%s\n' "${summary[@]}"
} | tee "$folder/summary.txt"
! grep -qE '^[a-z0-9_-]+ +(failed|ended|cannot|not run)' "$folder/summary.txt"
