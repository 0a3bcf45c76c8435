// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/features/formants.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>
#include <vector>

#include "data-schema/base/decibels.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "spatial/numbers/parabolic_peak.hpp"
#include "spatial/numbers/robust_statistics.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;
using schema::Formant;
using schema::Result;
using schema::Spectrogram;

// Half the amplitude: the level of a line whose end is at the window's middle.
constexpr double kEnd_db = 6.0206;

Result<void> check(const Spectrogram& spectrogram, const FormantOptions& options) {
  if (!std::isfinite(options.start_db) || !std::isfinite(options.continue_db) ||
      options.continue_db > options.start_db)
    return schema::fail(ErrorKind::usage,
                        "the prominence at which a ridge starts must not be below that at which it continues",
                        "formants", "the defaults are 13 and 8 dB");
  for (const auto& length_m : {options.shortest_m, options.bridge_m})
    if (length_m && !(std::isfinite(*length_m) && *length_m >= 0))
      return schema::fail(ErrorKind::usage, "a length must be 0 or more", "formants");
  if (spectrogram.scaling != schema::Scaling::density)
    return schema::fail(ErrorKind::unsuitable, "formants are computed from densities, not from amplitudes",
                        spectrogram.name);
  if (spectrogram.position_m.empty() || spectrogram.bins < 3)
    return schema::fail(ErrorKind::unsuitable, "the spectrogram is too small for formants", spectrogram.name);
  return {};
}

// Bins from `first` up to, not including, `end`; empty if they are equal.
struct BinRange {
  std::size_t first = 0, end = 0;
  bool holds(std::size_t bin) const { return first <= bin && bin < end; }
};

std::size_t bin_at(double bin, std::size_t bins) {
  return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bins)));
}

// For each row the bins with known frequencies (known_band.hpp) that are at least the resolution away from
// the limits, because every slope has a maximum where a band-pass ends. They begin at 2 / window: a window
// has too few periods of lower frequencies to separate them from a drift. If the spectrogram has no known
// band, all bins from there on.
std::vector<BinRange> known_bins(const schema::Spectrogram& spectrogram) {
  const double step = spectrogram.frequency_step_per_m;
  const double least_per_m = 2 / spectrogram.window_m;
  const double edge_per_m = resolution_per_m(spectrogram);
  std::vector<BinRange> rows;
  for (std::size_t row = 0; row < spectrogram.position_m.size(); ++row) {
    const schema::KnownBand known =
        spectrogram.known.empty() ? schema::KnownBand{-edge_per_m, INFINITY} : spectrogram.known[row];
    const double low = std::ceil(std::max(known.low_per_m + edge_per_m, least_per_m) / step * (1 - 1e-12));
    const double high = std::floor((known.high_per_m - edge_per_m) / step * (1 + 1e-12)) + 1;
    const std::size_t first = bin_at(low, spectrogram.bins);
    rows.push_back({first, std::max(first, bin_at(high, spectrogram.bins))});
  }
  return rows;
}

// A peak of one row of the spectrogram that exceeds its background.
struct RidgePoint {
  std::size_t row = 0;
  double frequency_per_m = 0;
  double density = 0;        // unit^2 m
  double prominence_db = 0;  // over the background
  double width_per_m = 0;    // between its half-power points
};

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

constexpr double kFloorGuard =
    3.5;  // unpadded bins: half of Blackman's main lobe is 3, and half a lattice step
constexpr double kFloorReach = 16;   // unpadded bins
constexpr double kAlong = 1.5;       // windows
constexpr std::size_t kFewest = 24;  // cells for a median
constexpr std::size_t kTrendPoints = 64;

std::size_t at_least_one(double count) {
  return static_cast<std::size_t>(std::max(1.0, std::round(count)));
}

// Bins evenly spaced in the logarithm, so that the many high bins do not dominate the slope.
std::vector<std::size_t> spread_bins(std::size_t first, std::size_t end) {
  std::vector<std::size_t> bins;
  for (std::size_t i = 0; i < kTrendPoints; ++i) {
    const double part = static_cast<double>(i) / (kTrendPoints - 1);
    const double bin = static_cast<double>(first) *
                       std::pow(static_cast<double>(end - 1) / static_cast<double>(first), part);
    const auto rounded = static_cast<std::size_t>(std::lround(bin));
    if (bins.empty() || bins.back() != rounded) bins.push_back(rounded);
  }
  return bins;
}

// The exponent a of k^a, fitted to the mean spectrum.
double exponent_of(const Spectrogram& spectrogram, std::span<const BinRange> known) {
  BinRange widest{spectrogram.bins, 0};
  for (const BinRange& row : known) {
    if (row.first >= row.end) continue;
    widest = {std::min(widest.first, row.first), std::max(widest.end, row.end)};
  }
  if (widest.first == 0 || widest.first + 2 > widest.end) return 0;
  const auto mean = mean_spectrum(spectrogram);
  std::vector<double> x;
  std::vector<double> y;
  for (const std::size_t bin : spread_bins(widest.first, widest.end)) {
    if (!(mean[bin] > 0)) continue;
    x.push_back(std::log(static_cast<double>(bin)));
    y.push_back(std::log(mean[bin]));
  }
  return robust_slope(x, y);
}

// The expected density of a cell without the line in it, by ordered statistics of its neighbours (Rohling
// 1983, IEEE Trans. AES 19(4)): the median of the known cells that are within 1.5 windows along position and
// between 3.5 and 16 bins of the unpadded window (1 / window) away in frequency, over ln 2, because cells of
// noise have an exponential distribution. Before that, each cell is divided by a power law k^a fitted to the
// mean spectrum (Theil and Sen's robust slope), and by the median of its row.
class SpectrogramBackground {
 public:
  // Precondition: one range per row.
  SpectrogramBackground(const Spectrogram& spectrogram, std::span<const BinRange> known)
      : known_(known.begin(), known.end()), rows_(spectrogram.position_m.size()), bins_(spectrogram.bins) {
    unpadded_bin_ = 1 / (spectrogram.window_m * spectrogram.frequency_step_per_m);
    window_rows_ = spectrogram.window_m / spectrogram.hop_m;
    rows_apart_ = at_least_one(window_rows_ / 4);
    bins_apart_ = at_least_one(unpadded_bin_);
    lattice_bins_ = 1 + (bins_ - 1) / bins_apart_;
    whiten(spectrogram);
    for (std::size_t row = 0; row < rows_; row += rows_apart_)
      for (std::size_t bin = 0; bin < bins_; bin += bins_apart_)
        lattice_.push_back(median_around(row, bin) / std::numbers::ln2);
  }

  // unit^2 m; NaN if too few neighbours are known.
  double at(std::size_t row, std::size_t bin) const {
    const std::size_t last_row = (rows_ - 1) / rows_apart_;
    const std::size_t lattice_row = std::min(last_row, (row + rows_apart_ / 2) / rows_apart_);
    const std::size_t lattice_bin = std::min(lattice_bins_ - 1, (bin + bins_apart_ / 2) / bins_apart_);
    return lattice_[lattice_row * lattice_bins_ + lattice_bin] * trend_[bin] * row_gain_[row];
  }

 private:
  void whiten(const Spectrogram& spectrogram) {
    const double exponent = exponent_of(spectrogram, known_);
    for (std::size_t bin = 0; bin < bins_; ++bin)
      trend_.push_back(std::pow(static_cast<double>(std::max<std::size_t>(bin, 1)), exponent));
    whitened_.assign(rows_ * bins_, 0);
    for (std::size_t row = 0; row < rows_; ++row) whiten_row(spectrogram, row);
  }

  void whiten_row(const Spectrogram& spectrogram, std::size_t row) {
    BinRange& known = known_[row];
    const std::span cells = std::span(whitened_).subspan(row * bins_, bins_);
    for (std::size_t bin = known.first; bin < known.end; ++bin)
      cells[bin] = static_cast<float>(static_cast<double>(spectrogram.at(row, bin)) / trend_[bin]);
    cells_.assign(cells.begin() + static_cast<std::ptrdiff_t>(known.first),
                  cells.begin() + static_cast<std::ptrdiff_t>(known.end));
    row_gain_.push_back(median_of(cells_));
    // A row of zeros has no background, so none of its bins is used.
    if (!(row_gain_[row] > 0)) known.end = known.first;
    for (std::size_t bin = known.first; bin < known.end; ++bin)
      cells[bin] = static_cast<float>(static_cast<double>(cells[bin]) / row_gain_[row]);
  }

  double median_around(std::size_t row, std::size_t bin) {
    const std::size_t along = at_least_one(kAlong * window_rows_);
    const std::size_t stride = at_least_one(window_rows_ / 8);
    const std::size_t guard = at_least_one(std::ceil(kFloorGuard * unpadded_bin_));
    const std::size_t reach = at_least_one(kFloorReach * unpadded_bin_);
    cells_.clear();
    const std::size_t first_row = row > along ? row - along : 0;
    for (std::size_t r = first_row; r < std::min(rows_, row + along + 1); r += stride) {
      const std::size_t from = std::max(known_[r].first, bin > reach ? bin - reach : 0);
      const std::size_t to = std::min(known_[r].end, bin + reach + 1);
      for (std::size_t b = from; b < to; ++b)
        if ((b > bin ? b - bin : bin - b) >= guard) cells_.push_back(whitened_[r * bins_ + b]);
    }
    return cells_.size() < kFewest ? std::numeric_limits<double>::quiet_NaN() : median_of(cells_);
  }

  std::vector<BinRange> known_;
  std::vector<double> trend_;     // by bin
  std::vector<double> row_gain_;  // by row
  std::vector<float> whitened_;
  std::size_t rows_ = 0, bins_ = 0;
  std::size_t rows_apart_ = 1, bins_apart_ = 1;  // of the lattice on which it is computed
  std::size_t lattice_bins_ = 0;
  std::vector<double> lattice_;
  std::vector<float> cells_;
  double unpadded_bin_ = 1;  // in bins
  double window_rows_ = 1;
};

// Sorted by frequency. A parabola through the levels of three bins gives the position of the maximum.
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

using Ridge = std::vector<RidgePoint>;

// Links the peaks of neighbouring rows to ridges. Input: rows in order. A point continues the ridge whose
// last frequency is nearest, nearest pairs first, at most `tolerance_per_m` away. A ridge without a point for
// more than `bridge_rows` rows ends.
class RidgeTracker {
 public:
  RidgeTracker(double tolerance_per_m, std::size_t bridge_rows);
  void add_row(std::size_t row, const std::vector<RidgePoint>& points);
  // Ends all ridges and returns them.
  std::vector<Ridge> finish();

 private:
  void end_stale(std::size_t row);

  double tolerance_per_m_;
  std::size_t bridge_rows_;
  std::vector<Ridge> open_, ended_;
};

struct Pair {
  double distance_per_m;
  std::size_t ridge, point;
};

std::vector<Pair> near_pairs(const std::vector<Ridge>& ridges, const std::vector<RidgePoint>& points,
                             double tolerance_per_m) {
  std::vector<Pair> pairs;
  for (std::size_t r = 0; r < ridges.size(); ++r)
    for (std::size_t p = 0; p < points.size(); ++p) {
      const double distance = std::abs(ridges[r].back().frequency_per_m - points[p].frequency_per_m);
      if (distance <= tolerance_per_m) pairs.push_back({distance, r, p});
    }
  std::ranges::sort(pairs, {}, &Pair::distance_per_m);
  return pairs;
}

RidgeTracker::RidgeTracker(double tolerance_per_m, std::size_t bridge_rows)
    : tolerance_per_m_(tolerance_per_m), bridge_rows_(bridge_rows) {}

void RidgeTracker::end_stale(std::size_t row) {
  const auto stale = [&](const Ridge& ridge) { return row - ridge.back().row > bridge_rows_ + 1; };
  const auto first_stale =
      std::stable_partition(open_.begin(), open_.end(), [&](const Ridge& r) { return !stale(r); });
  std::move(first_stale, open_.end(), std::back_inserter(ended_));
  open_.erase(first_stale, open_.end());
}

void RidgeTracker::add_row(std::size_t row, const std::vector<RidgePoint>& points) {
  end_stale(row);
  std::vector<bool> ridge_used(open_.size(), false);
  std::vector<bool> point_used(points.size(), false);
  for (const Pair& pair : near_pairs(open_, points, tolerance_per_m_)) {
    if (ridge_used[pair.ridge] || point_used[pair.point]) continue;
    ridge_used[pair.ridge] = point_used[pair.point] = true;
    open_[pair.ridge].push_back(points[pair.point]);
  }
  for (std::size_t p = 0; p < points.size(); ++p)
    if (!point_used[p]) open_.push_back({points[p]});
}

std::vector<Ridge> RidgeTracker::finish() {
  std::move(open_.begin(), open_.end(), std::back_inserter(ended_));
  open_.clear();
  return std::move(ended_);
}

std::vector<Ridge> all_ridges(const Spectrogram& spectrogram, const FormantOptions& options) {
  const auto known = known_bins(spectrogram);
  const SpectrogramBackground background(spectrogram, known);
  const double bridge_m = options.bridge_m.value_or(spectrogram.window_m / 2);
  RidgeTracker tracker(resolution_per_m(spectrogram) / 2,
                       static_cast<std::size_t>(std::lround(bridge_m / spectrogram.hop_m)));
  for (std::size_t row = 0; row < known.size(); ++row)
    tracker.add_row(row, ridge_points(spectrogram, row, known[row], background, options.continue_db));
  return tracker.finish();
}

double level_of(const RidgePoint& point) {
  return schema::power_db(point.density);
}

// Number of points at the ridge's beginning that are more than 6 dB below the strongest point within a window
// from there.
template <class Iterator>
std::ptrdiff_t faint_points(Iterator begin, Iterator end, std::size_t window_rows) {
  const auto away = [&](const RidgePoint& p) {
    return p.row > begin->row ? p.row - begin->row : begin->row - p.row;
  };
  double strongest = level_of(*begin);
  for (auto p = begin; p != end && away(*p) <= window_rows; ++p)
    strongest = std::max(strongest, level_of(*p));
  return std::find_if(begin, end, [&](const RidgePoint& p) { return level_of(p) >= strongest - kEnd_db; }) -
         begin;
}

void cut_ends(Ridge& ridge, std::size_t window_rows) {
  ridge.erase(ridge.begin(), ridge.begin() + faint_points(ridge.begin(), ridge.end(), window_rows));
  ridge.erase(ridge.end() - faint_points(ridge.rbegin(), ridge.rend(), window_rows), ridge.end());
}

void add_track(Formant& formant, const Spectrogram& spectrogram, const Ridge& ridge) {
  const LevelReference reference = level_reference(spectrogram);
  for (const RidgePoint& point : ridge)
    formant.track.push_back({spectrogram.position_m[point.row], point.frequency_per_m,
                             level_db(point.density, reference), point.prominence_db});
}

void add_strength(Formant& formant, const Spectrogram& spectrogram, const Ridge& ridge) {
  double power = 0, weighted = 0, prominence = 0;
  for (const RidgePoint& point : ridge) {
    power += point.density;
    weighted += point.density * point.frequency_per_m;
    prominence += point.prominence_db;
  }
  const auto count = static_cast<double>(ridge.size());
  const LevelReference reference = level_reference(spectrogram);
  const auto peak = std::ranges::max_element(ridge, {}, &RidgePoint::density);
  formant.frequency_per_m = weighted / power;
  formant.level_db = level_db(power / count, reference);
  formant.prominence_db = prominence / count;
  formant.peak_level_db = level_db(peak->density, reference);
  formant.peak_position_m = spectrogram.position_m[peak->row];
}

void add_extent(Formant& formant, const Spectrogram& spectrogram, const Ridge& ridge) {
  const auto [lowest, highest] = std::ranges::minmax_element(ridge, {}, &RidgePoint::frequency_per_m);
  std::vector<double> widths;
  for (const RidgePoint& point : ridge) widths.push_back(point.width_per_m);
  formant.from_m = spectrogram.position_m[ridge.front().row];
  formant.to_m = spectrogram.position_m[ridge.back().row];
  formant.open_from = ridge.front().row == 0;
  formant.open_to = ridge.back().row + 1 == spectrogram.position_m.size();
  formant.lowest_per_m = lowest->frequency_per_m;
  formant.highest_per_m = highest->frequency_per_m;
  formant.width_per_m = median_of(widths);
}

Formant formant_of(const Spectrogram& spectrogram, const Ridge& ridge) {
  Formant formant;
  add_track(formant, spectrogram, ridge);
  add_strength(formant, spectrogram, ridge);
  add_extent(formant, spectrogram, ridge);
  return formant;
}

bool long_enough(const Formant& formant, double shortest_m) {
  return formant.to_m - formant.from_m >= shortest_m * (1 - 1e-9);
}

}  // namespace

Result<std::vector<Formant>> find_formants(const Spectrogram& spectrogram, const FormantOptions& options) {
  TACTO_TRY(check(spectrogram, options));
  const double whole_m = spectrogram.position_m.back() - spectrogram.position_m.front();
  const double shortest_m = std::min(options.shortest_m.value_or(spectrogram.window_m / 2), whole_m);
  const auto window_rows = static_cast<std::size_t>(std::lround(spectrogram.window_m / spectrogram.hop_m));
  std::vector<Formant> formants;
  for (Ridge& ridge : all_ridges(spectrogram, options)) {
    if (std::ranges::max(ridge, {}, &RidgePoint::prominence_db).prominence_db < options.start_db) continue;
    cut_ends(ridge, window_rows);
    Formant formant = formant_of(spectrogram, ridge);
    if (long_enough(formant, shortest_m)) formants.push_back(std::move(formant));
  }
  std::ranges::sort(formants, std::greater(), &Formant::peak_level_db);
  return formants;
}

Result<schema::FormantTable> formant_table(const Spectrogram& spectrogram, const FormantOptions& options) {
  auto formants = find_formants(spectrogram, options);
  TACTO_TRY(formants);
  return schema::FormantTable{spectrogram.name,
                              spectrogram.quantity,
                              spectrogram.unit,
                              level_reference(spectrogram).unit,
                              spectrogram.window_m,
                              spectrogram.hop_m,
                              resolution_per_m(spectrogram),
                              options.start_db,
                              options.continue_db,
                              spectrogram.simulated,
                              std::move(*formants)};
}

}  // namespace tacto::spatial
