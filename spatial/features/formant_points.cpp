// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/features/formant_points.hpp"

#include <algorithm>
#include <cmath>

#include "data-schema/base/decibels.hpp"
#include "spatial/numbers/parabolic_peak.hpp"

namespace tacto::spatial {
namespace {

using schema::Spectrogram;

// A peak exceeds the lowest cell within this many bins of the unpadded window, on each side, by at least
// this.
constexpr double kValley_db = 6;
constexpr double kValleyReach = 4;
// A peak further below the row's strongest cell may be a side lobe of the Blackman window (-58 dB).
constexpr double kPointLeakage_db = 55;

double level(double density) {
  return schema::power_db(density);
}

class RowPeaks {
 public:
  RowPeaks(const Spectrogram& spectrogram, std::size_t row, BinRange known)
      : spectrogram_(spectrogram), row_(row), known_(known) {
    const double unpadded_bin = 1 / (spectrogram.window_m * spectrogram.frequency_step_per_m);
    valley_bins_ = static_cast<std::size_t>(std::max(1.0, std::round(kValleyReach * unpadded_bin)));
  }

  double density(std::size_t bin) const { return static_cast<double>(spectrogram_.at(row_, bin)); }

  bool is_maximum(std::size_t bin) const {
    return density(bin) > density(bin - 1) && density(bin) >= density(bin + 1) && density(bin - 1) > 0 &&
           density(bin + 1) > 0;
  }

  // A side whose known cells end before that is not tested.
  bool is_isolated(std::size_t bin) const {
    const double enough = density(bin) * schema::power_of_db(-kValley_db);
    const bool below = bin < known_.first + valley_bins_ || lowest(bin - valley_bins_, bin) < enough;
    return below && (bin + valley_bins_ >= known_.end || lowest(bin + 1, bin + valley_bins_ + 1) < enough);
  }

  double strongest() const { return known_.first < known_.end ? highest(known_.first, known_.end) : 0; }

  double width_per_m(std::size_t bin, double peak_level_db) const {
    const double half = peak_level_db - level(2);
    return (half_power(bin, 1, half) + half_power(bin, -1, half)) * spectrogram_.frequency_step_per_m;
  }

 private:
  double lowest(std::size_t from, std::size_t end) const {
    double least = density(from);
    for (std::size_t bin = from + 1; bin < end; ++bin) least = std::min(least, density(bin));
    return least;
  }

  double highest(std::size_t from, std::size_t end) const {
    double most = 0;
    for (std::size_t bin = from; bin < end; ++bin) most = std::max(most, density(bin));
    return most;
  }

  // Distance in bins from the peak to where the level crosses the target; to the end of the spectrum if it
  // does not.
  double half_power(std::size_t bin, int way, double target_db) const {
    double inner = level(density(bin));
    for (std::size_t steps = 1; bin + steps < spectrogram_.bins && (way > 0 || steps <= bin); ++steps) {
      const double outer = level(density(way > 0 ? bin + steps : bin - steps));
      if (outer <= target_db)
        return static_cast<double>(steps) - (target_db - outer) / std::max(inner - outer, 1e-12);
      inner = outer;
    }
    return static_cast<double>(way > 0 ? spectrogram_.bins - 1 - bin : bin);
  }

  const Spectrogram& spectrogram_;
  std::size_t row_;
  BinRange known_;
  std::size_t valley_bins_ = 1;
};

}  // namespace

std::vector<RidgePoint> ridge_points(const Spectrogram& spectrogram, std::size_t row, BinRange known,
                                     const SpectrogramBackground& background, double least_prominence_db) {
  const RowPeaks peaks(spectrogram, row, known);
  std::vector<RidgePoint> points;
  const std::size_t end = std::min(known.end, spectrogram.bins - 1);
  const double least = peaks.strongest() * schema::power_of_db(-kPointLeakage_db);
  for (std::size_t bin = std::max<std::size_t>(known.first, 1); bin < end; ++bin) {
    if (!peaks.is_maximum(bin) || peaks.density(bin) < least) continue;
    const auto [offset, level_db] = parabolic_peak(level(peaks.density(bin - 1)), level(peaks.density(bin)),
                                                   level(peaks.density(bin + 1)));
    const double prominence_db = level_db - level(background.at(row, bin));
    if (!(prominence_db >= least_prominence_db) || !peaks.is_isolated(bin)) continue;
    points.push_back({row, (static_cast<double>(bin) + offset) * spectrogram.frequency_step_per_m,
                      schema::power_of_db(level_db), prominence_db, peaks.width_per_m(bin, level_db)});
  }
  return points;
}

}  // namespace tacto::spatial
