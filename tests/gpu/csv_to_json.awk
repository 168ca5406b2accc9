# Turns a CSV with a header into a JSON array of objects: numbers bare, empty fields left out, all else as text.
#   awk -f csv.awk -f csv_to_json.awk [-v only=NAME,NAME] FILE.csv
function text_of(value) {
  gsub(/\\/, "\\\\", value); gsub(/"/, "\\\"", value); gsub(/\t/, " ", value); gsub(/\r/, "", value)
  return "\"" value "\""
}
function json_of(value) {
  return value ~ /^-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][-+]?[0-9]+)?$/ ? value : text_of(value)
}
BEGIN {
  wanted_count = split(only, list, ",")
  for (i = 1; i <= wanted_count; ++i) wanted[list[i]] = 1
  printf "["
}
NR == 1 { columns = split_csv($0, head); next }
{
  count = split_csv($0, fields)
  printf "%s\n  {", rows++ ? "," : ""
  written = 0
  for (i = 1; i <= count && i <= columns; ++i)
    if (fields[i] != "" && (!wanted_count || head[i] in wanted))
      printf "%s%s: %s", written++ ? ", " : "", text_of(head[i]), json_of(fields[i])
  printf "}"
}
END { print "\n]" }
