#!/usr/bin/env bash
# Measures the window with elevation models on a virtual display (Xvfb), controlled by xdotool: see README.md.
# usage: view.sh SCARP [SIDES [OUT.csv]]
set -euo pipefail

scarp=$(readlink -f -- "${1:?usage: view.sh SCARP [SIDES [OUT.csv]]}")
sides=${2:-2049,4097,8193}
[[ -z ${3:-} ]] || exec >"$3"
folder=$(mktemp -d)
view_pid='' display_pid=''
trap 'kill $view_pid $display_pid 2>/dev/null || true; rm -rf "$folder"' EXIT
cd "$folder"
# User settings would change the window.
export XDG_CONFIG_HOME=$folder
times=times.csv

exec 3>display
Xvfb -displayfd 3 -screen 0 1280x720x24 -nolisten tcp 2>/dev/null &
display_pid=$!
until [[ -s display ]]; do sleep 0.05; done
export DISPLAY=:$(<display)

difference() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.3f", b - a }'; }
# Time of the first picture of a kind that was presented after a given time, for a generation above a given number.
presented() { # PASS_PATTERN AFTER ABOVE
  awk -F, -v pass="$1" -v after="$2" -v above="$3" \
    '$1 == "present" && $4 ~ pass && $2 > after && $3 > above { print $2; exit }' $times
}
# Waits for the converged picture of the current view.
until_converged() { # AFTER ABOVE
  until [[ -n "$(presented converged "$1" "$2")" ]]; do
    kill -0 $view_pid
    sleep 0.05
  done
  presented converged "$1" "$2"
}
# The last generation that was requested before the first event after a given time.
generation_at() { awk -F, -v after="$1" '$1 == "event" && $2 > after { print $3; exit }' $times; }
median_and_most() { sort -n | awk '{ all[NR] = $1 } END { printf "%.0f %.0f", 1000 * all[int((NR + 1) / 2)], 1000 * all[NR] }'; }
# Milliseconds from just before each event to the present that shows its effect. The events are lines "TIME" in `injected`.
latencies() {
  awk -F, 'NR == FNR { injected[++n] = $1; next }
    $1 == "event" { event_time[++e] = $2; event_generation[e] = $3 }
    $1 == "present" { present_time[++p] = $2; present_generation[p] = $3 }
    END {
      for (i = 1; i <= n; ++i) {
        for (j = 1; j <= e && event_time[j] < injected[i]; ++j) {}
        for (k = 1; k <= p && (present_time[k] < event_time[j] || present_generation[k] <= event_generation[j]); ++k) {}
        if (j <= e && k <= p) print present_time[k] - injected[i]
      }
    }' injected $times | median_and_most
}

{
  echo "# machine: $(sed -n '/^model name/{s/.*: //p;q}' /proc/cpuinfo), $(nproc) cores, Linux $(uname -r), load $(cut -d' ' -f1 /proc/loadavg)"
  echo "# command: view.sh SCARP $sides"
  echo "# date: $(date -u +%FT%TZ)"
  echo "side,first_s,first_rows,full_s,idle_percent,rest_ms,rest_most_ms,turn_ms,turn_most_ms,turn_fps,turn_rows,converged_s,render_s,same,mb"
  for side in ${sides//,/ }; do
    "$scarp" generate --size "$side" -o dem.tif >/dev/null 2>&1
    cat dem.tif >/dev/null
    rm -f $times
    begin=$EPOCHREALTIME
    "$scarp" view dem.tif --size 1280x720 --timings $times >commands 2>notes &
    view_pid=$!
    until [[ -e $times ]]; do sleep 0.02; done
    all=$(until_converged 0 0)
    first=$(presented . 0 0)
    first_rows=$(awk -F, '$1 == "present" { print $6; exit }' $times)
    full=$(presented 'full|converged' 0 0)

    # Idle: processor time in hundredths of a second, over five seconds.
    sleep 1
    ticks() { awk '{ print $14 + $15 }' /proc/$view_pid/stat; }
    before=$(ticks)
    sleep 5
    idle=$(awk -v t=$(($(ticks) - before)) -v per="$(getconf CLK_TCK)" 'BEGIN { printf "%.1f", 100 * t / per / 5 }')

    # Single moves, from rest. The first press and move may go to another window and are not counted.
    xdotool mousemove 900 400 sleep 0.2 mousedown 1 sleep 0.5
    : >injected
    for ((i = 0; i < 20; ++i)); do
      sleep 0.6
      echo "$EPOCHREALTIME" >>injected
      xdotool mousemove_relative -- $((i % 2 ? 7 : -5)) 1
    done
    sleep 1
    read -r rest rest_most <<<"$(latencies)"

    # Turning: a move every 16 ms for six seconds, of which the last five count.
    turn=()
    for ((i = 0; i < 380; ++i)); do turn+=(mousemove_relative -- $((i / 38 % 2 ? 4 : -4)) 0 sleep 0.016); done
    xdotool "${turn[@]}" &
    mover=$!
    sleep 1
    from=$EPOCHREALTIME
    : >injected
    for ((i = 0; i < 25; ++i)); do
      echo "$EPOCHREALTIME" >>injected
      sleep 0.2
    done
    to=$EPOCHREALTIME
    wait $mover
    sleep 0.5
    read -r fps rows <<<"$(awk -F, -v from="$from" -v to="$to" '$1 == "present" && $2 > from && $2 < to { print $6 }' $times |
      sort -n | awk -v s="$(difference "$from" "$to")" '{ all[NR] = $1 } END { printf "%.1f %d", NR / s, all[int((NR + 1) / 2)] }')"
    read -r turned turned_most <<<"$(latencies)"

    # The converged picture, compared with `scarp render` of the same view.
    moved=$EPOCHREALTIME
    xdotool mousemove_relative -- 40 10 mouseup 1
    until [[ -n "$(generation_at "$moved")" ]]; do sleep 0.02; done
    converged=$(difference "$moved" "$(until_converged "$moved" "$(generation_at "$moved")")")
    xdotool key c key p
    until [[ -s commands && -e scarp-view-1.png ]]; do sleep 0.1; done
    sleep 0.5
    mb=$(awk '/VmHWM/ { printf "%d", $2 / 1024 }' /proc/$view_pid/status)
    xdotool key Escape
    wait $view_pid
    view_pid=''
    command=$(sed -n 's/^scarp render/render/p' commands | sed -n 1p)
    before=$EPOCHREALTIME
    # shellcheck disable=SC2086
    "$scarp" $command >/dev/null 2>&1
    render=$(difference "$before" "$EPOCHREALTIME")
    same=$(cmp -s picture.png scarp-view-1.png && echo yes || echo no)
    rm -f scarp-view-1.png commands
    echo "$side,$(difference "$begin" "$first"),$first_rows,$(difference "$begin" "$full"),$idle,$rest,$rest_most,$turned,$turned_most,$fps,$rows,$converged,$render,$same,$mb"
  done
}
