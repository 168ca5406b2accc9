// The determinant in doubles where its error bound leaves no doubt, else as an exact sum of its six products.
#include "tracer/scene/io/orientation.h"

#include <cmath>

namespace copse {
namespace {

/// A sum of doubles that do not overlap, by increasing magnitude, so that the last has the sign of all.
class ExactSum {
 public:
  void addProduct(double x, double y) {
    const double product = x * y;
    add(product);
    add(std::fma(x, y, -product));
  }
  double estimate() const { return size_ ? terms_[size_ - 1] : 0; }

 private:
  void add(double value) {
    int kept = 0;
    for (int i = 0; i < size_; ++i) {
      const double sum = value + terms_[i], part = sum - value;
      const double error = (value - (sum - part)) + (terms_[i] - part);
      if (error != 0) terms_[kept++] = error;
      value = sum;
    }
    if (value != 0) terms_[kept++] = value;
    size_ = kept;
  }

  double terms_[12];
  int size_ = 0;
};

}  // namespace

double orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x), area = left - right;
  if (left == 0 && right == 0) return 0;
  constexpr double bound = 3.3306690738754716e-16;  // Shewchuk's (3 + 16 u) u, u being 2^-53.
  if (std::abs(area) > bound * (std::abs(left) + std::abs(right))) return area;
  ExactSum sum;
  sum.addProduct(a.x, b.y);
  sum.addProduct(-a.y, b.x);
  sum.addProduct(b.x, c.y);
  sum.addProduct(-b.y, c.x);
  sum.addProduct(c.x, a.y);
  sum.addProduct(-c.y, a.x);
  return sum.estimate();
}

}  // namespace copse
