#!/usr/bin/env bash
# Builds the example of one language and runs it: examples.sh ROOT LIBRARY_FOLDER WORK c|python|csharp|rust
set -euo pipefail
root=$1 folder=$2 work=$3 language=$4
source=$root/examples/c
expected="hit after 300.00 m in cell (29, 50)"

needs() {
  command -v "$1" >/dev/null && return
  echo "skipped: $1 is not installed (./dev lists its package)"
  exit 0
}

mkdir -p "$work"
cd "$work"
export LD_LIBRARY_PATH="$folder${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
case $language in
  c)
    needs cc
    cc -std=c11 -pedantic -Wall -Wextra -Werror -I "$root" "$source/hello.c" -o hello_c -L "$folder" -lscarp_c -lm
    run=(./hello_c)
    ;;
  python)
    needs python3
    run=(python3 "$source/hello.py" "$folder/libscarp_c.so")
    ;;
  csharp)
    needs mcs
    needs mono
    mcs -warnaserror -nowarn:0649,0169 -out:Hello.exe "$source/Hello.cs"
    run=(mono Hello.exe)
    ;;
  rust)
    needs rustc
    rustc -A dead_code -L "$folder" "$source/hello.rs" -o hello_rust
    run=(./hello_rust)
    ;;
esac
found=$("${run[@]}")
[[ $found == "$expected" ]] || { echo "found '$found', not '$expected'"; exit 1; }
echo "$found"
