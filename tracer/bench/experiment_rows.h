// The rows of an experiment's table, out of its [[builder]] tables. Private to tracer/bench.
#pragma once

#include <functional>
#include <string>

#include "builder/base/toml_keys.h"
#include "tracer/bench/experiment.h"

namespace copse {

/// Appends a row for every [[builder]], several where `set` has lists. Throws InputError "FILE:LINE: what".
void readRows(Experiment& experiment, const toml::table& root, const TomlKeys& keys);

/// Names are parts of a run's key and of file names: calls `fail` for one with a slash or a control character, or one
/// that starts with a dot.
void checkKeyPart(const std::string& name, const char* what, const std::function<void(const std::string&)>& fail);

}  // namespace copse
