// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/offline/spectrogram_errors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/trade/rows/cpu_cost.hpp"
#include "analysis/trade/rows/stroked_texture.hpp"
#include "spatial/spectrogram/spectrogram.hpp"
#include "spatial/texture/space_filter.hpp"

namespace tacto::analysis {
namespace {

using schema::Result;
using schema::Spectrogram;
using schema::Texture;
using spatial::SpectrogramOptions;

constexpr double kWindow_m = 5e-3, kFineHop_m = 25e-6;

double row_power(const Spectrogram& of, std::size_t p) {
  const auto row = of.cells.begin() + static_cast<std::ptrdiff_t>(p * of.bins);
  return std::accumulate(row, row + static_cast<std::ptrdiff_t>(of.bins), 0.0);
}

double mean_peak(const Spectrogram& made) {
  double sum = 0;
  for (std::size_t p = 0; p < made.position_m.size(); ++p) {
    const auto row = made.cells.begin() + static_cast<std::ptrdiff_t>(p * made.bins);
    sum +=
        std::sqrt(static_cast<double>(*std::max_element(row, row + static_cast<std::ptrdiff_t>(made.bins))));
  }
  return sum / static_cast<double>(made.position_m.size());
}

// Both leave out the ends, which have less weight in the windows.
double left_out_m(const Texture& texture) {
  return std::min(5e-3, texture.signal.length_m() / 4);
}

double power_between(const std::vector<double>& values, std::size_t left_out) {
  double power = 0;
  for (std::size_t k = left_out; k + left_out < values.size(); ++k) power += values[k] * values[k];
  return power / static_cast<double>(values.size() - 2 * left_out);
}

// Integral of the triangular interpolation kernel from -1 to x, in bins.
double hat_up_to(double x) {
  const double y = std::clamp(x, -1.0, 1.0);
  return y < 0 ? (1 + y) * (1 + y) / 2 : 1 - (1 - y) * (1 - y) / 2;
}

// Share of bin k in octave i, in bins.
double share_of(const Spectrogram& made, std::size_t k, std::size_t i) {
  const auto bins_to = [&](double per_m) {
    return per_m / made.frequency_step_per_m - static_cast<double>(k);
  };
  return hat_up_to(bins_to(kOctaves_per_m[i + 1])) - hat_up_to(bins_to(kOctaves_per_m[i]));
}

}  // namespace

SpectrogramOptions standard_spectrogram(const Texture& texture) {
  SpectrogramOptions options;
  options.window_m = kWindow_m;
  options.max_frequency_per_m = std::min(options.max_frequency_per_m, 0.45 / texture.signal.pitch_m);
  return options;
}

SpectrogramOptions with_every_row(SpectrogramOptions options, const Texture& texture) {
  options.hop_m = std::max(kFineHop_m, texture.signal.pitch_m);
  return options;
}

TradeRow spectrogram_row(const Texture& texture, const SpectrogramOptions& options, std::string knob,
                         std::string choice, const Spectrogram& made, double error) {
  const auto work = [&] { static_cast<void>(spatial::spatial_spectrogram(texture, options)); };
  TradeRow row;
  row.knob = std::move(knob), row.choice = std::move(choice), row.per = "sample";
  row.error = error;
  row.cost_ns = median_cost_ns(work, static_cast<double>(texture.signal.values.size()));
  row.memory_bytes = 4 * static_cast<double>(made.cells.size());
  return row;
}

double error_between_rows(const Spectrogram& made, const Spectrogram& every) {
  double off = 0, all = 0;
  for (std::size_t p = 0; p < every.position_m.size(); ++p) {
    const double place = (every.position_m[p] - made.position_m.front()) / made.hop_m;
    const auto i = static_cast<std::size_t>(std::max(0.0, std::floor(place)));
    if (i + 1 >= made.position_m.size()) break;
    const double share = place - static_cast<double>(i);
    const double read = (1 - share) * row_power(made, i) + share * row_power(made, i + 1);
    off += std::pow(read - row_power(every, p), 2);
    all += std::pow(row_power(every, p), 2);
  }
  return std::sqrt(off / all);
}

double error_of_peaks(const Spectrogram& made, const Spectrogram& finest) {
  return std::abs(mean_peak(made) / mean_peak(finest) - 1);
}

Result<OctaveEnergy> OctaveEnergy::of(const Texture& texture) {
  OctaveEnergy made;
  made.from_m_ = left_out_m(texture);
  made.to_m_ = texture.signal.length_m() - made.from_m_;
  const auto left_out = static_cast<std::size_t>(made.from_m_ / texture.signal.pitch_m);
  for (std::size_t i = 0; i + 1 < std::size(kOctaves_per_m); ++i) {
    spatial::SpaceFilter band;
    band.low_per_m = kOctaves_per_m[i];
    band.high_per_m = kOctaves_per_m[i + 1];
    const auto values = spatial::filter_in_space(texture.signal.values, texture.signal.pitch_m, band);
    TACTO_TRY(values);
    made.truth_.push_back(power_between(*values, left_out));
  }
  return made;
}

std::vector<double> octave_powers(const Spectrogram& made, double from_m, double to_m) {
  std::vector<double> powers(std::size(kOctaves_per_m) - 1);
  const auto inside = [&](double at_m) { return at_m >= from_m && at_m <= to_m; };
  const auto rows = static_cast<double>(std::ranges::count_if(made.position_m, inside));
  for (std::size_t k = 0; k < made.bins; ++k) {
    double density = 0;
    for (std::size_t p = 0; p < made.position_m.size(); ++p)
      if (inside(made.position_m[p])) density += static_cast<double>(made.at(p, k));
    for (std::size_t i = 0; i < powers.size(); ++i)
      powers[i] += share_of(made, k, i) * made.frequency_step_per_m * density / rows;
  }
  return powers;
}

double OctaveEnergy::error(const Spectrogram& made) const {
  return relative_error(octave_powers(made, from_m_, to_m_), truth_, 0);
}

}  // namespace tacto::analysis
