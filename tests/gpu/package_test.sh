#!/usr/bin/env bash
# Tests `cpack` of a build folder: the archive's program runs where it is unpacked and, if this user may change the
# root, in an empty one.   tests/gpu/package_test.sh BUILD WORK
set -euo pipefail
here=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd)
build=$1 work=$2
rm -rf "$work" && mkdir -p "$work/elsewhere"
cpack --config "$build/CPackConfig.cmake" -B "$work" >"$work/cpack.log" 2>&1 || { tail -n 20 "$work/cpack.log"; exit 1; }
archives=("$work"/copse-*.tar.gz)
[ -f "${archives[0]}" ] || { echo "no archive:"; cat "$work/cpack.log"; exit 1; }
folder=$(basename "${archives[0]}" .tar.gz)
tar -C "$work/elsewhere" -xzf "${archives[0]}"
# PREFIX is where it was unpacked.
in_it="PREFIX/bin/copse list builders && cd TMP && PREFIX/bin/copse generate cornell -o box.obj &&
  PREFIX/bin/copse build box.obj --builder kmeans-q2 --device cpu &&
  PREFIX/bin/copse render PREFIX/share/copse/scenes/cornell.toml --size 64x48 --spp 1 --device cpu -o x.exr"
mkdir "$work/tmp"
there=${in_it//PREFIX/$work/elsewhere/$folder}
env -i PATH=/bin:/usr/bin bash -c "${there//TMP/$work/tmp}"
outside=$(env -u LD_LIBRARY_PATH ldd "$work/elsewhere/$folder/bin/copse" | awk '/not found/ && $1 !~ /^libcuda\.so/')
[ -z "$outside" ] || { echo "not found: $outside"; exit 1; }
status=0
there=${in_it//PREFIX//$folder}
bash "$here/bare_root.sh" "${archives[0]}" "${there//TMP//tmp}" || status=$?
[ $status != 77 ] || { echo "left out: the empty root"; status=0; }
exit $status
