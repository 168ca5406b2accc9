# Compares builds with the minimum time that the card's maximum rates allow: a CSV, one row per scene and method.
#   awk -f csv.awk -f least.awk -v copy=GB/s -v instructions=1e12/s least.csv table1.csv
# least.csv has, from docs/gpu-kernels.md, the bytes per triangle of phases limited by bytes and the instructions of
# those limited by instructions. A build of `copse bench` ends where rays can begin: their conversion is added.
BEGIN { conversion = 266; print "scene,method,triangles,build_ms,least_ms,of_least" }
FNR == 1 { split("", at); columns = split_csv($0, head); for (i = 1; i <= columns; ++i) at[head[i]] = i; next }
{ split_csv($0, fields); method = fields[at["method"]] }
FNR == NR { bytes[method] = fields[at["bytes"]] + conversion; needed[method] = fields[at["instructions"]]; next }
(method in bytes) && fields[at["build_ms"]] > 0 && copy > 0 && instructions > 0 {
  triangles = fields[at["triangles"]]
  least = triangles * (bytes[method] / (copy * 1e9) + needed[method] / (instructions * 1e12)) * 1e3
  printf "%s,%s,%d,%.3f,%.3f,%.2f\n", fields[at["scene"]], method, triangles, fields[at["build_ms"]], least, \
    fields[at["build_ms"]] / least
}
