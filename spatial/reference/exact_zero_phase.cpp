// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/reference/exact_zero_phase.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>

namespace tacto::spatial::reference {
namespace {

using Real = long double;
using Complex = std::complex<Real>;
constexpr Real kPi = std::numbers::pi_v<Real>;

// Direct form I in its textbook notation: state is the previous inputs and outputs.
void run(std::span<const ExactSection> sections, std::vector<Real>& values) {
  Real level = values.front();
  for (const ExactSection& s : sections) {
    const Real settled = level * (s.b0 + s.b1 + s.b2) / (1 + s.a1 + s.a2);
    Real x1 = level, x2 = level, y1 = settled, y2 = settled;
    for (Real& value : values) {
      const Real x = value;
      value = s.b0 * x + s.b1 * x1 + s.b2 * x2 - s.a1 * y1 - s.a2 * y2;
      x2 = x1, x1 = x, y2 = y1, y1 = value;
    }
    level = settled;
  }
}

Real gain_of(const ExactSection& s, Real turns) {
  const Complex back = std::polar<Real>(1, -2 * kPi * turns);
  return std::abs((s.b0 + back * (s.b1 + back * s.b2)) / (Real{1} + back * (s.a1 + back * s.a2)));
}

}  // namespace

std::vector<ExactSection> exact_butterworth(int order, Band band, double sample_rate_hz) {
  const Real low = std::tan(kPi * band.low_hz / sample_rate_hz);
  const Real high = std::tan(kPi * band.high_hz / sample_rate_hz);
  const Real width = high - low, square = low * high, centre = std::atan(std::sqrt(square)) / kPi;
  std::vector<ExactSection> sections;
  const auto add = [&](Complex pole0, Complex pole1) {
    const Complex z0 = (Real{1} + pole0) / (Real{1} - pole0), z1 = (Real{1} + pole1) / (Real{1} - pole1);
    ExactSection s{1, 0, -1, -(z0 + z1).real(), (z0 * z1).real()};
    const Real gain = 1 / gain_of(s, centre);
    s.b0 = gain, s.b2 = -gain;
    sections.push_back(s);
  };
  for (int k = 0; 2 * k < order; ++k) {
    const Complex pole = std::polar<Real>(1, kPi * (2 * k + order + 1) / (2 * order));
    const Complex half = pole * width / Real{2}, root = std::sqrt(half * half - square);
    if (2 * k + 1 == order) {
      add(half + root, half - root);
    } else {
      add(half + root, std::conj(half + root));
      add(half - root, std::conj(half - root));
    }
  }
  return sections;
}

std::vector<ExactSection> widened(std::span<const Section> sections) {
  std::vector<ExactSection> wide;
  for (const Section& s : sections) wide.push_back({s.b0, s.b1, s.b2, s.a1, s.a2});
  return wide;
}

std::vector<double> exact_zero_phase(std::span<const ExactSection> sections, std::span<const double> values,
                                     std::size_t padding) {
  assert(padding < values.size());
  const std::size_t n = values.size();
  std::vector<Real> extended;
  for (std::size_t k = padding; k >= 1; --k)
    extended.push_back(2 * static_cast<Real>(values[0]) - static_cast<Real>(values[k]));
  extended.insert(extended.end(), values.begin(), values.end());
  for (std::size_t k = 1; k <= padding; ++k)
    extended.push_back(2 * static_cast<Real>(values[n - 1]) - static_cast<Real>(values[n - 1 - k]));
  for (int way = 0; way < 2; ++way) {
    run(sections, extended);
    std::ranges::reverse(extended);
  }
  const auto first = extended.begin() + static_cast<std::ptrdiff_t>(padding);
  return {first, first + static_cast<std::ptrdiff_t>(n)};
}

}  // namespace tacto::spatial::reference
