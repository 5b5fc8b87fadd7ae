#!/usr/bin/env bash
# Runs the commands of documents as they stand, in a temporary folder with the files that they name, and compares the
# steps per ray in the tables of techniques.md with the output.
#
#   - pictures without a size are small
#   - commands in blocks of sh, and in `code` if they have arguments; of names alone (`scarp viewshed`), the help
#   - options in the first column of a table (`--march naive`), added to the last command before it
#   - scarp-bench takes minutes: a command is accepted if it runs for half a second
#
# usage: commands.sh ROOT SCARP BENCH WORK PAGE...    BENCH may be '': its commands are then left out
set -euo pipefail

root=$1 scarp=$2 bench=$3 work=$4
shift 4
dem=$(sed -n 's/^demo_dem=//p' "$root/dev")
if [[ ! -f $dem ]]; then
  echo "skipped: $dem is not installed"
  exit 0
fi

rm -rf "$work"
mkdir -p "$work/bin"
cd "$work"
cat >bin/scarp <<TEXT
#!/bin/sh
case " \$* " in
  *" --size "* | *" --lowres "* | *" --help "* | *" comanche "*) ;;
  " render "*) set -- "\$@" --size 48x27 ;;
esac
exec "$scarp" "\$@"
TEXT
chmod +x bin/scarp
[[ -z $bench ]] || ln -s "$bench" bin/scarp-bench
export PATH="$work/bin:$PATH"
unset DISPLAY

# The files that commands name.
ln -s "$root/examples" examples
ln -s "$dem" "$(basename "$dem")"
awk '/^```csv/ {on = 1; next} /^```/ {if (on) exit} on' "$root/doc/user/cast.md" >rays.csv
scarp generate --size 129 -o dem.tif >/dev/null
ln -s examples/scenes/church.vox model.vox
ln -s examples/scenes/torus-at-sea.json scene.json
ln -s examples/meshes/balloons.obj tower.obj
cat >car.json <<'JSON'
{"elevations": {"from": 2, "to": -24.8, "count": 8}, "azimuths": {"count": 90}, "rate": 10, "range": [1, 120],
 "mounting": {"up": 1.7},
 "path": [{"time": 0, "at": [1900, 1900], "above": 0, "heading": 90}, {"time": 0.1, "at": [1910, 1900], "above": 0, "heading": 90}]}
JSON

# Prints "KIND<TAB>LINE<TAB>TEXT" for a page: `run` a command; `help` of a subcommand or of its option; `row` the options of a table row, its
# table's name and its steps per ray.
commands_of() {
  awk '
    function say(kind, text) { printf "%s\t%d\t%s\n", kind, NR, text }
    /^```/ { code = $0 == "```sh"; next }
    code {
      text = text $0
      if (sub(/\\$/, "", text)) next
      sub(/ +# .*/, "", text)
      sub(/^build\/demo\/bin\//, "", text)
      if (text ~ /^(scarp |[A-Z]+=)/) say("run", text)
      text = ""
      next
    }
    /^<!-- table / { table = $3; next }
    /^<!-- end/ { table = "" }
    {
      gsub(/\\\|/, "|")
      if (table != "" && match($0, /^\| `--[^`]*`/)) {
        cells = split($0, cell, / \| /)
        for (i = 2; i <= cells; ++i) if (cell[i] ~ /^[0-9.]+$/) break
        say("row", substr($0, 4, RLENGTH - 4) "\t" table "\t" cell[i])
        next
      }
      rest = $0
      while (match(rest, /`[^`]+`/)) {
        span = substr(rest, RSTART + 1, RLENGTH - 2)
        rest = substr(rest, RSTART + RLENGTH)
        if (span ~ /^scarp [a-z]+( --[a-z-]+)?$/) say("help", span)
        else if (span ~ /^scarp [a-z]+ / || span ~ /^scarp-bench [a-z]/) say("run", span)
      }
    }' "$1"
}

on_device=true
scarp devices 2>/dev/null | grep -q '^\*' || on_device=false
failures=0 count=0 started=0

fail() {
  echo "$1"
  sed 's/^/    /' said
  failures=$((failures + 1))
}

# run PLACE COMMAND
run() {
  local status=0
  count=$((count + 1))
  case $2 in
    *' --device '* | 'scarp-bench gpu'*) $on_device || return 0 ;;
    'scarp view'*) return 0 ;; # needs a display; window_test
  esac
  if [[ $2 == scarp-bench* ]]; then
    [[ -n $bench ]] || return 0
    timeout 0.5 bash -c "$2" >said 2>&1 || status=$?
    [[ $status -ne 124 ]] || status=0 started=$((started + 1))
  else
    eval "$2" >said 2>&1 </dev/null || status=$?
  fi
  [[ $status -eq 0 ]] || fail "$1: status $status: $2"
}

for page in "$@"; do
  last=''
  while IFS=$'\t' read -r kind line text table steps; do
    place=$page:$line
    case $kind in
      help)
        run "$place" "${text%% --*} --help all"
        [[ $text != *--* ]] || grep -q -e "${text##* }" said || fail "$place: $text: no such option"
        ;;
      run)
        [[ $text != scarp\ * ]] || last=$text
        run "$place" "$text"
        ;;
      row)
        run "$place" "$last $text --look steps"
        found=$(sed -n 's/^steps per ray: .*mean \([0-9.]*\).*/\1/p' said)
        [[ $found == "$steps" ]] || fail "$place: $text: the page says $steps steps per ray, not $found"
        ;;
    esac
  done < <(commands_of "$root/$page")
done
echo "$count commands, $failures failures; $started of scarp-bench ran for half a second and were not finished"
[[ $failures -eq 0 && $count -gt 40 ]]
