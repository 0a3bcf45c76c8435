// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/butterworth.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "data-schema/base/quantity.hpp"

namespace tacto::spatial {
namespace {

using Complex = std::complex<double>;
constexpr int kHighestOrder = 20;

// The analog band that the bilinear transform maps to the digital band, in units of 2 sample_rate_hz.
struct AnalogBand {
  double width, centre;
};

AnalogBand prewarped(Band band, double sample_rate_hz) {
  const double low = std::tan(std::numbers::pi * band.low_hz / sample_rate_hz);
  const double high = std::tan(std::numbers::pi * band.high_hz / sample_rate_hz);
  return {high - low, std::sqrt(low * high)};
}

// The two band-pass poles of one pole of the unit low-pass: the roots of s^2 - pole width s + centre^2.
std::pair<Complex, Complex> band_pass_poles(Complex pole, AnalogBand band) {
  const Complex half = pole * band.width / 2.0;
  const Complex root = std::sqrt(half * half - band.centre * band.centre);
  // The larger root by the formula, the other one from their product: no cancellation in wide bands.
  const Complex large = std::abs(half + root) > std::abs(half - root) ? half + root : half - root;
  return {large, band.centre * band.centre / large};
}

// A section with this pair of analog poles, zeros at 0 Hz and at half the rate, and gain 1 at the centre.
Section section_of(Complex pole0, Complex pole1, AnalogBand band) {
  const Complex z0 = (1.0 + pole0) / (1.0 - pole0), z1 = (1.0 + pole1) / (1.0 - pole1);
  Section section{1, 0, -1, -(z0 + z1).real(), (z0 * z1).real()};
  const double centre_turns = std::atan(band.centre) / std::numbers::pi;
  const double gain = 1 / std::abs(section.response(centre_turns, 1));
  section.b0 = gain;
  section.b2 = -gain;
  return section;
}

// Pole k of the unit Butterworth low-pass; those with k < order / 2 are above the real axis, the middle one
// is on it.
Complex low_pass_pole(int k, int order) {
  return std::polar(1.0, std::numbers::pi * (2 * k + order + 1) / (2 * order));
}

std::vector<Section> design(int order, AnalogBand band) {
  std::vector<Section> sections;
  for (int k = 0; k < order / 2; ++k) {
    const auto [first, second] = band_pass_poles(low_pass_pole(k, order), band);
    sections.push_back(section_of(first, std::conj(first), band));
    sections.push_back(section_of(second, std::conj(second), band));
  }
  if (order % 2 == 1) {
    const auto [first, second] = band_pass_poles(-1, band);
    sections.push_back(section_of(first, second, band));
  }
  return sections;
}

}  // namespace

schema::Result<std::vector<Section>> butterworth_band_pass(int order, Band band, double sample_rate_hz) {
  using schema::ErrorKind;
  if (order < 1 || order > kHighestOrder)
    return schema::fail(ErrorKind::usage,
                        fmt::format("a Butterworth filter of order {} is not possible", order), {},
                        fmt::format("use an order from 1 to {}", kHighestOrder));
  if (!(band.low_hz > 0 && band.low_hz < band.high_hz && band.high_hz < sample_rate_hz / 2))
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("a Butterworth band-pass from {:g} Hz to {:g} Hz is not possible", band.low_hz,
                    band.high_hz),
        {},
        fmt::format("the band limits must increase and be above 0 Hz and below half the sample rate, {:g} Hz",
                    sample_rate_hz / 2));
  return design(order, prewarped(band, sample_rate_hz));
}

Band zero_phase_band(int order, Band band, double sample_rate_hz, double amplitude) {
  const auto [width, centre] = prewarped(band, sample_rate_hz);
  // The unit low-pass keeps `amplitude` up to w, so the band-pass does where (s^2 + centre^2) / (width s) = i
  // w.
  const double half = std::pow(1 / amplitude - 1, 0.5 / order) * width / 2, root = std::hypot(half, centre);
  const auto digital = [&](double analog) { return std::atan(analog) / std::numbers::pi * sample_rate_hz; };
  return {digital(centre * centre / (half + root)), digital(half + root)};
}

}  // namespace tacto::spatial
