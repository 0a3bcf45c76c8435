// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/offline/spectrogram_pairs.hpp"

#include <fmt/format.h>

#include <cmath>

#include "data-schema/base/quantity.hpp"
#include "playback/choose/budget_words.hpp"
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

}  // namespace

Result<std::vector<TradeRow>> measure_spectrogram_pairs(const Texture& texture, const OctaveEnergy& energy) {
  std::vector<TradeRow> rows;
  for (const double window_m : kPairedWindows_m)
    TACTO_TRY(WindowPairs(texture, energy, window_m).add_hops(rows));
  for (const double window_m : kPairedWindows_m)
    TACTO_TRY(WindowPairs(texture, energy, window_m).add_paddings(rows));
  return rows;
}

}  // namespace tacto::analysis
