# Turns results.csv of an experiment whose rows are settings into a Markdown table: one row per setting, with medians
# of every scene. A setting whose tree or number of rays differs from the first one's has changed more than time.
#   awk -f csv.awk -f csv_to_variants.awk results.csv
function median(list,  count, values, i, k, value) {
  count = split(list, values, " ")
  for (i = 2; i <= count; ++i) {
    value = values[i] + 0
    for (k = i - 1; k >= 1 && values[k] + 0 > value; --k) values[k + 1] = values[k]
    values[k + 1] = value
  }
  return count % 2 ? values[(count + 1) / 2] + 0 : (values[count / 2] + values[count / 2 + 1]) / 2
}
function value(name) { return (name in at) ? fields[at[name]] : "" }
NR == 1 { columns = split_csv($0, head); for (i = 1; i <= columns; ++i) at[head[i]] = i; next }
{
  split_csv($0, fields)
  if (value("status") != "done") next
  variant = value("label"); scene = value("scene"); key = variant SUBSEP scene
  rays = value("rays_primary") + value("rays_bounce") + value("rays_shadow")
  if (!known[variant]++) variants[++variant_count] = variant
  if (!seen[scene]++) { scenes[++scene_count] = scene; first_cost[scene] = value("sah_cost"); first_rays[scene] = rays }
  what = value("sah_cost") != first_cost[scene] ? "tree" : rays != first_rays[scene] ? "rays" : ""
  if (what != "" && !told[key]++) other[variant] = other[variant] (other[variant] == "" ? "" : ", ") what " of " scene
  build[key] = build[key] " " value("build_ms")
  trace[key] = trace[key] " " value("mrays_per_s_all")
  total[key] = total[key] " " value("total_ms")
}
END {
  line = "| variant |"; rule = "|---|"
  for (s = 1; s <= scene_count; ++s) {
    line = line " " scenes[s] ": build, ms | Mrays/s | image, ms |"; rule = rule "--:|--:|--:|"
  }
  print line " not the first row's |\n" rule "---|"
  for (v = 1; v <= variant_count; ++v) {
    printf "| %s |", variants[v]
    for (s = 1; s <= scene_count; ++s) {
      key = variants[v] SUBSEP scenes[s]
      if (key in build) printf " %.3f | %.1f | %.2f |", median(build[key]), median(trace[key]), median(total[key])
      else printf " - | - | - |"
    }
    printf " %s |\n", other[variants[v]]
  }
}
