# The parts of tests/gpu/run: one function each, given the seconds it may take. To be sourced.
# shellcheck shell=bash disable=SC2034,SC2154,SC2012,SC2016

#   devices      what machine this is: nothing below means anything without it
#   ceilings     the card's maximum rates, with which times are compared
#   smoke        what everything else rests on: launches, memory, sorting, scans
#   same         every builder's trees, rays and pictures against the CPU's: errors there make the rest worthless
#   bench-short  seven builders on three scenes at eight samples per pixel
#   variants     settings that change only times, in turn, on three scenes
#   bench        every builder on all scenes, with 128 samples per pixel
#   ncu          the kernels that take the most time, and what limits them
#   sanitizer    compute-sanitizer over every builder and every traversal kernel: a race may pass all tests once
#   tests        every test program with --device
parts=(devices ceilings smoke same bench-short variants bench ncu sanitizer tests)
declare -A guaranteed=([devices]=10 [ceilings]=12 [smoke]=12 [same]=50 [bench-short]=70 [variants]=50 [bench]=80
  [ncu]=80 [sanitizer]=45 [tests]=45)

tiny=(--triangles 2880 --rays 2000 --size 16)  # For gpu_same where it runs a hundred times slower.

tool() {  # NAME: its path, or nothing if it is missing
  type -P "$1" || ls /usr/local/cuda*/bin/"$1" /opt/nvidia/nsight-compute/*/"$1" 2>/dev/null | head -n 1
}
smaller() { echo $(($1 < $2 ? $1 : $2)); }

# Records clocks and power every second of the whole run, which also keeps awake a card that nobody else holds. Ends by
# itself if this shell is gone first.
watch_clocks() {
  [ "$device" = cuda ] && command -v nvidia-smi >/dev/null || return 0
  timeout "$deadline" nvidia-smi dmon -s puc -d 1 -o T >"$logs/dmon.txt" 2>&1 </dev/null &
  watch=$!
}

devices() {
  { echo "$commit"; uname -a; ldd --version | head -n 1; echo "$cores processors"; } >"$logs/machine.txt" 2>&1
  step devices "$(smaller "$1" 20)" is_there bash -c '"$0" list devices && "$0" list devices --json >"$1"' \
    "$bin/copse" "$logs/devices.json"
  if [ "$device" = cpu ]; then return; fi
  if command -v nvidia-smi >/dev/null; then step nvidia-smi "$(smaller "$1" 20)" '' nvidia-smi -q
  else skip nvidia-smi "not found"; fi
}
is_there() {  # NAME LOG STATE
  if [ "$3" = passed ] && ! grep -q "\"kind\": \"$device\"" "$logs/devices.json"; then echo "failed: no $device device"
  else echo "$3"; fi
}

ceilings() {
  local size=(--mib 4096 --ms 500)
  [ "$brief" = 0 ] || size=(--mib 4 --ms 1)
  if [ "$device" = cpu ]; then skip ceilings "no GPU was asked for"; return; fi
  step ceilings "$(smaller "$1" 30)" '' "$bin/gpu_ceilings" "${size[@]}" --stats "$logs/ceilings.json"
}

smoke() { step test_parallel "$(smaller "$1" 120)" ran_there "$bin/test_parallel" --device "$device"; }

same() {
  local size=(--triangles 50000)
  [ "$brief" = 0 ] || size=("${tiny[@]}" --generator cornell hairball)
  step same "$1" covers_all "$bin/gpu_same" --device "$device" "${size[@]}" --stats "$logs/same.json"
}
covers_all() {  # NAME LOG STATE
  if [ "$3" = passed ] && ! grep -q 'every one compared$' "$2"; then echo "failed: not every builder"; else echo "$3"; fi
}

tests() {
  local program name end=$((SECONDS + $1))
  for program in "$bin"/test_*; do
    name=${program##*/}
    if [ -f "$logs/$name.txt" ] || { [ "$brief" = 1 ] && [ "$name" != test_linear ]; }; then continue; fi
    beside "$name" "$(smaller $((end > SECONDS ? end - SECONDS : 1)) 300)" ran_there "$program" --device "$device"
  done
  together
}
# "on cuda: 7 of 9 test cases, 412 assertions in all, 0 test cases failed" must be there, and the 7 must not be 0.
ran_there() {  # NAME LOG STATE
  local line
  line=$(sed -n "s/^on $device: \([0-9]*\) of \([0-9]*\) test cases, \([0-9]*\) assertions in all, \([0-9]*\) test .*/\1\t\2\t\3\t\4/p" "$2")
  [ -z "$line" ] || printf '%s\t%s\t%s\n' "$1" "$device" "$line" >>"$logs/tests.tsv"
  if [ "$3" != passed ]; then echo "$3"
  elif [ -z "$line" ]; then echo "failed: does not say what it ran"
  elif [ "${line%%$'\t'*}" = 0 ]; then echo "failed: no test case ran on $device"
  else echo passed; fi
}

sanitizer() {
  local sanitizer check
  sanitizer=$(tool compute-sanitizer)
  if [ "$device" = cpu ]; then skip sanitizer "no GPU was asked for"; return; fi
  if [ -z "$sanitizer" ]; then skip sanitizer "no compute-sanitizer on PATH or under /usr/local/cuda"; return; fi
  [ "$slots" -ge 3 ] || slots=3
  for check in $checks; do
    # shellcheck disable=SC2086
    beside "sanitizer-$check" "$1" sanitized "$sanitizer" --tool "$check" --error-exitcode 9 \
      "$bin/gpu_same" --device cuda --generator $checked_scenes "${tiny[@]}"
  done
  together
}
sanitized() {  # NAME LOG STATE
  if grep -qE 'Device not supported|Unable to find injection|Insufficient permissions' "$2"; then
    echo "skipped: compute-sanitizer does not work here"
  elif [ "$3" = passed ] && ! grep -qE '(ERROR|RACECHECK) SUMMARY: 0 ' "$2"; then echo "failed: no summary of 0 errors"
  else covers_all "$@"; fi
}

measured() {  # NAME LIMIT CONFIG BRIEF_CONFIG
  local config=$here/configs/$3
  [ "$brief" = 0 ] || config=$here/$4
  step "$1" "$2" '' "$bin/copse" bench "$config" --device "$device" -o "$logs/$1"
  # A bench that was cut off has not made a page.
  [ -f "$logs/$1/report.html" ] || timeout 10 "$bin/copse" report "$logs/$1" >"$logs/$1-report.txt" 2>&1
}
bench-short() { measured bench-short "$1" gpu-short.toml brief.toml; }
bench() { measured bench "$1" gpu.toml brief.toml; }
variants() { measured variants "$1" gpu-variants.toml brief_variants.toml; }

ncu() {
  local ncu
  ncu=$(tool ncu)
  if [ "$device" = cpu ]; then skip ncu "no GPU was asked for"; return; fi
  if [ -z "$ncu" ]; then skip ncu "no ncu on PATH or under /usr/local/cuda"; return; fi
  mkdir -p "$logs/ncu"
  step ncu "$1" countable "$here/hot_kernels" "$kernels" "$ncu" "$logs/ncu" "$bin/copse" render \
    "$here/scenes/atrium.toml" --builder kmeans-q2 --device cuda --size 1024x768 --spp 2 --quiet -o "$work/ncu.exr"
}
countable() {  # NAME LOG STATE
  if [ "$3" != passed ] && grep -qE 'ERR_NVGPUCTRPERM|LibraryNotLoaded' "$2"; then
    echo "skipped: this machine does not permit reading the counters"
  else echo "$3"; fi
}
