#!/usr/bin/env bash
# scenes/fetch.sh against archives of our own, by file:// addresses and one that nobody answers.
# shellcheck disable=SC2317  # What `expect` calls is reached.
#   test_fetch.sh FETCH COPSE WORK
set -u
fetch=$1 program=$2 work=$3
command -v curl >/dev/null || { echo "skipped: curl is not there"; exit 77; }
rm -rf "$work"
mkdir -p "$work/published/box" "$work/scenes"
cd "$work" || exit 1
export COPSE_PROGRAM=$program
failed=0
expect() {  # WHAT CONDITION...
  local what=$1
  shift
  "$@" || { echo "FAILED: $what"; failed=1; }
}
absent() { [ ! -e "$1" ]; }
status() { [ "$last" = "$1" ]; }
says() { grep -q -- "$1" out.txt; }
# run STATUS ARGUMENTS...: with the list in list.txt
run() {
  bash "$fetch" --table list.txt "$@" >out.txt 2>&1 </dev/null
  last=$?
}

printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n' >published/box/box.obj
tar -czf published/box.tar.gz -C published/box box.obj
size=$(wc -c <published/box.tar.gz | tr -d ' ')
sum=$(sha256sum published/box.tar.gz | cut -d' ' -f1)
url=file://$work/published/box.tar.gz
row() { printf '%s|%s|%s|%s|%s|%s|%s|%s\n' "$1" "$2" "$3" "$4" "$5" "$6" "free for all" "us"; }

row box "$url" "$size" "$sum" box.obj 2 >list.txt
run --list
expect "the list names scene, terms and address without a folder" status 0
expect "terms are listed" says "free for all"
run scenes
expect "nothing is fetched before the terms are accepted" status 2
expect "nothing is there then" absent scenes/box
run --accept scenes nothere
expect "an unknown scene is refused" status 2
run --accept
expect "a folder is needed" status 2

run --accept scenes
expect "a sound archive is fetched" status 0
expect "its mesh is there" test -f scenes/box/box.obj
expect "its triangles were counted" says "2 triangles, as it should be"
expect "no working files stay" absent scenes/.fetch
run --accept scenes
expect "what is there is not fetched again" says "is there already"

rm -rf scenes/box; mkdir -p scenes/.fetch
head -c 60 published/box.tar.gz >scenes/.fetch/box.box.tar.gz.part
run --accept scenes box
expect "a download that broke off goes on" status 0
expect "and is whole" test -f scenes/box/box.obj

rm -rf scenes/box
row box "$url" "$size" "${sum/[0-9a-f]/x}" box.obj 2 >list.txt
run --accept scenes
expect "a wrong checksum fails" status 1
expect "it is said" says "SHA-256"
expect "nothing is left under its name" absent scenes/box
expect "nor is the bad archive kept" absent scenes/.fetch/box.box.tar.gz.part
row box "$url" "$((size + 1))" "$sum" box.obj 2 >list.txt
run --accept scenes
expect "a wrong size fails" status 1
expect "nothing is left then either" absent scenes/box

row box "$url" - - box.obj 2 >list.txt
run --accept scenes
expect "without a checksum the first download is trusted" status 0
expect "its checksum is written down" grep -q "$sum box" scenes/fetch.lock
rm -rf scenes/box
printf 'f 1 3 4\n' >>published/box/box.obj
tar -czf published/box.tar.gz -C published/box box.obj
run --accept scenes
expect "another archive than the first one is refused" status 1
expect "nothing of it stays" absent scenes/box

rm -f scenes/fetch.lock
run --accept scenes
expect "a mesh with another count fails" status 1
expect "the count is said" says "3 triangles were read from box.obj, 2 were expected"
expect "it is not put in place" absent scenes/box
row box "$url" - - other.obj 3 >list.txt
run --accept scenes
expect "an archive without the mesh fails" says "has no other.obj"

{ row gone "http://127.0.0.1:9/gone.zip" 10 - box.obj 2; row box "$url" - - box.obj 3; } >list.txt
run --accept scenes
expect "no network fails" status 1
expect "it is named" says "not fetched: gone"
expect "the others are fetched all the same" test -f scenes/box/box.obj
expect "nothing of the other is there" absent scenes/gone
printf 'PK not a zip' >published/bad.zip
row bad "file://$work/published/bad.zip" - - box.obj 2 >list.txt
run --accept scenes
expect "what cannot be unpacked fails" status 1
expect "without traces" absent scenes/bad
printf '../evil|%s|-|-|box.obj|2|free|us\n' "$url" >list.txt
run --accept scenes
expect "a name that leaves the folder is refused" status 2
if [ $failed = 0 ]; then echo "fetch.sh: all checks passed"; fi
exit $failed
