// One test case a value: what a table of builders, scenes or inputs is tried with runs side by side, and a failure
// names its row.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace copse::test {

/// Adds the test case "NAME: VALUE" for each value, when it is constructed; so it is a static variable of a test's
/// file.
class Cases {
 public:
  Cases(const std::string& name, const std::string& tags, const std::vector<std::string>& values,
        void (*test)(const std::string& value));
};

/// The names of all builders, in the registry's order.
std::vector<std::string> builderNames();

/// False for a builder that an earlier row of the registry stands for: another preset of the same function. What takes
/// long is tried with those on a sample.
bool isTriedInFull(const std::string& builder);

}  // namespace copse::test
