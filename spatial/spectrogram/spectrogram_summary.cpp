// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/spectrogram/spectrogram_summary.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::spatial {

using schema::Scaling;
using schema::Spectrogram;
using schema::SpectrogramHeader;

namespace {

LevelReference amplitude_reference(const std::string& unit) {
  if (unit == "m") return {"1 um", 1e6, 20};
  if (unit == "1") return {"1", 1, 20};
  return {"1 " + unit, 1, 20};
}

}  // namespace

std::size_t first_bin(const SpectrogramHeader& spectrogram, double min_frequency_per_m) {
  const double bin = std::ceil(min_frequency_per_m / spectrogram.frequency_step_per_m * (1 - 1e-12));
  return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(spectrogram.bins - 1)));
}

// The factor (sum w)^2 pitch / sum w^2 is 1 over the window's noise bandwidth.
double power_of(const SpectrogramHeader& spectrogram, std::size_t bin, double cell) {
  if (spectrogram.scaling == Scaling::density) return cell;
  const bool alone = bin == 0 || 2 * bin == spectrogram.padded_samples;
  return cell * cell * (alone ? 1 : 0.5) / resolution_per_m(spectrogram);
}

bool is_valid(const SpectrogramHeader& spectrogram, std::size_t row, std::size_t bin) {
  return spectrogram.known.empty() || spectrogram.known[row].contains(spectrogram.frequency_per_m(bin));
}

std::vector<double> mean_spectrum(const Spectrogram& spectrogram) {
  const bool amplitudes = spectrogram.scaling == Scaling::amplitude;
  std::vector<double> mean(spectrogram.bins, 0.0);
  const std::size_t positions = spectrogram.position_m.size();
  for (std::size_t p = 0; p < positions; ++p)
    for (std::size_t k = 0; k < spectrogram.bins; ++k) {
      const auto cell = static_cast<double>(spectrogram.at(p, k));
      mean[k] += amplitudes ? cell * cell : cell;
    }
  for (double& value : mean) value /= static_cast<double>(positions);
  if (amplitudes)
    for (double& value : mean) value = std::sqrt(value);
  return mean;
}

SpectralPeak strongest_peak(const Spectrogram& spectrogram, double min_frequency_per_m) {
  const std::size_t first = first_bin(spectrogram, min_frequency_per_m);
  SpectralPeak best{NAN, NAN, NAN};
  for (std::size_t p = 0; p < spectrogram.position_m.size(); ++p)
    for (std::size_t k = first; k < spectrogram.bins; ++k)
      if (!(spectrogram.at(p, k) <= best.cell) && is_valid(spectrogram, p, k))
        best = {spectrogram.position_m[p], spectrogram.frequency_per_m(k), double{spectrogram.at(p, k)}};
  return best;
}

double band_rms(const Spectrogram& spectrogram, double min_frequency_per_m) {
  const auto mean = mean_spectrum(spectrogram);
  double sum = 0;
  for (std::size_t k = first_bin(spectrogram, min_frequency_per_m); k < mean.size(); ++k)
    sum += power_of(spectrogram, k, mean[k]);
  return std::sqrt(sum * spectrogram.frequency_step_per_m);
}

double lowest_of_interest_per_m(const schema::Texture& texture) {
  constexpr double kUsualLowest = 100, kRoom = 0.7;
  if (texture.valid_band.empty()) return kUsualLowest;
  return kRoom * std::ranges::min(texture.valid_band, {}, &schema::BandPoint::low_per_m).low_per_m;
}

double lowest_shown_per_m(double lowest_of_interest_per_m, const SpectrogramHeader& spectrogram) {
  const double first = spectrogram.frequency_step_per_m;
  const double last = spectrogram.frequency_per_m(spectrogram.bins - 1);
  return std::clamp(lowest_of_interest_per_m, first, std::max(first, last / 10));
}

double resolution_per_m(const SpectrogramHeader& spectrogram) {
  return 0.3046 / (0.42 * 0.42) / spectrogram.window_m;
}

LevelReference level_reference(const SpectrogramHeader& spectrogram) {
  if (spectrogram.scaling == Scaling::amplitude) return amplitude_reference(spectrogram.unit);
  constexpr double kMillimetresPerMetre = 1e3;
  if (spectrogram.unit == "m") return {"1 um^2 mm", 1e12 * kMillimetresPerMetre};
  if (spectrogram.unit == "1") return {"1 mm", kMillimetresPerMetre};
  if (spectrogram.unit.find('/') != std::string::npos)
    return {"1 (" + spectrogram.unit + ")^2 mm", kMillimetresPerMetre};
  return {"1 " + spectrogram.unit + "^2 mm", kMillimetresPerMetre};
}

double level_db(double cell, const LevelReference& reference) {
  return reference.decade_db * std::log10(cell * reference.factor);
}

}  // namespace tacto::spatial
