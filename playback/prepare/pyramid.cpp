// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/pyramid.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "data-schema/base/raised_cosine.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::playback {
namespace {

using Ends = wire::ProfileEnds;

constexpr double kMostPaddingM = 20e-3;
constexpr double kMostDrift = 2e-5;  // of a period: 2 pi times that, 1.3e-4 of the amplitude

std::size_t continued_size(const schema::SpaceSignal& signal, Ends ends) {
  const std::size_t size = signal.values.size();
  if (ends == Ends::loop) return size;
  if (ends == Ends::mirror) return 2 * (size - 1);
  const auto padding = static_cast<std::size_t>(kMostPaddingM / signal.pitch_m);
  return spatial::fast_length(size + std::min(size, padding));
}

std::vector<double> continued(const schema::SpaceSignal& signal, Ends ends) {
  std::vector<double> values = signal.values;
  const std::size_t size = values.size();
  values.resize(continued_size(signal, ends), 0.0);
  if (ends == Ends::mirror)
    for (std::size_t i = size; i < values.size(); ++i) values[i] = values[values.size() - i];
  return values;
}

/// The grid of the first level over the whole period, and the number of samples kept.
struct LevelGrid {
  std::size_t period = 0, kept = 0;
  double pitch_m = 0;
};

// The error of the last place in finest periods if a count is rounded to 2^-32 samples.
double drift_of(std::size_t period, double period_m, double length_m, const PyramidShape& shape) {
  const double per_count = std::ldexp(shape.metres_per_count * static_cast<double>(period) / period_m, 32);
  if (!(per_count > 0)) return 0;
  return std::abs(std::round(per_count) / per_count - 1) * length_m * shape.finest_per_m;
}

// If a count of a fine encoder is a small part of a sample, a few more samples may reduce its rounding.
std::size_t steps_that_fit(std::size_t least, std::size_t step, double period_m, double length_m,
                           const PyramidShape& shape) {
  const std::size_t fast = spatial::fast_length(least);
  std::size_t best = fast;
  double least_drift = drift_of(step * best, period_m, length_m, shape);
  for (std::size_t steps = fast; steps <= fast + fast / 16 && least_drift > kMostDrift; ++steps) {
    const double drift = drift_of(step * steps, period_m, length_m, shape);
    if (drift >= least_drift) continue;
    best = steps;
    least_drift = drift;
  }
  return best;
}

LevelGrid first_grid(const schema::SpaceSignal& signal, const PyramidShape& shape) {
  const double period_m = static_cast<double>(continued_size(signal, shape.ends)) * signal.pitch_m;
  // In a mirror, half the period has a whole number of steps on each level, too.
  const std::size_t step = std::size_t{shape.ends == Ends::mirror ? 2U : 1U} << ((shape.levels - 1) / 2);
  const double needed = period_m * shape.finest_per_m * shape.samples_per_period / static_cast<double>(step);
  const auto steps = static_cast<std::size_t>(std::ceil(std::max(needed, 8.0)));
  LevelGrid grid;
  grid.period = step * steps_that_fit(steps, step, period_m, signal.length_m(), shape);
  grid.pitch_m = period_m / static_cast<double>(grid.period);
  if (shape.ends == Ends::loop) grid.kept = grid.period;
  if (shape.ends == Ends::mirror) grid.kept = grid.period / 2 + 1;
  if (shape.ends == Ends::stop) {
    const auto whole =
        static_cast<std::size_t>(std::floor(signal.length_m() / (grid.pitch_m * static_cast<double>(step))));
    grid.kept = whole * step + 1;
  }
  return grid;
}

core::ProfileScale scale_of_levels(const LevelGrid& grid, const PyramidShape& shape) {
  core::ProfileScale scale;
  scale.samples = static_cast<std::uint32_t>(grid.kept);
  scale.ends = shape.ends;
  scale.levels = static_cast<std::uint8_t>(shape.levels);
  return scale;
}

double passed(double per_m, double pass_per_m) {
  const double beside = (per_m / pass_per_m - 1) / (kStopOverPass - 1);
  return schema::falling_cosine(std::numbers::pi * std::clamp(beside, 0.0, 1.0));
}

std::vector<double> level_of(std::span<const std::complex<double>> spectrum, std::size_t length,
                             double per_m_per_bin, double pass_per_m, std::size_t period) {
  spatial::RealFft fft(period);
  std::vector<std::complex<double>> bins(fft.bins());
  const double scale = static_cast<double>(period) / static_cast<double>(length);
  for (std::size_t k = 0; k < std::min(bins.size(), spectrum.size()); ++k)
    bins[k] = spectrum[k] * scale * passed(static_cast<double>(k) * per_m_per_bin, pass_per_m);
  std::vector<double> values(period);
  fft.inverse(bins, values);
  return values;
}

}  // namespace

std::size_t pyramid_size(const schema::SpaceSignal& signal, const PyramidShape& shape) {
  return core::pyramid_samples(scale_of_levels(first_grid(signal, shape), shape));
}

Pyramid make_pyramid(const schema::SpaceSignal& signal, const PyramidShape& shape) {
  const std::vector<double> values = continued(signal, shape.ends);
  const LevelGrid grid = first_grid(signal, shape);
  const core::ProfileScale scale = scale_of_levels(grid, shape);
  spatial::RealFft fft(values.size());
  std::vector<std::complex<double>> spectrum(fft.bins());
  fft.forward(values, spectrum);
  const double per_m_per_bin = 1 / (static_cast<double>(values.size()) * signal.pitch_m);
  Pyramid pyramid{{}, grid.kept, grid.pitch_m, 0};
  for (int level = 0; level < shape.levels; ++level) {
    const double pass_per_m = shape.finest_per_m * std::exp2(-0.5 * level);
    const auto copy =
        level_of(spectrum, values.size(), per_m_per_bin, pass_per_m, grid.period >> (level / 2));
    const auto kept = core::level_samples(scale, static_cast<std::uint8_t>(level));
    for (std::size_t i = 0; i < kept; ++i) pyramid.samples.push_back(static_cast<float>(copy[i]));
    ++pyramid.levels;
  }
  return pyramid;
}

}  // namespace tacto::playback
