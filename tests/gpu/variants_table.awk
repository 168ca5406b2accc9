# variants.csv of time_variants to a Markdown table: a row a variant, and of every scene the medians. A variant whose tree
# or number of rays is not the first one's has changed more than time. With csv.awk before it.
function median(list,  count, values, i, k, value) {
  count = split(list, values, " ")
  for (i = 2; i <= count; ++i) {
    value = values[i] + 0
    for (k = i - 1; k >= 1 && values[k] + 0 > value; --k) values[k + 1] = values[k]
    values[k + 1] = value
  }
  return count % 2 ? values[(count + 1) / 2] + 0 : (values[count / 2] + values[count / 2 + 1]) / 2
}
NR == 1 { columns = split_csv($0, head); for (i = 1; i <= columns; ++i) at[head[i]] = i; next }
{
  split_csv($0, fields)
  variant = fields[at["variant"]]; scene = fields[at["scene"]]; key = variant SUBSEP scene
  if (!(variant in known)) { known[variant] = 1; variants[++variant_count] = variant; settings[variant] = fields[at["settings"]] }
  if (!(scene in seen)) { seen[scene] = 1; scenes[++scene_count] = scene; cost[scene] = fields[at["sah_cost"]]; rays[scene] = fields[at["rays"]] }
  what = fields[at["sah_cost"]] != cost[scene] ? "tree" : fields[at["rays"]] != rays[scene] ? "rays" : ""
  if (what != "" && !told[key]++) other[variant] = other[variant] (other[variant] == "" ? "" : ", ") what " of " scene
  build[key] = build[key] " " fields[at["build_ms"]]
  trace[key] = trace[key] " " fields[at["mrays_per_s"]]
  total[key] = total[key] " " fields[at["total_ms"]]
}
END {
  if (!variant_count) exit
  line = "| variant | settings |"; rule = "|---|---|"
  for (s = 1; s <= scene_count; ++s) {
    line = line " " scenes[s] ": build, ms | Mrays/s | image, ms |"; rule = rule "--:|--:|--:|"
  }
  print line " not the first row's |\n" rule "---|"
  for (v = 1; v <= variant_count; ++v) {
    printf "| %s | %s |", variants[v], settings[variants[v]] == "" ? "" : "`" settings[variants[v]] "`"
    for (s = 1; s <= scene_count; ++s) {
      key = variants[v] SUBSEP scenes[s]
      if (key in build) printf " %.3f | %.1f | %.2f |", median(build[key]), median(trace[key]), median(total[key])
      else printf " - | - | - |"
    }
    printf " %s |\n", other[variants[v]]
  }
}
