// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/reference/exact_hermite.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tacto::spatial::reference {
namespace {

constexpr int kHalvings = 120;

}  // namespace

ExactHermite::ExactHermite(std::span<const double> t, std::span<const double> x)
    : t_(t.begin(), t.end()), x_(x.begin(), x.end()) {
  assert(t.size() == x.size() && t.size() >= 2);
}

// The slopes of Fritsch and Butland 1984, with those of SciPy at the ends.
long double ExactHermite::slope(std::size_t i) const {
  const auto width = [&](std::size_t k) { return t_[k + 1] - t_[k]; };
  const auto secant = [&](std::size_t k) { return (x_[k + 1] - x_[k]) / width(k); };
  const std::size_t last = t_.size() - 1;
  if (last == 1) return secant(0);
  if (i == 0 || i == last) {
    const std::size_t near = i == 0 ? 0 : last - 1, far = i == 0 ? 1 : last - 2;
    const long double parabola = ((2 * width(near) + width(far)) * secant(near) - width(near) * secant(far)) /
                                 (width(near) + width(far));
    if (parabola * secant(near) <= 0) return 0;
    const bool turns = secant(near) * secant(far) <= 0;
    return turns && std::abs(parabola) > std::abs(3 * secant(near)) ? 3 * secant(near) : parabola;
  }
  if (secant(i - 1) * secant(i) <= 0) return 0;
  const long double before = 2 * width(i) + width(i - 1), after = width(i) + 2 * width(i - 1);
  return (before + after) / (before / secant(i - 1) + after / secant(i));
}

long double ExactHermite::value(long double t) const {
  const auto above = std::upper_bound(t_.begin() + 1, t_.end() - 1, t);
  const auto i = static_cast<std::size_t>(above - t_.begin()) - 1;
  const long double h = t_[i + 1] - t_[i], u = (t - t_[i]) / h, v = 1 - u;
  // The four Hermite polynomials in their textbook form.
  return x_[i] * (1 + 2 * u) * v * v + x_[i + 1] * u * u * (3 - 2 * u) + h * slope(i) * u * v * v -
         h * slope(i + 1) * u * u * v;
}

long double ExactHermite::inverse(long double x) const {
  long double low = t_.front(), high = t_.back();
  for (int i = 0; i < kHalvings; ++i) {
    const long double middle = (low + high) / 2;
    (value(middle) < x ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace tacto::spatial::reference
