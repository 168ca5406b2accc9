# Writes the results of tests/gpu/run: results.json, results.md to read, and the packed logs. To be sourced; needs what
# steps.sh needs. A part that was not run, or was cut off before it had any result, is null.
# shellcheck shell=bash disable=SC2154

json_of_csv() { if [ -s "$1" ]; then awk -f "$here/csv.awk" -f "$here/csv_to_json.awk" "$1"; else echo null; fi; }
json_file() { if [ -s "$1" ]; then cat "$1"; else echo null; fi; }

tests_csv() {
  echo program,device,on_device,cases,assertions,failed
  [ ! -s "$logs/tests.tsv" ] || sort "$logs/tests.tsv" | tr '\t' ,
}

sanitizer_csv() {  # One row per check: its summary, and how many rows of gpu_same it went through.
  local file
  echo check,summary,rows
  for file in "$logs"/sanitizer-*.txt; do
    [ -f "$file" ] || continue
    printf '%s,"%s",%d\n' "$(basename "$file" .txt)" "$(sed -n 's/^=* *\(.* SUMMARY: .*\)/\1/p' "$file" | tail -n 1)" \
      "$(grep -c ' launches, ' "$file")"
  done
}

# Everything in OUT, from what is known now. Each file is replaced as a whole, so that an existing one can be read.
pack() {
  account
  results
  archive
  # Then small enough to be fetched: counters only as text.
  [ "$(wc -c <"$out/logs.tar.gz")" -lt 15000000 ] || archive --exclude '*.ncu-rep'
}
archive() {  # TAR_OPTION...
  # A log that grows while it is read is packed as far as it was written.
  tar -C "$logs" -czf "$out/logs.tar.gz.new" --exclude .steps "$@" . 2>/dev/null
  mv "$out/logs.tar.gz.new" "$out/logs.tar.gz"
}

ceiling() { sed -n "s/.*\"$1\": \([-+0-9.e]*\).*/\1/p" "$logs/ceilings.json" 2>/dev/null; }  # NAME
rows_in() { [ -s "$1" ] && [ "$(wc -l <"$1")" -gt 1 ]; }  # CSV

least_csv() {  # TABLE1_CSV
  ! [ -s "$logs/ceilings.json" ] || ! rows_in "$1" ||
    awk -f "$here/csv.awk" -f "$here/least.awk" -v copy="$(ceiling copy_gb_s)" \
      -v instructions="$(ceiling instructions_e12_s)" "$here/least.csv" "$1"
}

results() {
  local stage
  tests_csv >"$logs/tests.csv"
  sanitizer_csv >"$logs/sanitizer.csv"
  for stage in bench-short bench; do least_csv "$logs/$stage/table1.csv" >"$logs/least-$stage.csv"; done
  [ ! -s "$logs/dmon.txt" ] || [ ! -s "$logs/parts.tsv" ] ||
    awk -f "$here/clocks.awk" "$logs/parts.tsv" "$logs/dmon.txt" >"$logs/clocks.csv"
  {
    printf '{\n"schema": 2,\n"summary": '
    cat "$out/summary.json"
    printf ',\n"machine": %s,\n"devices": ' "$(text_of "$({ tr '\n' ';' <"$logs/machine.txt"; } 2>/dev/null)")"
    json_file "$logs/devices.json"
    printf ',\n"ceilings": '
    json_file "$logs/ceilings.json"
    printf ',\n"clocks": '
    json_of_csv "$logs/clocks.csv"
    printf ',\n"tests": '
    json_of_csv "$logs/tests.csv"
    printf ',\n"sanitizer": '
    json_of_csv "$logs/sanitizer.csv"
    printf ',\n"same": '
    json_file "$logs/same.json"
    for stage in bench-short bench; do
      printf ',\n"%s": ' "${stage/-/_}"
      json_of_csv "$logs/$stage/table1.csv"
    done
    printf ',\n"variants": '
    json_of_csv "$logs/variants/table1.csv"
    printf ',\n"kernels": '
    json_of_csv "$logs/ncu/hottest.csv"
    printf ',\n"kernels_measured": '
    json_of_csv "$logs/ncu/measured.csv"
    printf '}\n'
  } >"$out/results.json.new" && mv "$out/results.json.new" "$out/results.json"
  page >"$out/results.md.new" && mv "$out/results.md.new" "$out/results.md"
}

# A field of the requested device.
device_field() {  # FIELD
  awk -v kind="$device" -v field="$1" -F'"' '
    $2 == "kind" { mine = $4 == kind }
    mine && $2 == field { value = $4; if (value == "") { value = $3; gsub(/[:, ]/, "", value) }; print value; exit }
  ' "$logs/devices.json" 2>/dev/null
}

# A title, and a CSV as plain text.
csv_section() {  # TITLE CSV...
  local title=$1
  shift
  rows_in "$1" || return 0
  printf '\n## %s\n\n```text\n' "$title"
  cat "$@" 2>/dev/null
  printf '```\n'
}

ceilings_section() {
  [ -s "$logs/ceilings.json" ] || return 0
  printf '\n## Maximum rates of the card\n\n| | measured | assumed in gpu-kernels.md |\n|---|--:|--:|\n'
  printf '| copy, GB/s | %.0f | 3,000 |\n' "$(ceiling copy_gb_s)"
  printf '| copy by a kernel, GB/s | %.0f | |\n' "$(ceiling copy_by_kernel_gb_s)"
  printf '| clock with all lanes busy, MHz | %.0f | 1,700 |\n' "$(ceiling clock_mhz)"
  printf '| lane instructions per second, 10^12 | %.1f | 28.7 |\n' "$(ceiling instructions_e12_s)"
  printf '| multiply-adds per second, 10^12 | %.1f | |\n' "$(ceiling multiply_adds_e12_s)"
}

bench_section() {  # TITLE STAGE
  rows_in "$logs/$2/table1.csv" || return 0
  printf '\n## %s\n\nMedians over repetitions; peak memory is that of the build. Without textures, which the\nbundle cannot read.\n\n' "$1"
  awk -f "$here/csv.awk" -f "$here/csv_to_table.awk" "$logs/$2/table1.csv"
  csv_section "$1: builds against the minimum time at the card's maximum rates" "$logs/least-$2.csv"
}

page() {
  local memory
  memory=$(device_field memory_bytes)
  printf '# Copse on %s\n\n' "$(device_field name)"
  printf -- '- Device: %s' "$(device_field name)"
  [ "$device" = cpu ] && printf ', %s threads\n' "$(device_field threads)"
  [ "$device" = cuda ] && printf ', driver %s, %s multiprocessors, %s MiB, %s MHz, memory %s MHz\n' \
    "$(device_field driver)" "$(device_field multiprocessors)" $((${memory:-0} / 1048576)) \
    "$(device_field clock_mhz)" "$(device_field memory_clock_mhz)"
  # shellcheck disable=SC2016
  printf -- '- Commit: %s, %s\n- Command: `%s`\n\n## What was run\n\n```text\n' "$commit" "$started" "$command"
  cat "$out/summary.txt"
  printf '```\n'
  ceilings_section
  csv_section "Clocks while each part ran" "$logs/clocks.csv"
  if [ -s "$logs/same.json" ]; then
    printf '\n## Against the CPU\n\n```text\n'
    cat "$logs/same.txt"
    printf '```\n'
  fi
  bench_section "Build, trace and time to image" bench-short
  if rows_in "$logs/variants/results.csv"; then
    printf '\n## Variants\n\nMedians over repetitions; all settings interleaved.\n\n'
    awk -f "$here/csv.awk" -f "$here/csv_to_variants.awk" "$logs/variants/results.csv"
  fi
  bench_section "Build, trace and time to image, all builders" bench
  csv_section "The kernels that take the most time" "$logs/ncu/hottest.csv" "$logs/ncu/measured.csv"
  csv_section "compute-sanitizer" "$logs/sanitizer.csv"
}
