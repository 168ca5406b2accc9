// The record of a run that did not take place, as JSON, by an installed Copse.
#include "tracer/session/record.h"

#include <cstdio>

int main() {
  const std::string json = copse::toJson(copse::RunRecord{});
  std::puts(json.c_str());
  return json.find("\"schema\"") == std::string::npos;
}
