#!/usr/bin/env bash
# Packs scarp-bench and the tests of Vulkan devices with the libraries they need, for machines that have only glibc and a Vulkan
# driver: ./dev gpu-bundle.
# usage: pack.sh BUILD OUT.tar.xz VERSION [--validation]
set -euo pipefail

build=$(readlink -f -- "${1:?usage: pack.sh BUILD OUT.tar.xz VERSION [--validation]}")
out=$(readlink -m -- "$2")
version=$3 validation=${4:-}
limit_mb=40
here=$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tree="$work/scarp-gpu"
mkdir -p "$tree"/{bin,lib/spare,lib/loader}

fail() {
  printf 'pack.sh: %s\n' "$1" >&2
  exit 1
}
# The file that the linker would load for this name.
system_library() { ldconfig -p | awk -v name="$1" '$1 == name && /x86-64/ && !found { found = $NF } END { print found }'; }

cp "$here/run.sh" "$tree/run.sh"
cp "$build/test/device_tests.txt" "$tree/tests.txt"
printf '%s\n' "$version" >"$tree/version.txt"
for program in scarp-bench $(cut -d ' ' -f 2 "$tree/tests.txt" | sort -u); do
  strip -o "$tree/bin/$program" "$build/bin/$program"
done

# Everything except glibc.
ldd "$tree"/bin/* | awk '/=> \// { print $1, $3 }' | sort -u | while read -r name path; do
  case $name in
    libc.so.* | libm.so.* | libdl.so.* | libpthread.so.* | librt.so.* | ld-linux*) ;;
    libstdc++.so.* | libgcc_s.so.* | libz.so.*) strip -o "$tree/lib/spare/$name" "$path" ;;
    *) strip -o "$tree/lib/$name" "$path" ;;
  esac
done
loader=$(PATH="$PATH:/sbin" system_library libvulkan.so.1)
[[ -n $loader ]] || fail "no Vulkan loader (Debian: libvulkan1)"
strip -o "$tree/lib/loader/libvulkan.so.1" "$loader"
if [[ $validation == --validation ]]; then
  layer=/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json
  [[ -e $layer ]] || fail "no validation layer (Debian: vulkan-validationlayers)"
  name=$(sed -n 's/.*"library_path": *"\(.*\)".*/\1/p' "$layer" | sed -n 1p)
  library=$name
  [[ $library == /* ]] || library=$(PATH="$PATH:/sbin" system_library "$name")
  [[ -n $library ]] || library=$(gcc -print-file-name="$name")
  mkdir "$tree/layers"
  strip -o "$tree/layers/${name##*/}" "$library"
  sed 's|"library_path": *".*"|"library_path": "./'"${name##*/}"'"|' "$layer" >"$tree/layers/${layer##*/}"
fi

glibc=$(find "$tree" -type f \( -path '*/bin/*' -o -name '*.so*' \) -exec readelf -VW {} + | grep -oE 'GLIBC_[0-9]+(\.[0-9]+)+' | sort -Vu | tail -n 1)
mkdir -p "$(dirname -- "$out")"
tar -C "$work" --owner=0 --group=0 -c scarp-gpu | xz -T0 -6 >"$out"
size=$(($(stat -c %s "$out") / 1000000 + 1))
((size <= limit_mb)) || fail "$out: $size MB, the limit is $limit_mb"
printf '== gpu-bundle: %s, %d MB, for x86-64 Linux with glibc %s and a Vulkan driver; unpack it and run scarp-gpu/run.sh\n' "$out" "$size" "${glibc#GLIBC_}"
