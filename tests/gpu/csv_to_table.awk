# Turns table1.csv of `copse report` into a Markdown table: one row per scene and method.
#   awk -f csv.awk -f csv_to_table.awk table1.csv
function number(name, digits) {
  return (name in at) && fields[at[name]] != "" ? sprintf("%." digits "f", fields[at[name]]) : "-"
}
NR == 1 {
  columns = split_csv($0, head)
  line = "| scene | triangles | method | SAH cost | build, ms | Mtriangles/s | peak, B per triangle | Mrays/s |"
  rule = "|---|--:|---|--:|--:|--:|--:|--:|"
  for (i = 1; i <= columns; ++i) {
    at[head[i]] = i
    if (head[i] ~ /^total_[0-9]+spp_ms$/) {
      spp = head[i]; gsub(/[^0-9]/, "", spp)
      line = line " ms at " spp " spp |"; rule = rule "--:|"; totals[++total_count] = head[i]
    }
  }
  print line "\n" rule
  next
}
{
  split_csv($0, fields)
  if (fields[at["method"]] ~ /, ideal$/) next
  build = fields[at["build_ms"]]
  speed = build > 0 ? sprintf("%.1f", fields[at["triangles"]] / build / 1000) : "-"
  printf "| %s | %s | %s | %s | %s | %s | %s | %s |", fields[at["scene"]], fields[at["triangles"]], \
    fields[at["method"]], number("sah_cost", 2), number("build_ms", 3), speed, \
    number("build_peak_bytes_per_triangle", 0), number("trace_mrays_s", 1)
  for (i = 1; i <= total_count; ++i) printf " %s |", number(totals[i], 2)
  print ""
}
