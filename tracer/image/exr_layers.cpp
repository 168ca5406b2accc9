// Names into layers, and a layer into three channels.
#include "tracer/image/exr_layers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <unordered_map>

#include "builder/base/error.h"
#include "builder/base/text.h"

namespace copse {

namespace {

std::string componentOf(const std::string& channel) { return channel.substr(channel.rfind('.') + 1); }

/// Channels of one part that share what is before the last dot.
struct Layer {
  int part = 0;
  bool deep = false;
  bool hasNoLayer = false;  ///< No dot in its channels' names.
  std::string name;         ///< That of its channels, or of its part where they have none.
  std::vector<std::string> channels;

  /// The channel of that component, the first name that there is, as it is written or in any case; "" where none is.
  std::string channel(std::initializer_list<const char*> names) const {
    for (const char* name : names)
      for (const bool anyCase : {false, true})
        for (const std::string& one : channels)
          if (anyCase ? lowered(componentOf(one)) == lowered(name) : componentOf(one) == name) return one;
    return "";
  }
  std::string red() const { return channel({"R", "red"}); }
  std::string green() const { return channel({"G", "green"}); }
  std::string blue() const { return channel({"B", "blue"}); }
  bool hasAllColours() const { return !red().empty() && !green().empty() && !blue().empty(); }
  bool hasColour() const { return !red().empty() || !green().empty() || !blue().empty(); }
  /// Beside an X, a Y is no luminance but a coordinate.
  bool hasLuminance() const { return !channel({"Y"}).empty() && channel({"X"}).empty(); }
  bool isPicture() const { return !deep && (hasColour() || hasLuminance()); }
};

std::vector<Layer> layersOf(const std::vector<ExrPart>& parts) {
  std::vector<Layer> layers;
  for (int i = 0; i < static_cast<int>(parts.size()); ++i) {
    std::unordered_map<std::string, std::size_t> place;
    for (const std::string& channel : parts[i].channels) {
      const std::size_t dot = channel.rfind('.');
      const bool none = dot == std::string::npos;
      // A single part's name says nothing about the channels in it.
      const std::string name = !none ? channel.substr(0, dot) : parts.size() > 1 ? parts[i].name : "";
      const auto [at, isNew] = place.try_emplace(none ? "" : "." + name, layers.size());
      if (isNew) layers.push_back({i, parts[i].deep, none, name, {}});
      layers[at->second].channels.push_back(channel);
    }
  }
  return layers;
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 24;
  if (names.size() <= most) return fmt::format("{}", fmt::join(names, ", "));
  return fmt::format("{} and {} more", fmt::join(names.begin(), names.begin() + most, ", "), names.size() - most);
}

std::string listed(const std::vector<Layer>& layers) {
  std::vector<std::string> names;
  for (const Layer& layer : layers)
    names.push_back(!layer.name.empty() ? layer.name : fmt::format("({})", fmt::join(layer.channels, ", ")));
  return listed(names);
}

ExrChoice choiceOf(const Layer& layer) {
  const auto fail = [&](const std::string& what) {
    throw InputError(layer.name.empty() ? what : fmt::format("layer {}: {}", layer.name, what));
  };
  if (layer.deep) fail("deep pixels are not supported (expected one value a pixel and channel)");
  const auto three = [&](const std::string& a, const std::string& b, const std::string& c) {
    return ExrChoice{layer.part, layer.name, {a, b, c}};
  };
  if (layer.hasColour()) return three(layer.red(), layer.green(), layer.blue());
  const std::string x = layer.channel({"X", "U"}), y = layer.channel({"Y", "V"}), z = layer.channel({"Z"});
  if (layer.hasLuminance()) {
    if (!layer.channel({"RY"}).empty() || !layer.channel({"BY"}).empty())
      fail("unsupported luminance/chroma image (expected RGB or luminance)");
    const std::string luminance = layer.channel({"Y"});
    return three(luminance, luminance, luminance);
  }
  if (!x.empty() && !y.empty()) return three(x, y, z);
  if (layer.channels.size() == 1) return three(layer.channels[0], layer.channels[0], layer.channels[0]);
  fail(fmt::format("expected channels R, G, B or Y, got {}", listed(layer.channels)));
  return {};
}

template <class Holds>
std::vector<Layer> those(const std::vector<Layer>& layers, Holds holds) {
  std::vector<Layer> found;
  std::ranges::copy_if(layers, std::back_inserter(found), holds);
  return found;
}

bool isCalledPicture(const std::string& name) {
  const std::string last = lowered(componentOf(name));
  for (const char* one : {"combined", "beauty", "rgba", "rgb", "color", "colour"})
    if (last == one) return true;
  return false;
}

ExrChoice chooseByItself(const std::vector<Layer>& layers) {
  for (const Layer& layer : layers)
    if (layer.part == 0 && layer.hasNoLayer && layer.isPicture()) return choiceOf(layer);
  const auto whole = those(layers, [](const Layer& l) { return l.isPicture() && l.hasAllColours(); });
  const auto any = those(layers, [](const Layer& l) { return l.isPicture(); });
  const auto called = those(layers, [](const Layer& l) { return l.isPicture() && isCalledPicture(l.name); });
  for (const std::vector<Layer>& found : {called, whole, any})
    if (found.size() == 1) return choiceOf(found[0]);
  if (!any.empty()) {
    const std::vector<Layer>& several = whole.empty() ? any : whole;
    throw InputError(fmt::format("{} layers of colours (expected one, or --layer with one of: {})", several.size(),
                                 listed(several)));
  }
  for (const Layer& layer : layers)
    if (layer.deep) return choiceOf(layer);
  std::vector<std::string> channels;
  for (const Layer& layer : layers) channels.insert(channels.end(), layer.channels.begin(), layer.channels.end());
  throw InputError(fmt::format("expected channels R, G, B or Y, got {}", channels.empty() ? "none" : listed(channels)));
}

std::vector<Layer> matching(const std::vector<Layer>& layers, const std::string& wanted) {
  // A channel by itself is looked for as a layer that holds it alone.
  std::vector<Layer> channels;
  for (const Layer& layer : layers)
    for (const std::string& channel : layer.channels)
      channels.push_back({layer.part, layer.deep, layer.hasNoLayer, channel, {channel}});
  const std::string small = lowered(wanted);
  const auto isWhole = [&](const Layer& l) { return l.name == wanted; };
  const auto isWholeInAnyCase = [&](const Layer& l) { return lowered(l.name) == small; };
  const auto isEnd = [&](const Layer& l) { return lowered(l.name).ends_with("." + small); };
  for (const std::vector<Layer>& found :
       {those(layers, isWhole), those(channels, isWhole), those(layers, isWholeInAnyCase), those(layers, isEnd),
        those(channels, isWholeInAnyCase)})
    if (!found.empty()) return found;
  return {};
}

}  // namespace

ExrChoice chooseExrChannels(const std::vector<ExrPart>& parts, const std::string& wanted) {
  const std::vector<Layer> layers = layersOf(parts);
  if (wanted.empty()) return chooseByItself(layers);
  const std::vector<Layer> found = matching(layers, wanted);
  if (found.size() == 1) return choiceOf(found[0]);
  if (!found.empty()) throw InputError(fmt::format("'{}' could be {} layers: {}", wanted, found.size(), listed(found)));
  throw InputError(fmt::format("no layer '{}' (available: {})", wanted, layers.empty() ? "none" : listed(layers)));
}

bool hasExrLayer(const std::vector<ExrPart>& parts, const std::string& wanted) {
  return !matching(layersOf(parts), wanted).empty();
}

std::size_t exrLayerCount(const std::vector<ExrPart>& parts) { return layersOf(parts).size(); }

}  // namespace copse
