# From results.csv of one experiment the rows of time_variants' table; with csv.awk before it.
#   -v variant=NAME -v settings=TEXT -v round=N [-v headed=1]
function quoted(text) { gsub(/"/, "\"\"", text); return "\"" text "\"" }
function value(name) { return (name in at) ? fields[at[name]] : "" }
BEGIN {
  if (headed) print "variant,settings,round,scene,repetition,build_ms,render_ms,total_ms,mrays_per_s,sah_cost,rays"
}
NR == 1 { columns = split_csv($0, head); for (i = 1; i <= columns; ++i) at[head[i]] = i; next }
{
  split_csv($0, fields)
  if (value("status") != "done") next
  printf "%s,%s,%d,%s,%s,%s,%s,%s,%s,%s,%.0f\n", quoted(variant), quoted(settings), round, quoted(value("scene")), \
    value("repetition"), value("build_ms"), value("render_ms"), value("total_ms"), value("mrays_per_s_all"), \
    value("sah_cost"), value("rays_primary") + value("rays_bounce") + value("rays_shadow")
}
