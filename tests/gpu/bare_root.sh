#!/usr/bin/env bash
# Shows that an archive needs no package: unpacks it in an empty root with only glibc, a shell and a few tools, and runs
# a command there, by default the whole bundle on the CPU:   tests/gpu/bare_root.sh [ARCHIVE [COMMAND]]
# Exits with 77, for skipped, if the archive is missing or this user may not change the root; with 1 if the command
# fails, whatever its status.
# shellcheck disable=SC2016
set -euo pipefail
here=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.." && pwd)
archive=${1:-$here/build/copse-gpu.tar.xz}
command=${2:-'/copse-gpu/run --device cpu --brief /tmp/out; status=$?; cat /tmp/out/results.md; exit $status'}
[ -f "$archive" ] || { echo "skipped: no $archive; tests/gpu/bundle makes build/copse-gpu.tar.xz"; exit 77; }
if ! unshare --mount chroot / true 2>/dev/null; then echo "skipped: this user may not change the root"; exit 77; fi
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
# In its own mount namespace, so that /proc, which tells the loader where a program is, goes with it.
bare() {
  unshare --mount bash -c 'mount -t proc proc "$0/proc" && chroot "$0" /bin/bash -c "$1"' "$root" "export PATH=/bin; $1"
}
mkdir -p "$root"/{bin,tmp,dev,proc,etc,usr}
ln -s bin "$root/sbin"
for tool in bash env cat uname head tail sed timeout mkdir ln readlink dirname basename date rm mv ls sort seq tr cut wc \
  ldd awk grep tar gzip nproc mktemp sleep; do
  cp -L "$(command -v "$tool")" "$root/bin/"
done
ln -s bash "$root/bin/sh"
ln -s ../bin "$root/usr/bin"
# What those tools need, and all of glibc, but none of Copse's own libraries.
{
  { ldd "$root"/bin/* 2>/dev/null || true; } | awk '$2 == "=>" && $3 ~ /^\// { print $3 } $1 ~ /^\/.*ld-linux/ { print $1 }'
  for name in libc.so.6 libm.so.6 libdl.so.2 libpthread.so.0 librt.so.1; do
    ldconfig -p | awk -v name="$name" '$1 == name && /x86-64/ && !found { print $NF; found = 1 }'
  done
} | sort -u | while read -r library; do
  mkdir -p "$root$(dirname "$library")"
  cp -L "$library" "$root$library"
done
tar -C "$root" -xf "$archive"
mknod -m 666 "$root/dev/null" c 1 3 2>/dev/null || : >"$root/dev/null"
ln -s /proc/self/fd "$root/dev/fd"
echo "in the bare root:"
bare 'ls / /lib/x86_64-linux-gnu'
bare "$command" || { echo "failed with status $?"; exit 1; }
