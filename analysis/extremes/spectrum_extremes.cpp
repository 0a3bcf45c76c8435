// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/extremes/extreme.hpp"
#include "spatial/reference/exact_short_time.hpp"
#include "spatial/spectrogram/spectrogram.hpp"

namespace tacto::analysis {
namespace {

constexpr double kSpectrumPitchM = 10e-6;
constexpr double kStatedCellError = 1e-6;  // -120 dB of the largest: spatial_spectrogram

schema::Texture tone_texture(double per_sample, double offset) {
  schema::Texture texture;
  texture.signal.pitch_m = kSpectrumPitchM;
  for (int i = 0; i < 4000; ++i)
    texture.signal.values.push_back(offset + std::cos(2 * std::numbers::pi * per_sample * i));
  return texture;
}

spatial::SpectrogramOptions amplitudes() {
  spatial::SpectrogramOptions options;
  options.scaling = schema::Scaling::amplitude;
  options.resolution = spatial::Resolution::whole;
  options.max_frequency_per_m = 0.5 / kSpectrumPitchM;
  options.hop_m = 1e-3;
  return options;
}

// At half the sampling frequency a cosine of amplitude 1 reads 1.
double nyquist_error() {
  const auto spectrogram = spatial::spatial_spectrogram(tone_texture(0.5, 0), amplitudes());
  double error = 0;
  for (std::size_t row = 0; row < spectrogram->position_m.size(); ++row)
    error = std::max(error, std::abs(spectrogram->at(row, spectrogram->bins - 1) - 1.0));
  return error;
}

double offset_error(double offset) {
  const schema::Texture texture = tone_texture(0.01234, offset);
  const auto spectrogram = spatial::spatial_spectrogram(texture, amplitudes());
  const auto shape = spatial::frame_shape(amplitudes(), kSpectrumPitchM);
  const double whole = spectrogram->coherent_gain * static_cast<double>(shape->window);
  double error = 0;
  for (std::size_t row = 0; row < spectrogram->position_m.size(); ++row) {
    const auto exact = spatial::reference::exact_short_time_row(texture.signal.values, *shape, row, true);
    for (std::size_t k = 1; k + 1 < spectrogram->bins; ++k)
      error = std::max(
          error, std::abs(spectrogram->at(row, k) - 2 * static_cast<double>(std::abs(exact[k])) / whole));
  }
  return error;
}

}  // namespace

std::vector<Extreme> spectrum_extremes() {
  return {{"spatial",
           "spectrogram of a tone at half the grid's frequency",
           "its amplitude, 1",
           nyquist_error(),
           kStatedCellError,
           {}},
          {"spatial", "spectrogram of a tone of 1 N on 1e9 N", "the transform's definition in long double",
           offset_error(1e9), kStatedCellError, "doubles of 1e9 are 1e-7 apart"}};
}

}  // namespace tacto::analysis
