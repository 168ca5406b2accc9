// One test case per value: the cases of a table of builders, scenes or inputs run in parallel, and a failure names its
// row.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace copse::test {

/// Adds the test case "NAME: VALUE" for each value, when it is constructed: make it a static variable of a test file.
class Cases {
 public:
  Cases(const std::string& name, const std::string& tags, const std::vector<std::string>& values,
        void (*test)(const std::string& value));
};

/// The names of all builders, in the registry's order.
std::vector<std::string> builderNames();

/// False for a preset of a method that an earlier row of the registry covers. Long tests run these on a sample only.
bool isTriedInFull(const std::string& builder);

}  // namespace copse::test
