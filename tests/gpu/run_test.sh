#!/usr/bin/env bash
# Tests tests/gpu/run with stand-ins that print what the real programs and NVIDIA's tools print: the parts and their
# order, the files it leaves, and what remains when a part or all of it is killed.   tests/gpu/run_test.sh [CASE…]
# shellcheck disable=SC2012,SC2016,SC2317
set -uo pipefail
here=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bundle=$work/copse-gpu out=$work/out
failed=0
check() {  # WHAT COMMAND...
  local what=$1
  shift
  "$@" >"$work/check.txt" 2>&1 || { echo "not so: $what"; sed 's/^/    /' "$work/check.txt" | head -n 20; failed=1; }
}
says() { grep -qE -- "$2" "$1" || { cat "$1"; return 1; }; }  # FILE PATTERN
program() {  # FILE TEXT
  mkdir -p "$(dirname "$1")"
  printf '#!/usr/bin/env bash\n%s\n' "$2" >"$1"
  chmod +x "$1"
}
step_names() { sed -n 's/^\([a-z_-]*\)  *[0-9]* s  .*/\1/p' "$out/summary.txt" | tr '\n' ' '; }
packed() { tar -xzOf "$out/logs.tar.gz" "./$1"; }  # FILE of the archive
wait_for() { local i; for ((i = 0; i < 200; ++i)); do "$@" >/dev/null 2>&1 && return; sleep 0.05; done; return 1; }
has_packed() { packed "$1" | grep -q -- "$2"; }

# Files such as $work/slow, created by a test, tell a program what to do.
make_bundle() {
  local name
  mkdir -p "$bundle" "$work/tools"
  (cd "$here" && cp run hot_kernels ./*.sh ./*.awk ./*.toml ./*.csv "$bundle/")
  cp -r "$here/../../configs" "$bundle/"
  echo 0123abcd >"$bundle/commit"
  program "$bundle/bin/copse" '
work='"$work"'
case $1 in
  list) printf "[\n {\n  \"kind\": \"cuda\",\n  \"name\": \"A Card 80GB\",\n  \"multiprocessors\": 132\n }\n]\n" ;;
  report) echo "a table" ;;
  render) echo rendered ;;
  bench)
    while [ $# -gt 0 ]; do case $1 in -o) to=$2; shift ;; *.toml) config=$1 ;; esac; shift; done
    mkdir -p "$to"
    echo "{\"run\": 1}" >"$to/results.jsonl"
    basename "$config" >>"$work/benches"
    [ ! -e "$work/slow" ] || { echo slow >"$work/in-bench"; sleep 10; }
    {
      echo "label,scene,status,build_ms,total_ms,mrays_per_s_all,sah_cost,rays_primary,rays_bounce,rays_shadow"
      for r in 1 2 3; do
        echo "as it is,atrium,done,$r.5,1$r,900,30.5,10,20,30"
        echo "\"leave at 8, fetch below 26\",atrium,done,$r.6,1$r,950,30.5,10,20,30"
        echo "chunks of 256,atrium,done,$r,1$r,900,31.5,10,20,30"
      done
      echo "chunks of 256,atrium,failed,,,,,,,"
    } >"$to/results.csv"
    printf "scene,triangles,method,sah_cost,build_ms,build_peak_bytes_per_triangle,trace_mrays_s,total_8spp_ms\natrium,1000000,lbvh,30.5,0.92,100,900,50\n" >"$to/table1.csv"
    touch "$to/report.html" ;;
esac'
  program "$bundle/bin/gpu_same" '
while [ $# -gt 0 ]; do if [ "$1" = --stats ]; then echo "{\"differ\": 0}" >"$2"; fi; shift; done
if [ -e '"$work"'/slow-same ]; then rm '"$work"'/slow-same; echo $$ >'"$work"'/same-pid; sleep 10 & echo $! >'"$work"'/same-child; wait; fi
echo "atrium lbvh tree the same, 7 launches, 1 waits"
echo "0 of 40 rows differ; 18 builders, every one compared"'
  program "$bundle/bin/gpu_ceilings" '
while [ $# -gt 0 ]; do
  if [ "$1" = --stats ]; then printf "{\n \"copy_gb_s\": 3000.0,\n \"copy_by_kernel_gb_s\": 2900.5,\n \"clock_mhz\": 1700.0,\n \"instructions_e12_s\": 28.7,\n \"multiply_adds_e12_s\": 28.0\n}\n" >"$2"; fi
  shift
done'
  for name in parallel linear path; do
    program "$bundle/bin/test_$name" 'echo "on cuda: 7 of 9 test cases, 412 assertions in all, 0 test cases failed"'
  done
  program "$work/tools/nvidia-smi" '
[ "$1" = dmon ] || { echo "a card"; exit; }
echo "#Time        gpu    pwr  gtemp  mtemp     sm    mem    enc    dec    jpg    ofa   mclk   pclk"
echo "#HH:MM:SS    Idx      W      C      C      %      %      %      %      %      %    MHz    MHz"
while :; do printf " %s      0    350     50     60     90     40      0      0      0      0   2619   1755\n" "$(date +%T)"; sleep 0.2; done'
  program "$work/tools/compute-sanitizer" '
echo "========= COMPUTE-SANITIZER"; tool=$2; shift 4; echo "$@" >>'"$work"'/sanitized; "$@"
if [ $tool = racecheck ]; then echo "========= RACECHECK SUMMARY: 0 hazards displayed (0 errors, 0 warnings)"; else echo "========= ERROR SUMMARY: 0 errors"; fi'
  # Durations of six kernels; then the counters of one launch, or "Failed to find metric" for an unknown counter.
  program "$work/tools/ncu" '
all=" $* "
if [[ $all = *" --import "* ]]; then
  if [[ $all = *" --csv "* ]]; then
    n=$(sed -n "s/.*hot-\([0-9]\).*/\1/p" <<<"$all" | head -n 1)
    printf "\"ID\",\"Kernel Name\",\"gpu__time_duration.sum\",\"smsp__issue_active.avg.pct_of_peak_sustained_active\"\n\"\",\"\",\"ns\",\"%%\"\n\"0\",\"kernel$n\",\"1,000\",\"77\"\n"
  fi
elif [[ $all = *" --set detailed "* ]]; then
  if [ -e '"$work"'/old-ncu ] && [[ $all = *smsp__issue_active* ]]; then echo "==ERROR== Failed to find metric smsp__issue_active"; exit 1; fi
else
  printf "\"ID\",\"Kernel Name\",\"gpu__time_duration.sum\"\n\"\",\"\",\"ns\"\n"
  for k in 1 2 3 4 5 6; do printf "\"%d\",\"kernel%d\",\"%d,000\"\n" $k $k $((900 - k)); done
fi'
}
start() {  # In the background, as $runner.
  rm -rf "$out"
  PATH=$work/tools:$PATH "$bundle/run" "$@" "$out" >"$work/run.txt" 2>&1 &
  runner=$!
}
run() { start "$@" && wait "$runner"; }

files_are_five() {
  [ "$(ls -A "$out" | tr '\n' ' ')" = "logs.tar.gz results.json results.md summary.json summary.txt " ] || { ls -A "$out"; return 1; }
}
json_is_sound() { ! command -v python3 >/dev/null || python3 -m json.tool "$out/results.json" >/dev/null; }

case_first() {
  check "status 0" run --first
  check "five files" files_are_five
  check "the parts in their order" [ "$(step_names)" = "devices nvidia-smi ceilings test_parallel same bench-short ncu sanitizer-memcheck " ]
  check "results.json is JSON" json_is_sound
  check "results.json has the ceilings" says "$out/results.json" '"copy_gb_s": 3000'
  check "the minimum time: 680 and 266 bytes per triangle" says "$out/results.md" '^atrium,lbvh,1000000,0.920,0.315,2.92$'
  check "clocks of each part" says "$out/results.md" '^same,[0-9]+,[0-9]+,1755,1755,1755,2619,350$'
  check "three kernels" [ "$(packed ncu/measured.csv | wc -l)" = 4 ]
  check "with the counters" has_packed ncu/measured.csv ',77,'
  check "memcheck of the Cornell box" says "$work/sanitized" '--generator cornell --triangles'
  check "tests where they run" says "$out/summary.txt" 'test_parallel +7 of +9 test cases on cuda'
}
case_second() {
  check "status 0" run --second
  check "five files" files_are_five
  check "the parts in their order" [ "$(step_names)" = \
    "devices nvidia-smi same variants bench sanitizer-racecheck sanitizer-synccheck test_linear test_parallel test_path " ]
  check "results.json is JSON" json_is_sound
  check "medians" says "$out/results.md" '^\| as it is \| 2.500 \| 900.0 \| 12.00 \|  \|$'
  check "a name with a comma" says "$out/results.md" '^\| leave at 8, fetch below 26 \| 2.600 \| 950.0 \| 12.00 \|  \|$'
  check "a setting that makes another tree" says "$out/results.md" '^\| chunks of 256 \| 2.000 .* tree of atrium \|$'
}
case_whole() {
  check "status 0" run
  check "the parts in their order" [ "$(step_names)" = "devices nvidia-smi ceilings test_parallel same bench-short variants \
bench ncu sanitizer-memcheck sanitizer-racecheck sanitizer-synccheck test_linear test_path " ]
  check "five kernels" [ "$(packed ncu/measured.csv | wc -l)" = 6 ]
}
case_variants() {
  check "status 0" run --variants
  check "nothing else" [ "$(step_names)" = "devices nvidia-smi variants " ]
  check "by their configuration" says "$work/benches" '^gpu-variants.toml$'
}
case_old_ncu() {
  touch "$work/old-ncu"
  check "ncu without the counters that it does not know" run --only devices,ncu
  check "five kernels" [ "$(packed ncu/measured.csv | wc -l)" = 6 ]
}
case_part_killed() {  # By hand, or by the system that has no memory left.
  touch "$work/slow-same"
  start --first
  check "same runs" wait_for [ -s "$work/same-child" ]
  # Kills what limits its time, so that nothing is left to end what it started.
  kill -KILL "$(ps -o ppid= -p "$(cat "$work/same-pid")" | tr -d ' ')"
  wait "$runner"
  check "one step failed" [ $? = 1 ]
  check "it says so" says "$out/summary.txt" '^same +[0-9]+ s  killed after [0-9]+ s$'
  check "nothing of it runs on" wait_for [ ! -d "/proc/$(cat "$work/same-child")" ]
  check "the parts after it have run" [ "$(step_names)" = "devices nvidia-smi ceilings test_parallel same bench-short ncu sanitizer-memcheck " ]
  check "five files" files_are_five
}
case_runner_killed() {  # At a machine's own limit.
  touch "$work/slow"
  COPSE_RUN_PACK_EVERY=1 start --first
  check "the bench runs" wait_for [ -s "$work/in-bench" ]
  check "what the part before it found is packed" has_packed same.json differ
  check "what it has itself is packed as well" wait_for has_packed bench-short/results.jsonl run
  { kill -KILL "$runner" && wait "$runner"; } 2>/dev/null
  check "five files" files_are_five
  check "results.json is JSON" json_is_sound
  check "results.json has the part before" says "$out/results.json" '"differ": 0'
  check "the table is the ceilings'" says "$out/results.md" '\| copy, GB/s \| 3000 \| 3,000 \|'
  check "it was not finished" says "$out/summary.txt" '^bench-short +0 s  not finished$'
}
case_ended() {
  touch "$work/slow"
  start --first
  check "the bench runs" wait_for [ -s "$work/in-bench" ]
  kill -TERM "$runner" && wait "$runner"
  check "status 100" [ $? = 100 ]
  check "five files" files_are_five
  check "what it has itself is packed" has_packed bench-short/results.jsonl run
}
case_never_ends() {  # As a process that waits for a GPU that hangs.
  program "$work/tools/timeout" 'case " $* " in *gpu_same*) exec sleep 20 ;; *) exec '"$(command -v timeout)"' "$@" ;; esac'
  check "one step failed" [ "$(COPSE_RUN_GRACE=1 run --only devices,same,bench-short --deadline 15; echo $?)" = 1 ]
  check "it says so" says "$out/summary.txt" '^same +[0-9]+ s  does not end, not even by SIGKILL$'
  check "the part after it has run" says "$out/summary.txt" '^bench-short +[0-9]+ s  passed$'
}
case_publish() {
  run --only devices,ceilings && mv "$out" "$work/out1"
  run --only devices,bench-short && mv "$out" "$work/out2"
  check "two calls are one page" "$here/publish" -o "$work/results" "$work/out1" "$work/out2"
  local page
  page=$(echo "$work"/results/*-a-card-80gb.md)
  check "with what both found" says "$page" 'copy, GB/s'
  check "with what both found" says "$page" '^\| atrium \| 1000000 \| lbvh '
  echo 4567efab >"$bundle/commit"
  run --only devices,ceilings
  check "another commit of the day stands beside it" "$here/publish" -o "$work/results" "$out"
  check "by its name" [ "$(ls "$work/results" | wc -l)" = 4 ] && ls "$work"/results/*-4567efab.md >/dev/null
  check "two commits are not one page" [ "$("$here/publish" -o "$work/results" "$work/out1" "$out" >/dev/null 2>&1; echo $?)" = 2 ]
}
case_usage() {
  check "no folder" [ "$("$bundle/run" >/dev/null 2>&1; echo $?)" = 2 ]
  check "no such part" [ "$(run --only devices,dishes; echo $?)" = 2 ]
  check "no such device" [ "$(run --device tpu; echo $?)" = 2 ]
}

cases=("$@")
[ $# -gt 0 ] || mapfile -t cases < <(declare -F | sed -n 's/^declare -f case_//p')
for name in "${cases[@]}"; do
  rm -rf "${work:?}"/*
  make_bundle
  began=$SECONDS before=$failed
  failed=0
  "case_$name"
  echo "$name: $([ $failed = 0 ] && echo passed || echo FAILED), $((SECONDS - began)) s"
  failed=$((failed + before))
done
exit $((failed > 0))
