// Ellipsoids, tapered limbs and rings, blended where they meet, with waves for the cloth's folds and a fine roughness
// of tool marks over all. Far from a part the distance to a sphere around it stands for the part's own.
#include "tracer/generators/statue_figure.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace copse::generator {

namespace {

constexpr double pi = std::numbers::pi;

/// The union of two, rounded where they are within `k` of each other.
double blend(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - 0.25 * k * h * h;
}

/// `a` without `b`, rounded.
double carve(double a, double b, double k) { return -blend(-a, b, k); }

double sphere(const dvec3& p, const dvec3& centre, double radius) { return glm::length(p - centre) - radius; }

double ellipsoid(const dvec3& p, const dvec3& centre, const dvec3& radii) {
  const dvec3 q = (p - centre) / radii, r = q / radii;
  const double k = glm::length(q), slope = glm::length(r);
  return slope > 0 ? k * (k - 1) / slope : -std::min({radii.x, radii.y, radii.z});
}

/// From a to b, as thick as r0 at a and r1 at b, with round ends.
double limb(const dvec3& p, const dvec3& a, const dvec3& b, double r0, double r1) {
  const dvec3 along = b - a;
  const double t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
  return glm::length(p - a - t * along) - (r0 + (r1 - r0) * t);
}

/// A ring of that thickness around the y axis through `centre`.
double ring(const dvec3& p, double y, double radius, double thickness) {
  const double out = std::sqrt(p.x * p.x + p.z * p.z) - radius;
  return std::sqrt(out * out + (p.y - y) * (p.y - y)) - thickness;
}

/// A disc around the y axis with an edge rounded by `round`.
double disc(const dvec3& p, double y0, double y1, double radius, double round) {
  const double out = std::sqrt(p.x * p.x + p.z * p.z) - radius + round;
  const double up = std::abs(p.y - 0.5 * (y0 + y1)) - 0.5 * (y1 - y0) + round;
  const double a = std::max(out, 0.0), b = std::max(up, 0.0);
  return std::sqrt(a * a + b * b) + std::min(std::max(out, up), 0.0) - round;
}

dvec3 mirrored(const dvec3& p) { return {std::abs(p.x), p.y, p.z}; }

/// Smooth between values at the corners of a unit lattice, in [-1, 1].
double noise(const dvec3& p, uint64_t seed) {
  const dvec3 cell(std::floor(p.x), std::floor(p.y), std::floor(p.z));
  dvec3 t = p - cell;
  t = t * t * (3.0 - 2.0 * t);
  double value[8];
  for (int c = 0; c < 8; ++c) {
    const auto at = [&](int axis, int bit) { return static_cast<uint64_t>(static_cast<int64_t>(cell[axis]) + bit); };
    const uint64_t key =
        at(0, c & 1) * 0x9e3779b1u ^ at(1, c >> 1 & 1) * 0x85ebca77c2b2ae63ull ^ at(2, c >> 2) * 0xc2b2ae3d27d4eb4full;
    value[c] = static_cast<double>(mix(seed ^ key) >> 11) * 0x1p-52 - 1;
  }
  for (int c = 0; c < 4; ++c) value[c] = value[2 * c] + (value[2 * c + 1] - value[2 * c]) * t.x;
  for (int c = 0; c < 2; ++c) value[c] = value[2 * c] + (value[2 * c + 1] - value[2 * c]) * t.y;
  return value[0] + (value[1] - value[0]) * t.z;
}

double ramp(double x, double from, double to) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

const dvec3 skull{0, 1.64, 0.0}, skullRadii{0.083, 0.105, 0.1}, bun{0, 1.765, -0.03};
constexpr double bunRadius = 0.045;

}  // namespace

Figure::Figure(uint64_t seed) {
  Random random(seed, 0x57a7e);
  for (const double waves : {5.0, 9.0, 14.0, 21.0}) {
    const double phase = random.between(0, 2 * pi), drift = random.between(-1.2, 1.2);
    folds_.push_back({waves, phase, drift, 0.15 / (waves + 2)});
  }
  turn_ = random.between(0, 2 * pi);
  grain_ = mix(seed + 0x6a41);
  // Curls along a spiral over the skull, those before the hairline left out, and over the knot above.
  constexpr int count = 190;
  const auto spiral = [&](int i, int n) {
    const double y = 1 - 2 * (i + 0.5) / n, r = std::sqrt(1 - y * y), a = turn_ + 2.399963229728653 * i;
    return dvec3(r * std::cos(a), y, r * std::sin(a));
  };
  for (int i = 0; i < count; ++i) {
    const dvec3 d = spiral(i, count);
    const double hairline = d.z > 0 ? 0.42 + 0.2 * d.z : -0.42 + 0.9 * std::max(0.0, 0.35 + d.z);
    if (d.y > hairline) curls_.push_back(skull + d * (skullRadii + 0.004));
  }
  for (int i = 0; i < 40; ++i) curls_.push_back(bun + bunRadius * spiral(i, 40));
}

/// A gown that widens downwards, in deep folds below and shallow ones above.
double Figure::robe(const dvec3& p) const {
  const double sway = 0.022 * std::sin(2.1 * p.y + 0.4);
  const dvec3 q(p.x - sway, p.y, p.z * 1.18);
  const double r = std::sqrt(q.x * q.x + q.z * q.z), angle = std::atan2(q.z, q.x);
  const double y = p.y;
  double radius = 0.335 - 0.15 * ramp(y, 0, 0.98) + 0.035 * ramp(y, 0.95, 1.25) + 0.07 * (1 - ramp(y, 0, 0.18));
  const double depth = 0.25 + 0.75 * (1 - ramp(y, 0.25, 1.15));
  for (const Fold& fold : folds_) {
    const double s =
        std::sin(fold.waves * angle + fold.phase + fold.drift * y * 2.2 + 0.5 * std::sin(3 * y + fold.phase));
    radius += fold.depth * depth * (1 - std::sqrt(s * s + 0.02)) * 1.25;
  }
  radius -= 0.012 * std::exp(-900 * (y - 1.0) * (y - 1.0));  // The girdle.
  const double side = (r - radius) * 0.8, ends = std::max(0.0 - y, y - 1.36);
  return -blend(-side, -ends, 0.08);
}

/// Cloth from the right shoulder around the left hip: rings that lie across the body, one above the other.
double Figure::shawl(const dvec3& p) const {
  double d = 1e9;
  static const dvec3 across = glm::normalize(dvec3(0.62, 0.78, 0.12));
  static const dvec3 u = glm::normalize(glm::cross(across, dvec3(0, 0, 1))), v = glm::cross(u, across);
  for (int i = 0; i < 7; ++i) {
    const dvec3 centre(0.012, 1.0 + 0.046 * i, 0.004);
    const dvec3 q = p - centre;
    const double a = glm::dot(q, u) / (1.3 - 0.045 * i), b = glm::dot(q, v) * 1.12, c = glm::dot(q, across);
    const double wave = 0.012 * std::sin(3 * a / 0.1 + i * 1.7 + turn_);
    const double out = std::sqrt(a * a + b * b) - 0.205 - 0.003 * (i % 3);
    d = blend(d, std::sqrt(out * out + (c - wave) * (c - wave)) - 0.019 - 0.004 * (i % 2), 0.022);
  }
  return d * 0.85;
}

/// The shawl's end, which hangs from the left forearm.
double Figure::shawlEnd(const dvec3& p) const {
  const double wave = 0.008 * std::sin(90 * p.x + 30 * p.z) * (1 - ramp(p.y, 0.75, 1.05));
  return 0.85 * (limb(p, {0.285, 1.05, 0.1}, {0.315, 0.52, 0.13}, 0.038, 0.058) + wave);
}

double Figure::arms(const dvec3& p) const {
  const dvec3 q = mirrored(p);
  double d = limb(q, {0.04, 1.43, -0.01}, {0.19, 1.36, -0.005}, 0.07, 0.075);
  d = blend(d, limb(q, {0.2, 1.34, 0}, {0.275, 1.09, 0.05}, 0.068, 0.056), 0.06);
  d = blend(d, limb(q, {0.275, 1.09, 0.05}, {0.115, 1.105, 0.235}, 0.056, 0.034), 0.04);
  // Wide sleeves that fall from the forearm, with ripples.
  const double ripple = 0.006 * std::sin(60 * q.x - 25 * q.z + 18 * q.y);
  d = blend(d, limb(q, {0.25, 1.06, 0.07}, {0.205, 0.86, 0.125}, 0.06, 0.045) + ripple, 0.06);
  // Hands around the bowl: a palm and four fingers each.
  d = blend(d, ellipsoid(q, {0.098, 1.105, 0.262}, {0.022, 0.036, 0.034}), 0.03);
  for (int i = 0; i < 4; ++i) {
    const double y = 1.08 + 0.017 * i;
    d = blend(d, limb(q, {0.106, y, 0.275}, {0.082, y - 0.012, 0.338}, 0.0105, 0.0085), 0.008);
  }
  return blend(d, limb(q, {0.1, 1.135, 0.255}, {0.088, 1.165, 0.29}, 0.012, 0.009), 0.012);
}

double Figure::head(const dvec3& p) const {
  const dvec3 q = mirrored(p);
  double d = ellipsoid(q, skull, skullRadii);
  d = blend(d, ellipsoid(q, {0, 1.585, 0.036}, {0.06, 0.08, 0.066}), 0.05);
  d = blend(d, ellipsoid(q, {0.036, 1.578, 0.068}, {0.024, 0.03, 0.022}), 0.03);       // cheeks
  d = blend(d, limb(q, {0, 1.655, 0.09}, {0.045, 1.65, 0.073}, 0.012, 0.009), 0.018);  // brow
  d = carve(d, sphere(q, {0.032, 1.629, 0.107}, 0.019), 0.014);
  d = blend(d, ellipsoid(q, {0.032, 1.628, 0.082}, {0.017, 0.0115, 0.012}), 0.003);
  d = blend(d, limb(q, {0.014, 1.638, 0.092}, {0.049, 1.634, 0.08}, 0.0038, 0.0028), 0.004);  // lids
  d = blend(d, limb(q, {0, 1.64, 0.094}, {0, 1.598, 0.113}, 0.008, 0.0125), 0.012);
  d = blend(d, sphere(q, {0.011, 1.594, 0.104}, 0.008), 0.008);
  d = blend(d, limb(q, {0, 1.567, 0.0985}, {0.021, 1.564, 0.09}, 0.0062, 0.003), 0.006);
  d = blend(d, limb(q, {0, 1.556, 0.0965}, {0.017, 1.558, 0.09}, 0.0068, 0.003), 0.005);
  d = blend(d, sphere(q, {0, 1.527, 0.08}, 0.021), 0.03);
  d = blend(d, ellipsoid(q, {0.085, 1.613, 0.0}, {0.011, 0.034, 0.02}), 0.008);
  d = carve(d, ellipsoid(q, {0.096, 1.617, 0.004}, {0.007, 0.019, 0.011}), 0.006);
  return blend(d, limb(q, {0, 1.4, -0.015}, {0, 1.56, 0.0}, 0.056, 0.05), 0.035);
}

double Figure::hair(const dvec3& p) const {
  double d = sphere(p, bun, bunRadius);
  for (const dvec3& curl : curls_) {
    const dvec3 q = p - curl;
    const double squared = glm::dot(q, q);
    if (squared > 0.05 * 0.05) continue;
    // A groove around each: a snail of hair.
    const double r = std::sqrt(squared);
    d = blend(d, r - 0.0145 - 0.0012 * std::cos(420 * r), 0.004);
  }
  // A band that ties the knot.
  return std::min({d, ring(p - dvec3(0, 0, -0.022), 1.731, 0.04, 0.009), glm::length(p - skull) - 0.0});
}

double Figure::bowl(const dvec3& p) const {
  const dvec3 q = p - dvec3(0, 1.16, 0.27);
  double d = std::max(sphere(q, {0, 0, 0}, 0.094), q.y);
  d = carve(d, sphere(q, {0, 0.012, 0}, 0.086), 0.006);
  d = blend(d, ring(q, 0, 0.0925, 0.0065), 0.006);
  d = blend(d, ring(q, -0.042, 0.0835, 0.004), 0.003);
  d = blend(d, disc(q, -0.118, -0.085, 0.042, 0.006), 0.02);
  // A flame within.
  const double twist = 0.006 * std::sin(70 * q.y + 3 * turn_);
  return std::min(d, limb(q, {twist, -0.06, 0}, {0.4 * twist, 0.05, 0}, 0.04, 0.012));
}

/// Mouldings, a drum with a band of leaves, and a square-cut foot.
double Figure::pedestal(const dvec3& p) const {
  double d = disc(p, -0.06, 0.008, 0.44, 0.014);
  d = blend(d, ring(p, -0.08, 0.405, 0.03), 0.012);
  d = blend(d, disc(p, -0.42, -0.06, 0.375, 0.01), 0.02);
  d = blend(d, ring(p, -0.405, 0.405, 0.036), 0.012);
  d = blend(d, ring(p, -0.455, 0.44, 0.026), 0.008);
  d = blend(d, disc(p, -0.56, -0.46, 0.5, 0.016), 0.012);
  // Twenty-two petals, each a pointed bulge with a rib.
  constexpr double petals = 22;
  const double angle = std::atan2(p.z, p.x), step = 2 * pi / petals;
  for (int row = 0; row < 2; ++row) {
    const double local = (angle / step + 0.5 * row - std::floor(angle / step + 0.5 * row) - 0.5) * step;
    const double r = std::sqrt(p.x * p.x + p.z * p.z), x = r * std::sin(local), z = r * std::cos(local);
    const double base = row ? -0.37 : -0.35, tip = row ? -0.19 : -0.13;
    const double t = std::clamp((p.y - base) / (tip - base), 0.0, 1.0);
    const double narrow = 0.047 * std::sqrt(std::max(0.02, 1 - t * t * t));
    dvec3 q(x / narrow, (p.y - 0.5 * (base + tip)) / (0.5 * (tip - base)), (z - 0.375 - 0.02 * t * t) / 0.026);
    const double bulge = (glm::length(q) - 1) * 0.02;
    d = blend(d, bulge + 0.0025 * std::exp(-x * x * 40000), 0.008);
  }
  return d;
}

std::array<double, Figure::parts> Figure::distances(const dvec3& p) const {
  // A part is asked only near its sphere; blends reach no farther than `near`.
  constexpr double near = 0.1;
  const auto within = [&](const dvec3& centre, double radius, const auto& part) {
    const double outside = glm::length(p - centre) - radius;
    return outside > near ? outside : part();
  };
  double cloth = within({0, 0.68, 0}, 0.83, [&] { return robe(p); });
  cloth = blend(cloth, within({0, 1.13, 0}, 0.4, [&] { return shawl(p); }), 0.02);
  cloth = blend(cloth, within({0.3, 0.78, 0.12}, 0.34, [&] { return shawlEnd(p); }), 0.02);
  cloth = blend(cloth, within({0, 1.15, 0.12}, 0.42, [&] { return arms(p); }), 0.035);
  const double face = within({0, 1.58, 0.01}, 0.22, [&] { return head(p); });
  const double curls = within({0, 1.67, -0.01}, 0.17, [&] { return hair(p); });
  const double vessel = within({0, 1.12, 0.27}, 0.13, [&] { return bowl(p); });
  const double base = within({0, -0.28, 0}, 0.6, [&] { return pedestal(p); });
  return {blend(cloth, face, 0.025), std::min(curls, vessel), base};
}

/// Tool marks and wear: less than two millimetres.
double Figure::roughness(const dvec3& p) const {
  return 0.0012 * noise(23.0 * p, grain_) + 0.0003 * noise(67.0 * p, grain_ + 1) +
         0.00007 * noise(190.0 * p, grain_ + 2);
}

double Figure::distance(const dvec3& p) const {
  const std::array<double, parts> d = distances(p);
  const double solid = blend(blend(d[marble], d[bronze], 0.004), d[granite], 0.012);
  return std::abs(solid) < 0.006 ? solid + roughness(p) : solid;
}

Figure::Part Figure::partAt(const dvec3& p) const {
  const std::array<double, parts> d = distances(p);
  return static_cast<Part>(std::min_element(d.begin(), d.end()) - d.begin());
}

}  // namespace copse::generator
