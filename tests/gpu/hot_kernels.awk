# What ncu writes as CSV, for hot_kernels; with csv.awk before it.
#   -v task=hottest: durations of all launches; prints "total TAB row" per kernel, to be sorted
#   -v task=measured -v wanted=METRIC,… [-v headed=1]: one launch; prints its row, with a header line before it
function quoted(text) { gsub(/"/, "\"\"", text); return "\"" text "\"" }
function plain(number) { gsub(/,/, "", number); return number }  # ncu groups digits.
/^"ID",/ { columns = split_csv($0, head); for (i = 1; i <= columns; ++i) at[head[i]] = i; next }
!columns || !/^"[0-9]/ { next }  # What the program says, and the line of units.
{ split_csv($0, fields); name = fields[at["Kernel Name"]] }
task == "hottest" {
  ns = plain(fields[at["gpu__time_duration.sum"]]) + 0
  total[name] += ns; all += ns; ++launches[name]
  if (!(name in id) || ns > longest[name]) { longest[name] = ns; id[name] = fields[at["ID"]] }
}
task == "measured" {
  count = split(wanted, names, ",")
  if (headed) { printf "kernel"; for (i = 1; i <= count; ++i) printf ",%s", names[i]; print "" }
  printf "%s", quoted(name)
  for (i = 1; i <= count; ++i) printf ",%s", (names[i] in at) ? plain(fields[at[names[i]]]) : ""
  print ""
}
END {
  for (name in total)
    printf "%.0f\t%s,%d,%.4f,%.2f,%d,%.4f\n", total[name], quoted(name), launches[name], total[name] / 1e6, \
      100 * total[name] / all, id[name], longest[name] / 1e6
}
