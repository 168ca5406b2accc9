// The options are those of the MTL format's text (Alias|Wavefront, 1995) and two that are found in files.
#include "tracer/scene/io/map_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "builder/base/text.h"

namespace copse {
namespace {

enum class Takes { numbers, number, onOff, word };

struct Option {
  std::string_view name;
  Takes takes;
  int maxNumbers;
  std::string_view harmless;  ///< The argument with which it does nothing.
};

constexpr Option options[] = {
    {"-s", Takes::numbers, 3, ""},           {"-o", Takes::numbers, 3, ""},      {"-t", Takes::numbers, 3, "0"},
    {"-mm", Takes::numbers, 2, "0 1"},       {"-bm", Takes::number, 1, "1"},     {"-boost", Takes::number, 1, "0"},
    {"-texres", Takes::number, 1, ""},       {"-blendu", Takes::onOff, 0, "on"}, {"-blendv", Takes::onOff, 0, "on"},
    {"-clamp", Takes::onOff, 0, "off"},      {"-cc", Takes::onOff, 0, "off"},    {"-imfchan", Takes::word, 0, ""},
    {"-colorspace", Takes::word, 0, "srgb"}, {"-type", Takes::word, 0, ""}};

const Option* findOption(std::string_view word) {
  if (word.empty() || word.front() != '-') return nullptr;
  const auto found = std::ranges::find(options, lowered(word), &Option::name);
  return found == std::end(options) ? nullptr : &*found;
}

/// An option and its arguments.
struct Taken {
  const Option* option;
  std::vector<double> numbers;
  std::string_view written;             ///< From its name to its last argument.
  std::vector<std::string_view> rests;  ///< What follows after 0, 1, … arguments.
};

bool canBe(const Option& option, std::string_view word) {
  double value;
  if (option.takes == Takes::word) return !word.empty();
  if (option.takes == Takes::onOff) return lowered(word) == "on" || lowered(word) == "off";
  return parseNumber(word, value) && std::abs(value) <= 1e30;
}

/// Takes the option in front of `text`, with as many arguments as it may have.
Taken take(const Option& option, std::string_view& text) {
  Taken taken{&option, {}, {}, {}};
  const char* begin = text.data() + text.find('-');
  nextWord(text);
  taken.rests = {text};
  for (int i = 0; i < std::max(option.maxNumbers, 1); ++i) {
    std::string_view after = text;
    const std::string_view word = nextWord(after);
    if (!canBe(option, word)) break;
    double value = 0;
    if (parseNumber(word, value)) taken.numbers.push_back(value);
    text = after;
    taken.rests.push_back(text);
  }
  taken.written = {begin, static_cast<std::size_t>(text.data() - begin)};
  return taken;
}

std::vector<Taken> takeAll(std::string_view& text) {
  std::vector<Taken> all;
  for (;;) {
    std::string_view after = text;
    const Option* option = findOption(nextWord(after));
    if (!option) return all;
    all.push_back(take(*option, text));
  }
}

void apply(const Taken& taken, MapLine& line) {
  const std::string_view name = taken.option->name;
  if (name == "-s" || name == "-o") {
    vec2& target = name == "-s" ? line.scale : line.offset;
    for (std::size_t i = 0; i < std::min<std::size_t>(taken.numbers.size(), 2); ++i)
      target[static_cast<int>(i)] = static_cast<float>(taken.numbers[i]);
    if (taken.numbers.empty()) line.ignored.emplace_back(taken.written);
    return;
  }
  std::string_view arguments = taken.written;
  nextWord(arguments);
  std::string_view harmless = taken.option->harmless;
  bool isHarmless = !harmless.empty();
  for (std::string_view word = nextWord(arguments); !word.empty() && isHarmless; word = nextWord(arguments)) {
    const std::string_view expected = nextWord(harmless);
    double value = 0, wanted = 0;
    // "-t 0 0 0": what is left out is as the last one that is given.
    if (parseNumber(expected.empty() ? taken.option->harmless : expected, wanted) && parseNumber(word, value))
      isHarmless = value == wanted;
    else
      isHarmless = lowered(word) == expected;
  }
  if (!isHarmless) line.ignored.emplace_back(taken.written);
}

/// Options behind the name: from the first one on nothing else may follow.
std::string_view withoutTrailing(std::string_view text, std::vector<Taken>& all) {
  for (std::string_view rest = text; !rest.empty();) {
    std::string_view here = rest;
    if (findOption(nextWord(rest)) == nullptr) continue;
    const std::size_t end = static_cast<std::size_t>(here.data() - text.data());
    std::vector<Taken> behind = takeAll(here);
    if (!trim(here).empty()) {
      rest = here;
      continue;
    }
    all.insert(all.end(), behind.begin(), behind.end());
    return trim(text.substr(0, end));
  }
  return text;
}

}  // namespace

MapLine readMapLine(std::string_view text, const std::function<bool(std::string_view)>& isThere) {
  MapLine line;
  std::vector<Taken> all = takeAll(text);
  std::string_view name = trim(text);
  const bool given = !all.empty() && !isThere(name);
  if (given && all.back().option->takes == Takes::numbers) {
    // A name that begins with a number: the longest that is there.
    Taken& last = all.back();
    for (std::size_t count = 1; count + 1 < last.rests.size(); ++count) {
      if (!isThere(trim(last.rests[count]))) continue;
      name = trim(last.rests[count]);
      last.numbers.resize(count);
      break;
    }
  }
  if (!isThere(name)) {
    name = withoutTrailing(withoutComment(name), all);
    // An option that nobody knows, or another word that does not belong to the name.
    for (std::string_view rest = name; name.starts_with('-') && !rest.empty();) {
      nextWord(rest);
      if (!isThere(trim(rest))) continue;
      line.ignored.emplace_back(trim(name.substr(0, name.size() - rest.size())));
      name = trim(rest);
      break;
    }
  }
  for (const Taken& taken : all) apply(taken, line);
  line.file = name;
  return line;
}

}  // namespace copse
