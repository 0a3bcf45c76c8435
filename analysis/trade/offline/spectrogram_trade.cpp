// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/offline/spectrogram_trade.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/trade/offline/spectrogram_errors.hpp"
#include "data-schema/base/quantity.hpp"
#include "playback/choose/budget_words.hpp"
#include "spatial/reference/exact_short_time.hpp"
#include "spatial/spectrogram/spectrogram.hpp"

namespace tacto::analysis {
namespace {

using schema::length_for_people;
using schema::Result;
using schema::Spectrogram;
using schema::Texture;
using spatial::SpectrogramOptions;

constexpr double kPairedWindows_m[] = {2.5e-3, 5e-3, 10e-3};
constexpr double kPairedHops_m[] = {100e-6, 200e-6, 500e-6, 1e-3};
constexpr double kPairedPaddings[] = {1, 2, 4, 8};
constexpr double kFinestPadding = 16;

/// All pairs with one window.
class WindowPairs {
 public:
  WindowPairs(const Texture& texture, const OctaveEnergy& energy, double window_m)
      : texture_(texture), energy_(energy), options_(standard_spectrogram(texture)) {
    options_.window_m = window_m;
  }

  Result<void> add_hops(std::vector<TradeRow>& rows) const {
    const auto every = spatial::spatial_spectrogram(texture_, with_every_row(options_, texture_));
    TACTO_TRY(every);
    for (const double hop_m : kPairedHops_m) {
      SpectrogramOptions options = options_;
      options.hop_m = hop_m;
      const auto made = spatial::spatial_spectrogram(texture_, options);
      TACTO_TRY(made);
      rows.push_back(row(options, "hop", length_for_people(hop_m), *made, error_between_rows(*made, *every)));
    }
    return {};
  }

  Result<void> add_paddings(std::vector<TradeRow>& rows) const {
    const auto finest = spatial::spatial_spectrogram(texture_, padded(kFinestPadding));
    TACTO_TRY(finest);
    for (const double times : kPairedPaddings) {
      const auto made = spatial::spatial_spectrogram(texture_, padded(times));
      TACTO_TRY(made);
      rows.push_back(row(padded(times), "padding", fmt::format("{:g} windows", times), *made,
                         error_of_peaks(*made, *finest)));
    }
    return {};
  }

 private:
  SpectrogramOptions padded(double times) const {
    SpectrogramOptions options = options_;
    options.padded_m = times * options.window_m;
    return options;
  }

  TradeRow row(const SpectrogramOptions& options, const std::string& other, const std::string& choice,
               const Spectrogram& made, double other_error) const {
    const double window_error = energy_.error(made);
    TradeRow row = spectrogram_row(texture_, options, "window x " + other,
                                   length_for_people(options.window_m) + ", " + choice, made,
                                   std::hypot(window_error, other_error));
    row.note = fmt::format("the window {}, the {} {}", playback::percent(window_error), other,
                           playback::percent(other_error));
    return row;
  }

  const Texture& texture_;
  const OctaveEnergy& energy_;
  SpectrogramOptions options_;
};

double from_exact(const Texture& texture, const SpectrogramOptions& options, const Spectrogram& made) {
  const auto shape = spatial::frame_shape(options, texture.signal.pitch_m);
  const double sum_w = made.coherent_gain * static_cast<double>(shape->window);
  const std::size_t row = made.position_m.size() / 2;
  const auto exact = spatial::reference::exact_short_time_row(texture.signal.values, *shape, row, true);
  double off = 0, largest = 0;
  for (std::size_t k = 1; k < made.bins && k + 1 < exact.size(); ++k) {
    const double amplitude = 2 * static_cast<double>(std::abs(exact[k])) / sum_w;
    off = std::max(off, std::abs(static_cast<double>(made.at(row, k)) - amplitude));
    largest = std::max(largest, amplitude);
  }
  return off / largest;
}

Result<TradeRow> with_resolution(const Texture& texture, spatial::Resolution resolution, const char* name) {
  SpectrogramOptions options = standard_spectrogram(texture);
  options.scaling = schema::Scaling::amplitude;
  options.resolution = resolution;
  const auto made = spatial::spatial_spectrogram(texture, options);
  TACTO_TRY(made);
  return spectrogram_row(texture, options, "resolution", name, *made, from_exact(texture, options, *made));
}

Result<TradeRow> with_hop(const Texture& texture, double hop_m, const Spectrogram& every) {
  SpectrogramOptions options = standard_spectrogram(texture);
  options.hop_m = hop_m;
  const auto made = spatial::spatial_spectrogram(texture, options);
  TACTO_TRY(made);
  return spectrogram_row(texture, options, "hop", length_for_people(hop_m), *made,
                         error_between_rows(*made, every));
}

Result<Spectrogram> padded(const Texture& texture, double times, SpectrogramOptions& options) {
  options = standard_spectrogram(texture);
  options.padded_m = times * options.window_m;
  return spatial::spatial_spectrogram(texture, options);
}

Result<std::vector<TradeRow>> paddings(const Texture& texture) {
  SpectrogramOptions options;
  const auto finest = padded(texture, 16, options);
  TACTO_TRY(finest);
  std::vector<TradeRow> rows;
  for (const double times : {1.0, 2.0, 4.0, 8.0}) {
    const auto made = padded(texture, times, options);
    TACTO_TRY(made);
    rows.push_back(spectrogram_row(texture, options, "padding", fmt::format("{:g} windows", times), *made,
                                   error_of_peaks(*made, *finest)));
    rows.back().note = "height of the highest peak";
  }
  return rows;
}

Result<TradeRow> with_window(const Texture& texture, double window_m, const OctaveEnergy& energy) {
  SpectrogramOptions options = standard_spectrogram(texture);
  options.window_m = window_m;
  const auto made = spatial::spatial_spectrogram(texture, options);
  TACTO_TRY(made);
  TradeRow row =
      spectrogram_row(texture, options, "window", length_for_people(window_m), *made, energy.error(*made));
  row.note = "energy by octaves; separates lines from " +
             schema::for_people(3 / window_m, schema::Dimension::spatial_frequency);
  return row;
}

}  // namespace

Result<std::vector<TradeRow>> measure_spectrogram_pairs(const Texture& texture, const OctaveEnergy& energy) {
  std::vector<TradeRow> rows;
  for (const double window_m : kPairedWindows_m)
    TACTO_TRY(WindowPairs(texture, energy, window_m).add_hops(rows));
  for (const double window_m : kPairedWindows_m)
    TACTO_TRY(WindowPairs(texture, energy, window_m).add_paddings(rows));
  return rows;
}

Result<std::vector<TradeRow>> measure_spectrogram_trade(const Texture& texture) {
  std::vector<TradeRow> rows;
  std::optional<schema::Error> failed;
  const auto take = [&](Result<TradeRow> row) {
    if (row)
      rows.push_back(std::move(*row));
    else if (!failed)
      failed = row.error();
  };
  take(with_resolution(texture, spatial::Resolution::automatic, "auto"));
  take(with_resolution(texture, spatial::Resolution::whole, "whole"));
  const auto every =
      spatial::spatial_spectrogram(texture, with_every_row(standard_spectrogram(texture), texture));
  TACTO_TRY(every);
  for (const double hop_m : {100e-6, 200e-6, 500e-6, 1e-3}) take(with_hop(texture, hop_m, *every));
  const auto energy = OctaveEnergy::of(texture);
  TACTO_TRY(energy);
  for (const double window_m : {1.25e-3, 2.5e-3, 5e-3, 10e-3}) take(with_window(texture, window_m, *energy));
  for (auto more : {paddings(texture), measure_spectrogram_pairs(texture, *energy)}) {
    TACTO_TRY(more);
    std::ranges::move(*more, std::back_inserter(rows));
  }
  if (failed) return tl::unexpected(*failed);
  return rows;
}

}  // namespace tacto::analysis
