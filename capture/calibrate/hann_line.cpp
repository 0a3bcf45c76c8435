// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/calibrate/hann_line.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

namespace tacto::capture {
namespace {

// e^(2 pi i cycles n) for n = 0, 1, ... In real arithmetic: std::complex products also test for infinities.
struct Rotor {
  explicit Rotor(double cycles)
      : step_re(std::cos(2 * std::numbers::pi * cycles)), step_im(std::sin(2 * std::numbers::pi * cycles)) {}
  void turn() {
    const double turned = re * step_re - im * step_im;
    im = re * step_im + im * step_re;
    re = turned;
  }
  double step_re, step_im, re = 1, im = 0;
};

}  // namespace

std::complex<double> hann_line(std::span<const double> samples, double cycles) {
  const auto count = static_cast<double>(samples.size());
  const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / count;
  Rotor line(-cycles), window(1 / count);
  double re = 0, im = 0;
  for (const double sample : samples) {
    const double weighted = (sample - mean) * 0.5 * (1 - window.re);
    re += weighted * line.re;
    im += weighted * line.im;
    line.turn();
    window.turn();
  }
  return {re, im};
}

double amplitude_of(std::complex<double> line, std::size_t samples) {
  return std::abs(line) * 4 / static_cast<double>(samples);
}

double density_of(std::complex<double> line, std::size_t samples, double sample_rate_hz) {
  return std::norm(line) * 16 / (3 * static_cast<double>(samples) * sample_rate_hz);
}

}  // namespace tacto::capture
