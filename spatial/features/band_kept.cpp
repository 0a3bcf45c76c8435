// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/features/band_kept.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <vector>

#include "data-schema/base/raised_cosine.hpp"
#include "spatial/dsp/fourier/fft.hpp"
#include "spatial/features/steady_part.hpp"

namespace tacto::spatial {
namespace {

constexpr std::size_t kFewestKeptSamples = 8;

struct PowerAt {
  double per_m = 0, power = 0;
};

// A line at frequency f has the transform H(k - f) under a window h, and 2 pi i (k - f) H(k - f) under the
// derivative h'. Their ratio gives f.
std::vector<PowerAt> reassigned_powers(const schema::SpaceSignal& signal) {
  const std::size_t count = signal.values.size();
  const double length_m = static_cast<double>(count) * signal.pitch_m;
  const double turn = 2 * std::numbers::pi / static_cast<double>(count);
  const double mean =
      std::accumulate(signal.values.begin(), signal.values.end(), 0.0) / static_cast<double>(count);
  RealFft fft(count);
  std::vector<double> windowed(count), sloped(count);
  for (std::size_t n = 0; n < count; ++n) {
    const double value = signal.values[n] - mean, angle = turn * static_cast<double>(n);
    windowed[n] = value * schema::rising_cosine(angle);
    sloped[n] = value * 0.5 * std::sin(angle) / length_m;  // h' / (2 pi)
  }
  std::vector<std::complex<double>> under_window(fft.bins()), under_slope(fft.bins());
  fft.forward(windowed, under_window);
  fft.forward(sloped, under_slope);
  std::vector<PowerAt> powers;
  for (std::size_t k = 0; k < fft.bins(); ++k) {
    const bool twin = k != 0 && 2 * k != count;  // the negative frequency has the same power
    if (const double power = (twin ? 2 : 1) * std::norm(under_window[k]); power > 0)
      powers.push_back(
          {static_cast<double>(k) / length_m - (under_slope[k] / under_window[k]).imag(), power});
  }
  return powers;
}

}  // namespace

double band_kept_percent(const schema::Texture& texture, double speed_mps, const Band& band) {
  const schema::SpaceSignal signal = steady_part(texture).texture.signal;
  if (signal.values.size() < kFewestKeptSamples) return 100;
  const double lowest_per_m = 1 / signal.length_m();
  double all = 0, kept = 0;
  for (const PowerAt& each : reassigned_powers(signal)) {
    if (each.per_m < lowest_per_m) continue;
    all += each.power;
    const double hz = each.per_m * speed_mps;
    if (hz >= band.low_hz && hz <= band.high_hz) kept += each.power;
  }
  return all > 0 ? 100 * kept / all : 100;
}

}  // namespace tacto::spatial
