// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/reference/exact_target.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "data-schema/base/raised_cosine.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::playback {
namespace {

constexpr double kPaddingPeriods = 30;
constexpr double kLeastPaddingS = 1;
constexpr double kReadingMargin = 2.2;
constexpr std::size_t kMostReadings = std::size_t{1} << 24;

double rising(double u) {
  return schema::rising_cosine(std::numbers::pi * u);
}

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Fades from rest to the readings over `onset` readings.
template <class Iterator>
void soften(Iterator first, std::size_t onset, double rest) {
  for (std::size_t i = 0; i < onset; ++i, ++first)
    *first = rest + (*first - rest) * rising(static_cast<double>(i) / static_cast<double>(onset));
}

// Fills the padding with a transition from the end's rest to the start's, so slow that it has no content in
// the band.
void fill_padding(std::span<double> padding, double from, double to) {
  const auto steps = static_cast<double>(padding.size());
  for (std::size_t i = 0; i < padding.size(); ++i)
    padding[i] = from + (to - from) * rising((static_cast<double>(i) + 0.5) / steps);
}

// The first `count` readings are of the path, the others are padding.
void settle_ends(std::span<double> readings, std::size_t count, std::size_t onset, std::size_t longest_period,
                 const Rests& rests) {
  const std::size_t averaged = std::min(count, longest_period);
  const auto path = readings.first(count);
  const double start = rests.start ? *rests.start : mean_of(path.first(averaged));
  const double end = rests.end ? *rests.end : mean_of(path.last(averaged));
  soften(path.begin(), onset, start);
  soften(path.rbegin(), onset, end);
  fill_padding(readings.subspan(count), end, start);
}

// Bins of the readings up to half the result's rate, scaled to the result's length: exact decimation of the
// band.
PaddedSpectrum decimated(const PaddedSpectrum& fine, const ReadingGrid& grid) {
  PaddedSpectrum coarse{grid.rate_hz, grid.samples, grid.period, fine.bins};
  coarse.bins.resize(grid.period / 2 + 1);
  for (auto& bin : coarse.bins) bin /= static_cast<double>(grid.oversampling);
  return coarse;
}

}  // namespace

ReadingGrid reading_grid(double duration_s, double rate_hz, const spatial::Band& band, double finest_hz) {
  ReadingGrid grid;
  grid.rate_hz = rate_hz;
  // A path of 2 s at 10 kHz has 20,001 samples, although rounding may make 2.0 * 10e3 smaller.
  grid.samples = static_cast<std::size_t>(std::floor(duration_s * rate_hz * (1 + 1e-12))) + 1;
  const double padding_s = std::max(kLeastPaddingS, kPaddingPeriods / band.low_hz);
  grid.period = spatial::fast_length(grid.samples + static_cast<std::size_t>(padding_s * rate_hz));
  const double needed = std::max(1.0, kReadingMargin * finest_hz / rate_hz);
  const std::size_t most = std::max<std::size_t>(1, kMostReadings / grid.period);
  grid.capped = needed > static_cast<double>(most);
  grid.oversampling = grid.capped ? most : spatial::fast_length(static_cast<std::size_t>(std::ceil(needed)));
  return grid;
}

std::vector<double> reading_places(const FingerPath& path, const ReadingGrid& grid) {
  return positions_along(path, grid.reading_rate_hz(), (grid.samples - 1) * grid.oversampling + 1);
}

PaddedSpectrum target_of_readings(std::vector<double> readings, const ReadingGrid& grid,
                                  const spatial::Band& band, double onset_s, const Rests& rests) {
  const double rate_hz = grid.reading_rate_hz();
  const std::size_t count = readings.size();
  readings.resize(grid.period * grid.oversampling);
  settle_ends(readings, count, static_cast<std::size_t>(onset_s * rate_hz),
              static_cast<std::size_t>(rate_hz / band.low_hz), rests);
  auto target = decimated(spectrum_of(readings, rate_hz, readings.size()), grid);
  keep_band(target, band);
  return target;
}

PaddedSpectrum exact_target(const TextureLookup& texture, const FingerPath& path, const ReadingGrid& grid,
                            const spatial::Band& band, double gain_m_per_n, double onset_s) {
  std::vector<double> readings = reading_places(path, grid);
  for (double& value : readings) value = gain_m_per_n * texture(value);
  return target_of_readings(std::move(readings), grid, band, onset_s);
}

schema::SpaceSignal unrolled_loop(const schema::SpaceSignal& loop, double length_m) {
  schema::SpaceSignal unrolled;
  unrolled.pitch_m = loop.pitch_m;
  const auto samples = static_cast<std::size_t>(length_m / loop.pitch_m) + 1;
  for (std::size_t i = 0; i < samples; ++i) unrolled.values.push_back(loop.values[i % loop.values.size()]);
  return unrolled;
}

}  // namespace tacto::playback
