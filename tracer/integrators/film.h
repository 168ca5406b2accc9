// The film: the sum of each pixel's samples, and their mean. Samples come in batches and are numbered through all
// pixels of one sample, in the order of pixel_order.h, before the next begins. A pixel's samples are added by one call
// in the order of their numbers, so the sums depend neither on threads nor on the size of a batch. Only .cu files
// include this.
#pragma once

#include <algorithm>
#include <span>

#include "builder/parallel/buffer.h"
#include "builder/parallel/launch.h"
#include "tracer/integrators/pixel_order.h"

namespace copse {

/// One sample of a batch.
struct FilmSample {
  uint64_t place;   ///< In the batch.
  uint32_t pixel;   ///< Row by row.
  uint64_t number;  ///< Among the pixel's samples, from 0.
};

/// How many samples of the pixel at `place` of the order are among the first `done` of all.
HD inline uint64_t samplesAt(uint64_t done, uint32_t pixels, uint32_t place) {
  return done / pixels + (place < done % pixels ? 1 : 0);
}

namespace detail {

template <class Sum, class Term>
struct AddToFilm {
  Term term;
  uint64_t first;
  uint64_t exactFrom;  ///< Read where there is `lost`.
  uint32_t count, pixels;
  const uint32_t* pixelAt;
  Sum *sums, *lost;

  HD void operator()(uint32_t j) const {
    const uint32_t pixel = pixelAt[(first + j) % pixels];
    Sum sum = sums[pixel];
    if constexpr (requires(Sum a) { a - a; }) {
      if (lost) {
        Sum correction = lost[pixel];
        for (uint64_t place = j; place < count; place += pixels) {
          const uint64_t number = (first + place) / pixels;
          if (number < exactFrom) {
            sum += term({place, pixel, number});
            continue;
          }
          const Sum exact = term({place, pixel, number}) - correction;
          const Sum next = sum + exact;
          correction = (next - sum) - exact;
          sum = next;
        }
        sums[pixel] = sum;
        lost[pixel] = correction;
        return;
      }
    }
    for (uint64_t place = j; place < count; place += pixels) sum += term({place, pixel, (first + place) / pixels});
    sums[pixel] = sum;
  }
};

template <class Sum, class Mean>
struct FinishFilm {
  Mean mean;
  Sum* sums;
  uint64_t done;
  uint32_t pixels;
  const uint32_t* pixelAt;

  HD void operator()(uint32_t place) const {
    const uint32_t pixel = pixelAt[place];
    mean(pixel, sums[pixel], samplesAt(done, pixels, place));
  }
};

}  // namespace detail

/// `Sum` is what is kept of a pixel: trivially copyable, 0 where all its bytes are, with +=. A compensated film, which
/// needs + and - as well, keeps what rounding took from each sum beside it (Kahan 1965): a million floats stay exact to
/// 1e-7 for twice the memory. Which samples it compensates depends on their numbers alone, not on how many will follow,
/// so that a film goes on from the sums of a shorter render.
template <class Sum>
class Film {
 public:
  static constexpr uint64_t never = ~uint64_t{0};

  /// Sums of 0 for the pixels of `order`, which has to outlive the film. A pixel's samples from the number `exactFrom`
  /// on are compensated.
  Film(const Device& device, const PixelOrder& order, uint64_t exactFrom = never)
      : order_(order),
        exactFrom_(exactFrom),
        sums_(device, order.pixels()),
        lost_(device, exactFrom != never ? order.pixels() : 0) {
    sums_.fill(0);
    lost_.fill(0);
  }

  /// Adds term(FilmSample) for each of the `count` samples from number `first` on.
  template <class Term>
  void add(const Device& device, PhaseName phase, uint64_t first, uint32_t count, const Term& term) {
    launch(device, phase, std::min(count, pixels()),
           detail::AddToFilm<Sum, Term>{term, first, exactFrom_, count, pixels(), order_.pixelAt(), sums_.data(),
                                        lost_.data()});
  }

  /// Calls mean(pixel, sum, samples) for each pixel, with the number of its samples once `done` of all are in the film.
  /// `sum` may be written to.
  template <class Mean>
  void finish(const Device& device, PhaseName phase, uint64_t done, const Mean& mean) {
    launch(device, phase, pixels(),
           detail::FinishFilm<Sum, Mean>{mean, sums_.data(), done, pixels(), order_.pixelAt()});
  }

  /// Puts in what sums() and lost() of another film were. `lost` may be empty: nothing was compensated yet.
  void restore(std::span<const Sum> sums, std::span<const Sum> lost) {
    sums_.upload(sums);
    if (!lost_.empty()) lost_.upload(lost);
  }

  uint32_t pixels() const { return static_cast<uint32_t>(sums_.size()); }
  /// By pixel, row by row.
  const Buffer<Sum>& sums() const { return sums_; }
  /// What rounding took from each; empty where nothing is compensated.
  const Buffer<Sum>& lost() const { return lost_; }

 private:
  const PixelOrder& order_;
  uint64_t exactFrom_;
  Buffer<Sum> sums_, lost_;
};

}  // namespace copse
