// Parameters of tracers and the path tracer, along with those of builders.
#include "builder/base/error.h"
#include "tests/support/catch.h"
#include "tracer/accel/persistent.h"
#include "tracer/integrators/parameters.h"
#include "tracer/integrators/path/path_tracer.h"

using namespace copse;

namespace {

/// The text of the InputError that `assignment` gives, or nothing.
std::string refusal(const std::string& assignment) {
  Parameters parameters(tracerParameters());
  try {
    parameters.set(assignment);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("Tracers and the path tracer have parameters, listed after those of builders") {
  const auto all = tracerParameters(), ofBuilders = builderParameters();
  REQUIRE(all.size() > ofBuilders.size());
  std::vector<std::string> names;
  for (const ParameterSpec& spec : all) {
    INFO(spec.name);
    CHECK(spec.ofTree == (names.size() < ofBuilders.size()));
    CHECK(std::count(names.begin(), names.end(), spec.name) == 0);
    CHECK_NOTHROW(Parameters(all).set(spec.name, spec.defaultValue()));
    names.push_back(spec.name);
  }
}

TEST_CASE("A wrong value of a tracer's parameter is refused with the reason") {
  using copse::test::Contains;
  CHECK_THAT(refusal("trace.leave=32"), Contains("0 to 31"));
  CHECK_THAT(refusal("trace.fetch=0"), Contains("1 to 32"));
  CHECK_THAT(refusal("trace.fetch=some"), Contains("integer"));
  CHECK_THAT(refusal("trace.blocks=-1"), Contains("0 to 32"));
  CHECK_THAT(refusal("path.queue=1e6"), Contains("integer"));
  CHECK_THAT(refusal("path.queue=16777217"), Contains("0 to 16777216"));
  CHECK_THAT(refusal("trace.leaf=1"), Contains("did you mean 'trace.leave'"));
}

TEST_CASE("A ray tracer reads what was set, and takes its defaults where only builders have parameters") {
  Parameters chosen(tracerParameters());
  chosen.set("trace.fetch=20");
  chosen.set("path.queue=4096");
  CHECK(PersistentSettings(chosen).leave == 8);
  CHECK(PersistentSettings(chosen).fetch == 20);
  CHECK(pathQueueOf(chosen) == 4096);
  CHECK(PersistentSettings(Parameters()).fetch == 26);
  CHECK(pathQueueOf(Parameters()) == 0);
  CHECK_THROWS_AS(Parameters().set("trace.fetch=20"), InputError);
}
