#!/usr/bin/env bash
# Completion scripts and man pages that `scarp options --share` writes: completion_test.sh SCARP WORK
# Shells that are not installed are skipped.
set -uo pipefail
scarp=$1 work=$2
rm -rf "$work"
mkdir -p "$work/in/tiles"
"$scarp" options --share "$work/share" || exit 1
touch "$work"/in/{dem.tif,rock.obj,'two words.glb',notes.txt}
cd "$work/in" || exit 1
failed=0

fail() {
  echo "$1" >&2
  failed=1
}

# expect WORDS EXPECTED: what bash offers for the last of the words, sorted.
source "$work/share/bash-completion/completions/scarp"
expect() {
  local -a COMPREPLY
  read -ra COMP_WORDS <<< "$1"
  if [[ $1 == *' ' ]]; then COMP_WORDS+=(''); fi
  COMP_CWORD=$(( ${#COMP_WORDS[@]} - 1 ))
  _scarp
  local got
  got=$(printf '%s\n' "${COMPREPLY[@]}" | sort | paste -sd ' ')
  if [[ $got != "$2" ]]; then fail "'$1': expected '$2', got '$got'"; fi
}
expect 'scarp ren' 'render'
expect 'scarp c' 'cast composite contours'
expect 'scarp render --look ' 'aspect comanche cost error height hillshade multidirectional shaded slope steps'
expect 'scarp render --look s' 'shaded slope steps'
expect 'scarp render --look = h' 'height hillshade'
expect 'scarp render --fog d' 'distance'
expect 'scarp render --march voxel-b' 'voxel-bricks'
expect 'scarp cast --march rel' 'relaxed'
expect 'scarp render --wat' '--water --water-colour'
expect 'scarp cast --wat' ''
expect 'scarp render --mesh ' 'rock.obj tiles two words.glb'
expect 'scarp render --ramp vir' 'viridis'
expect 'scarp render d' 'dem.tif'
expect 'scarp render --fov ' ''
expect 'scarp render --help wa' 'water'
expect 'scarp marches --' '--help --markdown --presets'

if command -v zsh > /dev/null; then zsh -n "$work/share/zsh/site-functions/_scarp" || fail "zsh: syntax"; fi
if command -v fish > /dev/null; then
  fish --no-execute "$work/share/fish/vendor_completions.d/scarp.fish" || fail "fish: syntax"
fi

for page in "$work"/share/man/man1/*.1; do
  name=$(basename "$page" .1)
  if command -v groff > /dev/null; then
    warnings=$(groff -man -ww -Tascii -P-cbu "$page" 2>&1 > "$work/page.txt")
    if [[ -n $warnings ]]; then fail "$name: $warnings"; fi
    grep -q '^NAME$' "$work/page.txt" || fail "$name: no NAME"
  fi
done
[[ -e $work/share/man/man1/scarp-render.1 ]] || fail 'no scarp-render.1'
grep -q -- '\\-\\-turbidity F' "$work/share/man/man1/scarp-render.1" || fail 'scarp-render.1: no --turbidity'
exit $failed
