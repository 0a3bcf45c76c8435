// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/spectrogram.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "data-schema/quantity.hpp"
#include "spatial/dsp/fft.hpp"
#include "spatial/known_band.hpp"

namespace tacto::spatial {
namespace {

using schema::Dimension;
using schema::Fault;
using schema::Result;
using schema::Spectrogram;
using schema::Texture;

// The options in whole samples of one texture.
struct Frames {
  std::size_t window = 0;
  std::size_t hop = 0;
  std::size_t padded = 0;
  std::size_t count = 0;
  std::size_t bins = 0;
};

bool positive(double value) {
  return std::isfinite(value) && value > 0;
}

std::string length(double metres) {
  return schema::for_people(metres, Dimension::length);
}

std::size_t samples_of(double length_m, double pitch_m) {
  return static_cast<std::size_t>(std::llround(length_m / pitch_m));
}

// Rounded down to three digits, so that the length that is suggested does fit.
double rounded_down(double length_m) {
  const double digit = std::pow(10.0, std::floor(std::log10(length_m)) - 2);
  return std::floor(length_m / digit * (1 + 1e-12)) * digit;
}

Result<void> check_lengths(const SpectrogramOptions& options, double pitch_m) {
  const double shortest = static_cast<double>(kShortestWindow) * pitch_m;
  // An upper bound keeps the conversion to samples defined; no texture is longer.
  if (!positive(options.window_m) || options.window_m < 0.99 * shortest || options.window_m > 1e15 * pitch_m)
    return schema::fail(Fault::usage, fmt::format("a window of {} can't be used", length(options.window_m)),
                        "window",
                        fmt::format("take {} or more ({} samples)", length(shortest), kShortestWindow));
  if (!positive(options.hop_m) || options.hop_m < 0.99 * pitch_m || options.hop_m > 1e15 * pitch_m)
    return schema::fail(Fault::usage, fmt::format("a hop of {} can't be used", length(options.hop_m)), "hop",
                        fmt::format("take {} (one sample) or more", length(pitch_m)));
  if (!positive(options.max_frequency_per_m))
    return schema::fail(Fault::usage, "the maximum frequency must be above 0", "maximum frequency",
                        "15/mm is usual");
  return {};
}

Result<std::size_t> padded_samples(const SpectrogramOptions& options, std::size_t window, double pitch_m) {
  if (!options.padded_m) return std::bit_ceil(window);
  constexpr double kMostSamples = 1 << 28;
  const double samples = *options.padded_m / pitch_m;
  if (!std::isfinite(samples) || samples > kMostSamples || samples < static_cast<double>(window) - 0.5)
    return schema::fail(Fault::usage,
                        fmt::format("a padded length of {} can't be used", length(*options.padded_m)),
                        "padding", fmt::format("take {} (the window) or more", length(options.window_m)));
  return samples_of(*options.padded_m, pitch_m);
}

Result<void> check_texture(const Texture& texture, double window_m) {
  const auto& values = texture.signal.values;
  const double have_m = static_cast<double>(values.size()) * texture.signal.pitch_m;
  if (samples_of(window_m, texture.signal.pitch_m) > values.size())
    return schema::fail(
        Fault::unsuitable,
        fmt::format("the texture of {} is shorter than the window of {}", length(have_m), length(window_m)),
        "texture",
        values.size() < kShortestWindow
            ? "it is too short for any window"
            : fmt::format("a window of {} would fit", length(rounded_down(have_m))));
  const auto bad = std::ranges::find_if(values, [](double v) { return !std::isfinite(v); });
  if (bad != values.end())
    return schema::fail(Fault::unsuitable, "a value is not finite",
                        fmt::format("sample {}", bad - values.begin()),
                        "make the texture again from a recording without gaps");
  return {};
}

Result<Frames> frames_of(const Texture& texture, const SpectrogramOptions& options) {
  const double pitch_m = texture.signal.pitch_m;
  if (auto checked = check_lengths(options, pitch_m); !checked) return schema::forward_error(checked);
  if (auto checked = check_texture(texture, options.window_m); !checked)
    return schema::forward_error(checked);
  Frames frames;
  frames.window = std::max(kShortestWindow, samples_of(options.window_m, pitch_m));
  frames.hop = std::max<std::size_t>(1, samples_of(options.hop_m, pitch_m));
  const auto padded = padded_samples(options, frames.window, pitch_m);
  if (!padded) return schema::forward_error(padded);
  frames.padded = *padded;
  frames.count = 1 + (texture.signal.values.size() - frames.window) / frames.hop;
  // A bin that lies on the limit is kept in spite of rounding.
  const double last =
      options.max_frequency_per_m * static_cast<double>(frames.padded) * pitch_m * (1 + 1e-12);
  const std::size_t half = frames.padded / 2;
  const auto nyquist = static_cast<double>(half);
  frames.bins = 1 + static_cast<std::size_t>(std::min(std::floor(last), nyquist));
  return frames;
}

constexpr double kBlackmanMean = 0.42;

std::vector<double> blackman(std::size_t length) {
  std::vector<double> window(length);
  for (std::size_t n = 0; n < length; ++n) {
    const double phase = 2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(length);
    window[n] = 0.42 - 0.5 * std::cos(phase) + 0.08 * std::cos(2 * phase);
  }
  return window;
}

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// One row after the other through one plan and its buffers.
class RowMaker {
 public:
  RowMaker(const Frames& frames, Detrend detrend, double pitch_m)
      : frames_(frames),
        detrend_(detrend),
        window_(blackman(frames.window)),
        fft_(frames.padded),
        time_(frames.padded, 0.0),
        spectrum_(fft_.bins()) {
    const double power = std::inner_product(window_.begin(), window_.end(), window_.begin(), 0.0);
    scale_ = pitch_m / power;
  }

  void make(std::span<const double> samples, std::span<float> row) {
    const double mean = detrend_ == Detrend::constant ? mean_of(samples) : 0;
    for (std::size_t n = 0; n < samples.size(); ++n) time_[n] = window_[n] * (samples[n] - mean);
    fft_.forward(time_, spectrum_);
    for (std::size_t k = 0; k < row.size(); ++k)
      row[k] = static_cast<float>(sides(k) * scale_ * std::norm(spectrum_[k]));
  }

 private:
  // Zero and half the sampling frequency have no twin at negative frequencies.
  double sides(std::size_t bin) const { return bin == 0 || 2 * bin == frames_.padded ? 1 : 2; }

  Frames frames_;
  Detrend detrend_;
  std::vector<double> window_;
  RealFft fft_;
  std::vector<double> time_;
  std::vector<std::complex<double>> spectrum_;
  double scale_ = 0;
};

Spectrogram described(const Texture& texture, const Frames& frames, Detrend detrend) {
  const double pitch_m = texture.signal.pitch_m;
  Spectrogram result;
  result.bins = frames.bins;
  result.frequency_step_per_m = 1 / (static_cast<double>(frames.padded) * pitch_m);
  result.quantity = texture.quantity;
  result.unit = texture.unit;
  result.window = "blackman";
  result.coherent_gain = kBlackmanMean;
  result.detrend = detrend == Detrend::constant ? "constant" : "none";
  result.window_m = static_cast<double>(frames.window) * pitch_m;
  result.hop_m = static_cast<double>(frames.hop) * pitch_m;
  result.pitch_m = pitch_m;
  result.padded_samples = frames.padded;
  result.simulated = texture.simulated;
  return result;
}

double centre_m(const schema::SpaceSignal& signal, const Frames& frames, std::size_t row) {
  const double samples = static_cast<double>(row * frames.hop) + 0.5 * static_cast<double>(frames.window);
  return signal.origin_m + samples * signal.pitch_m;
}

}  // namespace

Result<Spectrogram> spatial_spectrogram(const Texture& texture, const SpectrogramOptions& options,
                                        const std::function<void(double)>& progress) {
  const auto frames = frames_of(texture, options);
  if (!frames) return schema::forward_error(frames);
  Spectrogram result = described(texture, *frames, options.detrend);
  result.cells.resize(frames->count * frames->bins);
  RowMaker maker(*frames, options.detrend, texture.signal.pitch_m);
  const std::span samples(texture.signal.values);
  for (std::size_t row = 0; row < frames->count; ++row) {
    result.position_m.push_back(centre_m(texture.signal, *frames, row));
    maker.make(samples.subspan(row * frames->hop, frames->window),
               std::span(result.cells).subspan(row * frames->bins, frames->bins));
    if (progress) progress(static_cast<double>(row + 1) / static_cast<double>(frames->count));
  }
  result.known = known_bands(texture.valid_band, result.position_m, result.window_m);
  return result;
}

}  // namespace tacto::spatial
