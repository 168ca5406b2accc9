#!/usr/bin/env bash
# tests/gpu/bundle --programs: what it packs of existing programs, and what it refuses.   tests/gpu/bundle_test.sh
# shellcheck disable=SC2317
set -uo pipefail
here=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
check() {  # WHAT COMMAND...
  local what=$1
  shift
  "$@" >"$work/check.txt" 2>&1 || { echo "not so: $what"; sed 's/^/    /' "$work/check.txt" | head -n 20; failed=1; }
}
refuses() {  # MESSAGE OPTION...
  local message=$1
  shift
  ! "$here/bundle" "$@" --programs "$work/programs" -o "$work/x.tar.xz" >"$work/out.txt" 2>&1 &&
    grep -q "$message" "$work/out.txt"
}

mkdir "$work/programs" "$work/tar" "$work/python"
echo "a note" >"$work/programs/note.txt"
check "there has to be the program" refuses 'no program copse'
unset COPSE_SCENES
cp "$(type -P true)" "$work/programs/copse"
cp "$(type -P ls)" "$work/programs/gpu_same"  # Which asks the machine for a library that is not glibc's.
! ldd "$work/programs/gpu_same" | grep -q libselinux || check "a library of this machine alone" refuses 'outside the bundle'
cp "$(type -P true)" "$work/programs/gpu_same"
check "it packs them" "$here/bundle" --programs "$work/programs" -o "$work/x.tar.xz"
mv "$work/check.txt" "$work/said.txt"
check "it says how much" grep -qE 'x.tar.xz: [0-9]+\.[0-9] MiB, glibc 2\.[0-9]+ and newer, 2 programs, 0 libraries, commit ' "$work/said.txt"
check "tar unpacks it" tar -C "$work/tar" -xJf "$work/x.tar.xz"
! command -v python3 >/dev/null ||
  check "Python unpacks it" env -C "$work/python" python3 -c 'import sys, tarfile; tarfile.open(sys.argv[1]).extractall()' "$work/x.tar.xz"
for folder in tar python; do
  [ -d "$work/$folder/copse-gpu" ] || continue
  check "the programs alone ($folder)" [ "$(cd "$work/$folder/copse-gpu/bin" && echo ./*)" = "./copse ./gpu_same" ]
  check "they run ($folder)" "$work/$folder/copse-gpu/bin/copse"
  # Everything the runner reads, and none of its tests.
  for file in run hot_kernels steps.sh parts.sh results.sh least.csv brief.toml brief_variants.toml \
    clocks.awk configs/gpu.toml configs/gpu-variants.toml configs/gpu-short.toml scenes/atrium.toml tests/data commit test_root; do
    check "$file ($folder)" [ -e "$work/$folder/copse-gpu/$file" ]
  done
  check "no test of the runner ($folder)" [ ! -e "$work/$folder/copse-gpu/run_test.sh" ]
  check "the runner runs ($folder)" [ "$("$work/$folder/copse-gpu/run" --wrong >/dev/null 2>&1; echo $?)" = 2 ]
done
check "it refuses what is too large" refuses 'over 0 MiB' --most 0
exit $failed
