#include "tests/support/cases.h"

#include "builder/registry.h"
#include "tests/support/catch.h"

namespace copse::test {

namespace {

struct Invoker : Catch::ITestInvoker {
  Invoker(void (*test)(const std::string&), const std::string& value) : test(test), value(value) {}
  void invoke() const override { test(value); }

  void (*test)(const std::string&);
  std::string value;
};

}  // namespace

Cases::Cases(const std::string& name, const std::string& tags, const std::vector<std::string>& values,
             void (*test)(const std::string& value)) {
  for (const std::string& value : values) {
    const std::string whole = name + ": " + value;
#if COPSE_CATCH == 3
    auto invoker = Catch::Detail::make_unique<Invoker>(test, value);
    Catch::AutoReg(std::move(invoker), CATCH_INTERNAL_LINEINFO, Catch::StringRef(), {whole, tags});
#else
    Catch::AutoReg(new Invoker(test, value), CATCH_INTERNAL_LINEINFO, Catch::StringRef(), {whole, tags});
#endif
  }
}

std::vector<std::string> builderNames() {
  std::vector<std::string> names;
  for (const BuilderEntry& entry : builders()) names.push_back(entry.name);
  return names;
}

bool isTriedInFull(const std::string& builder) {
  for (const BuilderEntry& entry : builders())
    if (entry.method == findBuilder(builder).method) return builder == entry.name;
  return true;
}

}  // namespace copse::test
