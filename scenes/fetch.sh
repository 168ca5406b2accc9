#!/usr/bin/env bash
# Brings the scenes of the paper as their makers publish them into a folder for COPSE_SCENES.
#   scenes/fetch.sh --list                          what there is, from where, how large, under which terms; no network
#   scenes/fetch.sh --accept FOLDER [SCENE...]      fetches these, or all; --accept: you have read the terms and agree
# A download that broke off goes on where it stopped. Archives are checked by size and SHA-256, meshes by their number of
# triangles where copse is built. Nothing stands under its own name before it is whole and checked.
set -euo pipefail

here=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd)
table=$here/originals.txt
accept=no list=no keep=no folder='' wanted=()

say() { printf '%s\n' "$*"; }
warn() { printf 'warning: %s\n' "$*" >&2; }
die() { printf 'error: %s\n' "$*" >&2; exit 2; }

usage() {
  say "usage: fetch.sh --list [--table FILE]"
  say "       fetch.sh [--accept] [--keep] [--table FILE] FOLDER [SCENE...]"
  say ""
  say "  --list    what there is: size, triangles, terms, address"
  say "  --accept  you have read the terms and agree; without it you are asked, scene by scene"
  say "  --keep    keeps the archives in FOLDER/.fetch"
  say "  --table   another list in the format of originals.txt: a mirror, or meshes of your own"
}

while [ $# -gt 0 ]; do
  case $1 in
    --list) list=yes ;;
    --accept) accept=yes ;;
    --keep) keep=yes ;;
    --table) [ $# -gt 1 ] || die "--table needs a file"; table=$2; shift ;;
    -h|--help) usage; exit 0 ;;
    -*) usage >&2; die "there is no option '$1'" ;;
    *) if [ -z "$folder" ]; then folder=$1; else wanted+=("$1"); fi ;;
  esac
  shift
done

[ -r "$table" ] || die "$table: cannot be read"
names=() urls=() sizes=() sums=() meshes=() counts=() terms=() makers=()
while IFS='|' read -r name url size sum mesh count term maker; do
  case $name in ''|'#'*) continue ;; esac
  [ -n "$maker" ] || die "$table: '$name' has not all eight columns"
  [[ $name =~ ^[A-Za-z0-9][A-Za-z0-9._-]*$ && $mesh != /* && $mesh != *..* ]] || die "$table: '$name' is no name for a folder, or '$mesh' no file in an archive"
  names+=("$name") urls+=("$url") sizes+=("$size") sums+=("$sum") meshes+=("$mesh") counts+=("$count") terms+=("$term") makers+=("$maker")
done <"$table"

megabytes() { if [ "$1" = - ]; then printf 'unknown size'; else printf '%d.%d MB' $(($1 / 1000000)) $(($1 / 100000 % 10)); fi; }

describe() {  # INDEX
  say "${names[$1]}: ${counts[$1]} triangles, $(megabytes "${sizes[$1]}"), by ${makers[$1]}"
  say "    terms: ${terms[$1]}"
  say "    ${urls[$1]}"
  if [ "${sums[$1]}" = - ]; then say "    SHA-256 not known: the first download is trusted"; else say "    SHA-256 ${sums[$1]}"; fi
}

if [ "$list" = yes ]; then
  for i in "${!names[@]}"; do describe "$i"; done
  exit 0
fi
[ -n "$folder" ] || { usage >&2; die "no folder is given"; }

chosen=()
for name in "${wanted[@]}"; do
  found=no
  for i in "${!names[@]}"; do [ "${names[$i]}" != "$name" ] || { chosen+=("$i"); found=yes; }; done
  [ $found = yes ] || die "there is no scene '$name': ${names[*]}"
done
[ ${#chosen[@]} -gt 0 ] || chosen=("${!names[@]}")

command -v curl >/dev/null || command -v wget >/dev/null || die "curl or wget is needed"
command -v sha256sum >/dev/null || command -v shasum >/dev/null || die "sha256sum or shasum is needed"
mkdir -p "$folder" || die "$folder: cannot be made"
folder=$(cd "$folder" && pwd)
work=$folder/.fetch
lock=$folder/fetch.lock
mkdir -p "$work"

sha256() { if command -v sha256sum >/dev/null; then sha256sum "$1"; else shasum -a 256 "$1"; fi | cut -d' ' -f1; }

copse() {  # The program, where one is built or installed: COPSE_PROGRAM, beside this script, in PATH.
  local one
  for one in "${COPSE_PROGRAM:-}" "$here/../build/default/bin/copse" "$here/../build/cpu/bin/copse" "$(command -v copse || true)"; do
    if [ -n "$one" ] && [ -x "$one" ]; then printf '%s' "$one"; return; fi
  done
}

download() {  # URL FILE.part: goes on where FILE.part ends
  if command -v curl >/dev/null; then
    curl --fail --location --retry 2 --connect-timeout 30 --no-progress-meter --continue-at - --output "$2" "$1"
  else
    wget --no-verbose --tries=3 --timeout=30 --continue --output-document="$2" "$1"
  fi
}

check() {  # NAME URL FILE SIZE SUM: 0 where the archive is what it should be
  local name=$1 url=$2 file=$3 size=$4 sum=$5 got have
  have=$(wc -c <"$file" | tr -d ' ')
  if [ "$size" != - ] && [ "$have" != "$size" ]; then
    warn "$name: $have bytes came, $size were expected"
    return 1
  fi
  got=$(sha256 "$file")
  if [ "$sum" = - ] && [ -f "$lock" ]; then
    sum=$(awk -v name="$name" -v url="$url" '$2 == name && $3 == url { print $1 }' "$lock" | tail -n 1)
    sum=${sum:--}
  fi
  if [ "$sum" = - ]; then
    say "$name: SHA-256 $got: trusted as the first one, written to $lock"
    printf '%s %s %s\n' "$got" "$name" "$url" >>"$lock"
  elif [ "$got" != "$sum" ]; then
    warn "$name: SHA-256 is $got, expected $sum. If the publisher has changed the file on purpose, say so in the list ($table, or $lock)"
    return 1
  fi
}

unpack() {  # ARCHIVE FOLDER
  case $1 in
    *.zip) if command -v unzip >/dev/null; then unzip -q -o "$1" -d "$2"; else python3 -m zipfile -e "$1" "$2"; fi ;;
    *.tar.gz|*.tgz) tar --no-same-owner -xzf "$1" -C "$2" ;;
    *) warn "$1: neither .zip nor .tar.gz"; return 1 ;;
  esac
}

agreed() {  # INDEX
  [ "$accept" = no ] || return 0
  [ -t 0 ] || die "--accept is needed where nobody can be asked; --list shows the terms"
  local answer
  read -r -p "Do you accept these terms? [yes/no] " answer
  [ "$answer" = yes ]
}

fetch() {  # INDEX: 0 where the scene is there afterwards
  local i=$1 name=${names[$1]} url=${urls[$1]} mesh=${meshes[$1]} count=${counts[$1]}
  local target=$folder/$name archive program found
  if [ -f "$target/$mesh" ]; then
    say "$name: is there already"
    return 0
  fi
  if [ -e "$target" ]; then
    warn "$target is there but has no $mesh: move it away first"
    return 1
  fi
  describe "$i"
  agreed "$i" || { say "$name: left out"; return 1; }
  archive=$work/$name.${url##*/}
  if [ ! -f "$archive" ]; then
    if ! download "$url" "$archive.part"; then
      # Some servers refuse to go on after the end: what came may be whole.
      if [ "${sizes[$i]}" = - ] || [ ! -f "$archive.part" ] || [ "$(wc -c <"$archive.part" | tr -d ' ')" != "${sizes[$i]}" ]; then
        warn "$name: the download failed; run this again and it goes on"
        return 1
      fi
    fi
    if ! check "$name" "$url" "$archive.part" "${sizes[$i]}" "${sums[$i]}"; then
      rm -f "$archive.part"  # Going on from here would only end here again.
      return 1
    fi
    mv "$archive.part" "$archive"
  elif ! check "$name" "$url" "$archive" "${sizes[$i]}" "${sums[$i]}"; then
    rm -f "$archive"
    return 1
  fi
  rm -rf "$target.part"
  mkdir "$target.part"
  if ! unpack "$archive" "$target.part"; then
    warn "$name: the archive cannot be unpacked"
    rm -rf "$target.part" "$archive"
    return 1
  fi
  if [ ! -f "$target.part/$mesh" ]; then
    warn "$name: the archive has no $mesh"
    rm -rf "$target.part"
    return 1
  fi
  program=$(copse)
  if [ -n "$program" ]; then
    found=$("$program" info "$target.part/$mesh" 2>/dev/null | awk '$1 == "triangles" { gsub(",", "", $2); print $2; exit }' || true)
    if [ "$found" != "$count" ]; then
      warn "$name: ${found:-no} triangles were read from $mesh, $count were expected"
      rm -rf "$target.part"
      return 1
    fi
    say "$name: $found triangles, as it should be"
  else
    warn "$name: copse is not built, so its triangles were not counted"
  fi
  mv "$target.part" "$target"
  [ "$keep" = yes ] || rm -f "$archive"
  say "$name: is in $target"
}

failed=()
for i in "${chosen[@]}"; do fetch "$i" || failed+=("${names[$i]}"); done
rmdir "$work" 2>/dev/null || true
if [ ${#failed[@]} -gt 0 ]; then
  printf 'error: not fetched: %s\n' "${failed[*]}" >&2
  exit 1
fi
say "Now: export COPSE_SCENES=$folder"
