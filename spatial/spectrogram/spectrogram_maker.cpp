// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/spectrogram/spectrogram_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "data-schema/base/quantity.hpp"
#include "spatial/dsp/spectrum/window.hpp"
#include "spatial/spectrogram/known_band.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;
using schema::Result;
using schema::Scaling;
using schema::SpectrogramHeader;
using schema::Texture;

// The largest cell: files hold unit^2 mm, a thousand times this number.
constexpr float kLargestCell = 3e35F;

// Rounded down to three digits, so that a window of the suggested length fits.
double rounded_down(double length_m) {
  const double digit = std::pow(10.0, std::floor(std::log10(length_m)) - 2);
  return std::floor(length_m / digit * (1 + 1e-12)) * digit;
}

// The factor on X, for one-sided bins: density = (factor |X|)^2, amplitude = factor |X|.
double gain_of(Scaling scaling, std::span<const double> window, double pitch_m) {
  if (scaling == Scaling::amplitude) return 2 / std::accumulate(window.begin(), window.end(), 0.0);
  return std::sqrt(2 * pitch_m / std::inner_product(window.begin(), window.end(), window.begin(), 0.0));
}

ShortTimeTransform transform_for(const SpectrogramOptions& options, const FrameShape& shape,
                                 const Decimation& decimation, double pitch_m, std::size_t rows) {
  const auto window = blackman(shape.window);
  return {shape,
          decimation,
          window,
          gain_of(options.scaling, window, pitch_m),
          options.detrend == Detrend::constant,
          rows};
}

Result<void> check_length(const Texture& texture, std::size_t window) {
  const auto& signal = texture.signal;
  if (signal.values.size() >= window) return {};
  const double have_m = static_cast<double>(signal.values.size()) * signal.pitch_m;
  return schema::fail(
      ErrorKind::unsuitable,
      fmt::format("the texture of {} is shorter than the window of {}", schema::length_for_people(have_m),
                  schema::length_for_people(static_cast<double>(window) * signal.pitch_m)),
      "texture",
      signal.values.size() < kShortestWindow
          ? "it is too short for any window"
          : fmt::format("use a window of {} or less", schema::length_for_people(rounded_down(have_m))));
}

Result<void> check_finite(const Texture& texture) {
  const auto& values = texture.signal.values;
  const auto bad = std::ranges::find_if(values, [](double v) { return !std::isfinite(v); });
  if (bad == values.end()) return {};
  return schema::fail(ErrorKind::unsuitable, "a value is not finite",
                      fmt::format("sample {}", bad - values.begin()),
                      "make the texture again from a recording without gaps");
}

Result<void> check_pitch(const Texture& texture, double pitch_m) {
  if (std::abs(texture.signal.pitch_m - pitch_m) <= 1e-9 * pitch_m) return {};
  return schema::fail(
      ErrorKind::unsuitable,
      fmt::format("has a grid of {}, not {}", schema::length_for_people(texture.signal.pitch_m),
                  schema::length_for_people(pitch_m)),
      "texture", "make one spectrogram of each, or make textures with equal grids ('spatial --grid')");
}

constexpr double kFaintest = 1e-12;
constexpr const char* kUseAmplitudes =
    "use 'tactograph spectrogram --scaling amplitude', or import the recording in a suitable unit";

Result<void> check_cells(std::span<const float> cells) {
  if (std::ranges::all_of(cells, [](float cell) { return cell <= kLargestCell; })) return {};
  return schema::fail(ErrorKind::unsuitable, "its densities do not fit single precision", "texture",
                      kUseAmplitudes);
}

// Densities are squares: for very small forces all of them would be zero in single precision.
Result<void> check_faintness(const Texture& texture, Scaling scaling) {
  if (scaling == Scaling::amplitude) return {};
  double largest = 0;
  for (const double value : texture.signal.values) largest = std::max(largest, std::abs(value));
  if (largest == 0 || largest >= kFaintest) return {};
  return schema::fail(
      ErrorKind::unsuitable,
      fmt::format("its largest value is {:.3g} {}, whose densities do not fit single precision", largest,
                  texture.unit),
      "texture", kUseAmplitudes);
}

}  // namespace

SpectrogramMaker::SpectrogramMaker(const SpectrogramOptions& options, const FrameShape& shape,
                                   const Decimation& decimation, double pitch_m, std::size_t rows)
    : options_(options),
      shape_(shape),
      decimation_(decimation),
      pitch_m_(pitch_m),
      transform_(transform_for(options, shape, decimation, pitch_m, rows)),
      cells_(schema::rows_at_once(shape.bins) * shape.bins) {}

Result<SpectrogramMaker> SpectrogramMaker::prepare(const SpectrogramOptions& options, double pitch_m,
                                                   std::size_t rows) {
  const auto shape = frame_shape(options, pitch_m);
  TACTO_TRY(shape);
  const Decimation decimation =
      options.resolution == Resolution::whole ? Decimation{} : decimation_for(*shape);
  return SpectrogramMaker(options, *shape, decimation, pitch_m, rows);
}

Result<SpectrogramHeader> SpectrogramMaker::describe(const Texture& texture) const {
  TACTO_TRY(check_pitch(texture, pitch_m_));
  TACTO_TRY(check_length(texture, shape_.window));
  TACTO_TRY(check_finite(texture));
  TACTO_TRY(check_faintness(texture, options_.scaling));
  SpectrogramHeader header;
  const std::size_t rows = transform_.rows_of(texture.signal.values.size());
  for (std::size_t row = 0; row < rows; ++row) {
    const double samples = static_cast<double>(row * shape_.hop) + 0.5 * static_cast<double>(shape_.window);
    header.position_m.push_back(texture.signal.origin_m + samples * pitch_m_);
  }
  header.bins = shape_.bins;
  header.frequency_step_per_m = 1 / (static_cast<double>(shape_.padded) * pitch_m_);
  header.scaling = options_.scaling;
  header.quantity = texture.quantity;
  header.unit = texture.unit;
  header.window = "blackman";
  header.coherent_gain = kBlackmanMean;
  header.detrend = options_.detrend == Detrend::constant ? "constant" : "none";
  header.window_m = static_cast<double>(shape_.window) * pitch_m_;
  header.hop_m = static_cast<double>(shape_.hop) * pitch_m_;
  header.pitch_m = pitch_m_;
  header.padded_samples = shape_.padded;
  header.decimation = decimation_.factor;
  header.simulated = texture.simulated;
  header.known = known_bands(texture.valid_band, header.position_m, header.window_m);
  return header;
}

// Zero and half the sampling frequency have no counterpart at negative frequencies.
void SpectrogramMaker::finish(std::span<float> row, int exponent) const {
  row.front() *= options_.scaling == Scaling::density ? 0.5F : 0.25F;
  if (2 * (shape_.bins - 1) == shape_.padded)
    row.back() *= options_.scaling == Scaling::density ? 0.5F : 0.25F;
  if (options_.scaling == Scaling::amplitude)
    for (float& cell : row) cell = std::sqrt(cell);
  if (exponent == 0) return;
  const float step = std::ldexp(1.0F, exponent);
  for (float& cell : row) cell *= step;
  if (options_.scaling == Scaling::density)
    for (float& cell : row) cell *= step;
}

void SpectrogramMaker::unpack(const PackedRows& rows, std::span<float> a, std::span<float> b) const {
  rows.powers(a, b);
  finish(a, rows.exponent);
  finish(b, rows.exponent);
}

Result<void> SpectrogramMaker::make(const Texture& texture, const CellSink& sink) {
  const std::size_t rows = transform_.rows_of(texture.signal.values.size());
  const std::size_t at_once = cells_.size() / shape_.bins;
  const auto row_at = [&](std::size_t row) {
    return std::span(cells_).subspan(row * shape_.bins, shape_.bins);
  };
  std::size_t first = 0;
  return transform_.transform(texture.signal.values, [&](const PackedRows& pair) -> Result<void> {
    const std::size_t at = pair.row - first;
    unpack(pair, row_at(at), row_at(at + 1));
    const std::size_t ready = at + (pair.two ? 2 : 1);
    if (ready < at_once && first + ready < rows) return {};
    const auto cells = std::span<const float>(cells_).first(ready * shape_.bins);
    if (pair.exponent > 0)
      if (auto fits = check_cells(cells); !fits) return fits;
    const std::size_t from = std::exchange(first, first + ready);
    return sink(from, cells);
  });
}

}  // namespace tacto::spatial
