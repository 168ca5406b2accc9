# What tests/gpu/run found, in one results.json and, to be read, results.md. To be sourced; wants what steps.sh wants.
# A part that was not run, or was cut off before it had anything, is null.
# shellcheck shell=bash disable=SC2154

json_of_csv() { if [ -s "$1" ]; then awk -f "$here/csv.awk" -f "$here/csv_to_json.awk" "$1"; else echo null; fi; }
json_file() { if [ -s "$1" ]; then cat "$1"; else echo null; fi; }

tests_csv() {
  echo program,device,on_device,cases,assertions,failed
  [ ! -s "$logs/tests.tsv" ] || sort "$logs/tests.tsv" | tr '\t' ,
}

sanitizer_csv() {  # A row a check: what it says of itself, and how many rows of gpu_same it went through.
  local file
  echo check,summary,rows
  for file in "$logs"/sanitizer-*.txt; do
    [ -f "$file" ] || continue
    printf '%s,"%s",%d\n' "$(basename "$file" .txt)" "$(sed -n 's/^=* *\(.* SUMMARY: .*\)/\1/p' "$file" | tail -n 1)" \
      "$(grep -c ' launches, ' "$file")"
  done
}

results() {
  tests_csv >"$logs/tests.csv"
  sanitizer_csv >"$logs/sanitizer.csv"
  {
    printf '{\n"schema": 1,\n"summary": '
    cat "$out/summary.json"
    printf ',\n"machine": %s,\n"devices": ' "$(text_of "$({ tr '\n' ';' <"$logs/machine.txt"; } 2>/dev/null)")"
    json_file "$logs/devices.json"
    printf ',\n"tests": '
    json_of_csv "$logs/tests.csv"
    printf ',\n"sanitizer": '
    json_of_csv "$logs/sanitizer.csv"
    printf ',\n"same": '
    json_file "$logs/same.json"
    printf ',\n"bench": '
    json_of_csv "$logs/bench/table1.csv"
    printf ',\n"kernels": '
    json_of_csv "$logs/ncu/hottest.csv"
    printf ',\n"kernels_measured": '
    json_of_csv "$logs/ncu/measured.csv"
    printf '}\n'
  } >"$out/results.json.new" && mv "$out/results.json.new" "$out/results.json"
  page >"$out/results.md.new" && mv "$out/results.md.new" "$out/results.md"
}

# The device that was asked for, by its own name.
device_field() {  # FIELD
  awk -v kind="$device" -v field="$1" -F'"' '
    $2 == "kind" { mine = $4 == kind }
    mine && $2 == field { value = $4; if (value == "") { value = $3; gsub(/[:, ]/, "", value) }; print value; exit }
  ' "$logs/devices.json" 2>/dev/null
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
  if [ -s "$logs/bench/table1.csv" ] && [ "$(wc -l <"$logs/bench/table1.csv")" -gt 1 ]; then
    printf '\n## Build, trace and time to image\n\nMedians over repetitions; peak memory is that of the build.\n\n'
    awk -f "$here/csv.awk" -f "$here/csv_to_table.awk" "$logs/bench/table1.csv"
  fi
  if [ -s "$logs/same.json" ]; then
    printf '\n## Beside the CPU\n\n```text\n'
    cat "$logs/same.txt"
    printf '```\n'
  fi
  if [ -s "$logs/sanitizer.csv" ] && [ "$(wc -l <"$logs/sanitizer.csv")" -gt 1 ]; then
    printf '\n## compute-sanitizer\n\n```text\n'
    cat "$logs/sanitizer.csv"
    printf '```\n'
  fi
  if [ -s "$logs/ncu/hottest.csv" ]; then
    printf '\n## The kernels that take the most time\n\n```text\n'
    cat "$logs/ncu/hottest.csv" "$logs/ncu/measured.csv" 2>/dev/null
    printf '```\n'
  fi
}
