#!/usr/bin/env bash
# Checks the language of scarp::core and scarp::c as clang accepts it for Microsoft's compiler: msvc_syntax.sh ROOT BUILD,
# where BUILD is a build of test/windows. The headers of the system are those of mingw-w64, which test for g++; Scarp's
# sources are read without __GNUC__, and so take the paths of other compilers. Microsoft's headers and code generator
# are not part of this.
set -euo pipefail
root=$1 build=$2
gcc=$(dirname "$(x86_64-w64-mingw32-g++-posix -print-libgcc-file-name)")
work=$build/msvc_syntax
mkdir -p "$work"
cd "$root"
# As the build compiles them: several together, those with vectors alone.
mapfile -t sources < <(sed -n 's|^ *"file": "\(.*/scarp/.*\.c[px][px]\)",*$|\1|p' "$build/compile_commands.json" |
  grep -v -e '/examples/' -e '/test/')
{
  printf '%s\n' '#include <_mingw.h>' '#undef __MINGW_IMPORT' '#define __MINGW_IMPORT extern __declspec(dllimport)' \
    '#define __GLIBCXX_TYPE_INT_N_0 __int128' '#define __GLIBCXX_BITSIZE_INT_N_0 128'
  find scarp/base scarp/field scarp/accel scarp/march scarp/scene scarp/c \( -name '*.cpp' -o -name '*.h' \) -print0 |
    grep -z -v -e '_vk\.' -e '^scarp/scene/\(file\|mesh\)/' -e 'glsl' | xargs -0 grep -h '^#include <' |
    grep -v -e '<tbb/' -e '<sys/' -e '<unistd' -e '<fcntl' | sort -u
  echo '#undef __GNUC__'
} >"$work/system.h"
check() {
  clang++ --target=x86_64-pc-windows-msvc -fsyntax-only -std=c++20 -fms-compatibility-version=19.38 -fms-extensions \
    -fno-ms-compatibility -fgnuc-version=12.2 -nostdinc++ -nostdlibinc -w -isystem "$gcc/include/c++" \
    -isystem "$gcc/include/c++/x86_64-w64-mingw32" -isystem /usr/x86_64-w64-mingw32/include -isystem "$build/headers" -I. \
    -I"$build/scarp/include" -DFMT_HEADER_ONLY -DHWY_COMPILE_ONLY_STATIC -DSCARP_WITHOUT_TBB -DSCARP_C_BUILD \
    -include "$work/system.h" "$1"
}
# A check that finds nothing wrong in this checks nothing.
echo 'int number = "text";' >"$work/wrong.cpp"
if check "$work/wrong.cpp" 2>/dev/null; then
  echo "msvc_syntax.sh: the check accepts everything" >&2
  exit 1
fi
for source in "${sources[@]}"; do
  check "$source"
done
echo "msvc_syntax.sh: ${#sources[@]} files"
