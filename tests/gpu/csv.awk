# Fields of a line of CSV, quoted or not (RFC 4180, but no line breaks within a field).
function split_csv(line, fields,  count, field, c, i, quoted) {
  count = 0; field = ""; quoted = 0
  for (i = 1; i <= length(line); ++i) {
    c = substr(line, i, 1)
    if (quoted) {
      if (c == "\"" && substr(line, i + 1, 1) == "\"") { field = field c; ++i }
      else if (c == "\"") quoted = 0
      else field = field c
    } else if (c == "\"") quoted = 1
    else if (c == ",") { fields[++count] = field; field = "" }
    else field = field c
  }
  fields[++count] = field
  return count
}
