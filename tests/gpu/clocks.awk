# Turns nvidia-smi dmon's lines, one per second, into a CSV: one row per part of the run, over the card's busy seconds.
#   awk -f clocks.awk parts.tsv dmon.txt        parts.tsv: part, begin and end as HH:MM:SS
function middle(list, count,  values, i, k, value) {
  count = split(list, values, " ")
  for (i = 2; i <= count; ++i) {
    value = values[i] + 0
    for (k = i - 1; k >= 1 && values[k] + 0 > value; --k) values[k + 1] = values[k]
    values[k + 1] = value
  }
  least = values[1]; most = values[count]
  return values[int((count + 1) / 2)]
}
function seconds(text,  t) { split(text, t, ":"); return t[1] * 3600 + t[2] * 60 + t[3] }
FNR == NR { split($0, f, "\t"); part[++parts] = f[1]; from[parts] = seconds(f[2]); to[parts] = seconds(f[3]); next }
/^#.*pclk/ { sub(/^# */, ""); count = split($0, names, " "); for (i = 1; i <= count; ++i) at[tolower(names[i])] = i; next }
/^#/ || !("pclk" in at) || !("time" in at) { next }
{
  now = seconds($(at["time"]))
  for (p = 1; p <= parts; ++p) {
    # A run over midnight ends before it begins.
    if (from[p] <= to[p] ? now < from[p] || now > to[p] : now < from[p] && now > to[p]) continue
    ++all[p]
    if ($(at["sm"]) + 0 == 0) continue
    clock[p] = clock[p] " " $(at["pclk"]); memory[p] = memory[p] " " $(at["mclk"]); power[p] = power[p] " " $(at["pwr"])
    ++busy[p]
  }
}
END {
  print "part,seconds,busy_seconds,clock_mhz,clock_least,clock_most,memory_mhz,watt"
  for (p = 1; p <= parts; ++p) {
    if (!all[p]) continue
    if (!busy[p]) { printf "%s,%d,0,,,,,\n", part[p], all[p]; continue }
    c = middle(clock[p]); low = least; high = most
    printf "%s,%d,%d,%d,%d,%d,%d,%d\n", part[p], all[p], busy[p], c, low, high, middle(memory[p]), middle(power[p])
  }
}
