// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/calibrate/mains.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "capture/calibrate/hann_line.hpp"
#include "data-schema/base/decibels.hpp"

namespace tacto::capture {
namespace {

constexpr double kLineToFloorPower = 18;  // power relative to the mean of the neighbours
constexpr int kHarmonics = 6, kNearest = 4, kFurthest = 13;

struct Samples {
  std::span<const double> values;
  double rate_hz;

  double bin_hz() const { return rate_hz / static_cast<double>(values.size()); }
  double amplitude_at(double frequency_hz) const {
    return amplitude_of(hann_line(values, frequency_hz / rate_hz), values.size());
  }
};

// The mains frequency deviates by about 0.1 Hz, its harmonics by more.
double highest_near(const Samples& samples, double frequency_hz) {
  double highest = 0;
  for (int half = -4; half <= 4; ++half)
    highest = std::max(highest, samples.amplitude_at(frequency_hz + 0.5 * half * samples.bin_hz()));
  return highest;
}

double mean_power_around(const Samples& samples, double frequency_hz) {
  double sum = 0;
  for (int bin = kNearest; bin <= kFurthest; ++bin)
    for (const int side : {-1, 1})
      sum += std::pow(samples.amplitude_at(frequency_hz + side * bin * samples.bin_hz()), 2);
  return sum / (2 * (kFurthest - kNearest + 1));
}

std::optional<MainsLine> line_at(const Samples& samples, double frequency_hz) {
  const double amplitude = highest_near(samples, frequency_hz);
  const double floor = mean_power_around(samples, frequency_hz), power = amplitude * amplitude;
  if (!(power > kLineToFloorPower * floor) || power == 0) return std::nullopt;
  return MainsLine{frequency_hz, amplitude, schema::power_db(power / std::max(floor, 1e-300))};
}

std::vector<MainsLine> family(const Samples& samples, double base_hz, double highest_hz) {
  std::vector<MainsLine> lines;
  for (int harmonic = 1; harmonic <= kHarmonics && harmonic * base_hz < highest_hz; ++harmonic)
    if (const auto line = line_at(samples, harmonic * base_hz)) lines.push_back(*line);
  return lines;
}

double power_of(const std::vector<MainsLine>& lines) {
  double power = 0;
  for (const MainsLine& line : lines) power += line.amplitude * line.amplitude;
  return power;
}

}  // namespace

std::vector<MainsLine> mains_lines(std::span<const double> samples, double sample_rate_hz,
                                   double native_rate_hz) {
  const Samples all{samples, sample_rate_hz};
  const double highest_hz = 0.45 * std::min(sample_rate_hz, native_rate_hz);
  auto fifty = family(all, 50, highest_hz), sixty = family(all, 60, highest_hz);
  return power_of(fifty) >= power_of(sixty) ? fifty : sixty;
}

}  // namespace tacto::capture
