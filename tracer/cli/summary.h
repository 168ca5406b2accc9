// The summary of a run: tables on standard output, made of the record alone.
#pragma once

#include <string>

#include "tracer/session/record.h"

namespace copse::cli {

/// Scene, device, tree, then a row per phase and the time to image. `also` names further files that were written.
void printSummary(const RunRecord& record, const std::string& also = "");

/// The lines about scene, device and tree, as printSummary and `copse build` start.
void printHead(const RunRecord& record);
void printBuildPhases(const RunRecord& record);

}  // namespace copse::cli
