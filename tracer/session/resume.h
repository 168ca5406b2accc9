// A render that goes on from its EXR: what the file says of itself, whether the render that is asked for is the same
// one, and the film's sums.
#pragma once

#include <string>
#include <vector>

#include "tracer/image/image_io.h"
#include "tracer/integrators/film_state.h"
#include "tracer/session/record.h"

namespace copse {

/// What a render's EXR says of how it was made.
struct EarlierRender {
  std::string file, version, commit, sceneName, sceneHash, tracer;
  ImageRecord image;
  EarlierRuns runs;      ///< With the one that wrote the file.
  uint64_t samples = 0;  ///< Over all pixels.
  bool hasSums = false;  ///< In channels of their own; otherwise the means must give them.
};

/// Reads no pixels. Throws InputError "FILE: why", as where it was not rendered by Copse or lacks what is needed.
EarlierRender readEarlierRender(const std::string& file);

/// Throws InputError that names the file and all that differs: the integrator, the settings but spp, and those of the
/// arguments that are not null. The camera is in the coordinates of the scene's files, as the record's is: see
/// inFiles().
void checkSameRender(const EarlierRender& earlier, const std::string& integrator, const RenderSettings& settings,
                     const Camera* camera = nullptr, const uint64_t* sceneHash = nullptr);
/// The same of what rays go through: a tracer with trees of its own, such as Embree, finds its own points of
/// intersection. "" for none.
void checkSameTracer(const EarlierRender& earlier, const std::string& tracer);

/// The film's sums. Throws InputError where the file does not give them to the last bit.
FilmState readFilm(const EarlierRender& earlier);

/// The sums as channels: `sum.R`, and where the film is compensated `lost.R`, and so on.
std::vector<Channel> filmChannels(const FilmState& film);

}  // namespace copse
