// Which channels of an EXR file are its picture: by names alone, as Blender, Nuke, Arnold, pbrt and Copse give them.
// OpenEXR's convention is LAYER.COMPONENT with dots in the layer's name too, and a part's name as its layer.
#pragma once

#include <string>
#include <vector>

namespace copse {

struct ExrPart {
  std::string name;  ///< "" where the file gives none.
  bool deep = false;
  std::vector<std::string> channels;
};

/// Channels of one part for red, green and blue; the same one three times for grey, "" for what is not there and is 0.
struct ExrChoice {
  int part = 0;
  std::string layer;  ///< As a user would name it; "" for channels without a layer.
  std::string channels[3];
};

/// `wanted`: a layer's name, its end after a dot, or a single channel; whole names and right cases come first.
/// For "" it is what has no layer, then the one layer of colours that there is, then the one that is called Combined,
/// Beauty, RGBA or Color. Throws InputError without a file's name, which lists what could be asked for.
ExrChoice chooseExrChannels(const std::vector<ExrPart>& parts, const std::string& wanted);

/// Whether `wanted` names one or several of them.
bool hasExrLayer(const std::vector<ExrPart>& parts, const std::string& wanted);

/// Channels of a part that have no layer count as one.
std::size_t exrLayerCount(const std::vector<ExrPart>& parts);

}  // namespace copse
