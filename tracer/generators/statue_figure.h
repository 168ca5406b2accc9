// The sculpture as a distance field: a robed figure with a bowl on a round pedestal. Metres, y up, it faces +z and
// stands at y = 0, the pedestal's top.
#pragma once

#include <array>
#include <vector>

#include "tracer/generators/random.h"
#include "tracer/generators/surface_nets.h"

namespace copse::generator {

class Figure : public DistanceField {
 public:
  enum Part : uint32_t { marble, bronze, granite, parts };

  explicit Figure(uint64_t seed);

  double distance(const dvec3& p) const override;
  double steepness() const override { return 1.9; }
  dvec3 lowest() const override { return {-0.62, -0.62, -0.62}; }
  dvec3 highest() const override { return {0.62, 1.92, 0.62}; }
  /// What it is made of there.
  Part partAt(const dvec3& p) const;

 private:
  double robe(const dvec3& p) const;
  double shawl(const dvec3& p) const;
  double shawlEnd(const dvec3& p) const;
  double arms(const dvec3& p) const;
  double head(const dvec3& p) const;
  double hair(const dvec3& p) const;
  double bowl(const dvec3& p) const;
  double pedestal(const dvec3& p) const;
  std::array<double, parts> distances(const dvec3& p) const;
  double roughness(const dvec3& p) const;

  struct Fold {
    double waves, phase, drift, depth;
  };
  std::vector<Fold> folds_;
  std::vector<dvec3> curls_;
  uint64_t grain_;
  double turn_;
};

}  // namespace copse::generator
