// The table of parameters, values from outside, presets, and the names of builders.
#include <algorithm>

#include "builder/base/error.h"
#include "builder/build.h"
#include "tests/support/catch.h"

using namespace copse;

namespace {

/// The text of the InputError that `assignment` gives, or nothing.
std::string refusal(const std::string& assignment) {
  Parameters parameters;
  try {
    parameters.set(assignment);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("parameters have the paper's defaults") {
  const Parameters parameters;
  CHECK(parameters.real("sah.traversal") == 3);
  CHECK(parameters.real("sah.intersection") == 2);
  CHECK(parameters.integer("leaf.max") == 8);
  CHECK(parameters.text("leaf.rule") == "sah");
  CHECK(parameters.integer("morton.bits") == 20);
}

TEST_CASE("every default is within its own range and every name is listed once") {
  std::vector<std::string> names;
  for (const ParameterSpec& spec : builderParameters()) {
    INFO(spec.name);
    Parameters parameters;
    CHECK_NOTHROW(parameters.set(spec.name, spec.defaultValue()));
    CHECK(std::string(spec.meaning).size() > 10);
    CHECK(std::count(names.begin(), names.end(), spec.name) == 0);
    names.push_back(spec.name);
  }
}

TEST_CASE("an assignment sets a value of the parameter's type") {
  Parameters parameters;
  parameters.set("leaf.max=4");
  parameters.set("sah.traversal=1.5");
  parameters.set("leaf.rule=count");
  parameters.set("sah.intersection", int64_t{1});  // As TOML reads a number without a point.
  CHECK(parameters.integer("leaf.max") == 4);
  CHECK(parameters.real("sah.traversal") == 1.5);
  CHECK(parameters.text("leaf.rule") == "count");
  CHECK(parameters.real("sah.intersection") == 1);
}

TEST_CASE("a wrong assignment is refused with the reason") {
  using copse::test::Contains;
  CHECK(refusal("leaf.max") == "expected KEY=VALUE, got 'leaf.max'");
  CHECK(refusal("leaf.max=0") == "leaf.max: expected an integer from 1 to 64, got 0");
  CHECK_THAT(refusal("leaf.max=65"), Contains("1 to 64"));
  CHECK_THAT(refusal("leaf.max=99999999999999999999"), Contains("integer"));
  CHECK(refusal("leaf.max=4.5") == "leaf.max: expected an integer from 1 to 64, got 4.5");
  CHECK_THAT(refusal("leaf.max="), Contains("integer") && Contains("got ''"));
  CHECK_THAT(refusal("leaf.max= 4"), Contains("integer"));
  CHECK_THAT(refusal("sah.traversal=cheap"), Contains("expected a number from 0") && Contains("got 'cheap'"));
  CHECK_THAT(refusal("sah.traversal=nan"), Contains("0 to"));
  CHECK_THAT(refusal("sah.traversal=-1"), Contains("0 to"));
  CHECK(refusal("leaf.rule=best") == "leaf.rule: expected one of sah, count, got 'best'");
  CHECK_THAT(refusal("leaf.mx=4"), Contains("did you mean 'leaf.max'"));
  CHECK_THAT(refusal("colour=4"), Contains("list parameters"));
  CHECK_THAT(refusal("=4"), Contains("unknown parameter"));
}

TEST_CASE("a value of the wrong type is refused") {
  Parameters parameters;
  CHECK_THROWS_AS(parameters.set("leaf.max", std::string("4")), InputError);
  CHECK_THROWS_WITH(parameters.set("leaf.max", 4.0), "leaf.max: expected an integer from 1 to 64, got 4.0");
  CHECK_THROWS_AS(parameters.set("leaf.rule", int64_t{1}), InputError);
  CHECK_THROWS_AS(parameters.integer("leaf.most"), InputError);
}

TEST_CASE("what is chosen stands over a builder's preset, and the preset over the defaults") {
  const Method method{.name = "any", .source = "", .meaning = ""};
  const BuilderEntry entry{"small", "", "", &method, {{"leaf.max", 2}, {"sah.traversal", 1.0}}};
  Parameters chosen;
  chosen.set("sah.traversal=5");
  const Parameters both = withPreset(entry, chosen);
  CHECK(both.integer("leaf.max") == 2);
  CHECK(both.real("sah.traversal") == 5);
  CHECK(both.text("leaf.rule") == "sah");
}

TEST_CASE("what a method declares holds together, and each of its names can be chosen") {
  std::vector<std::string> names;
  for (const Method& method : methods::all()) {
    INFO(method.name);
    CHECK(method.build);
    CHECK(std::string(method.source).size() > 4);
    CHECK(std::string(method.meaning).size() > 10);
    for (const ParameterSpec& spec : method.parameters)
      CHECK(std::string(spec.name).compare(0, std::string(method.name).size() + 1, method.name + std::string(".")) ==
            0);
    CHECK((!method.presetsOnly || !method.presets.empty()));
  }
  for (const BuilderEntry& builder : builders()) {
    INFO(builder.name);
    CHECK(std::count(names.begin(), names.end(), builder.name) == 0);
    names.push_back(builder.name);
    const Parameters parameters = withPreset(builder, {});
    for (const auto& [name, value] : builder.preset) CHECK(parameters.value(name) == value);
    CHECK(&findBuilder(builder.name) == &builder);
  }
}

TEST_CASE("a method derives settings from those that were chosen, after its preset") {
  const Method method{
      .name = "any", .source = "", .meaning = "", .derive = [](Parameters& all, const Parameters& chosen) {
        CHECK(all.integer("leaf.max") == 2);
        CHECK_FALSE(chosen.isSet("leaf.max"));
        all.set("morton.bits", 10);
      }};
  const BuilderEntry entry{"small", "", "", &method, {{"leaf.max", 2}}};
  CHECK(withPreset(entry, {}).integer("morton.bits") == 10);
}

TEST_CASE("an unknown builder is refused with the names of those there are") {
  CHECK(std::string(findBuilder("lbvh").name) == "lbvh");
  CHECK_THROWS_WITH(findBuilder("best"), copse::test::Contains("lbvh") && copse::test::Contains("sah"));
}
