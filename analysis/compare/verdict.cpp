// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "data-schema/base/decibels.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/base/raised_cosine.hpp"
#include "data-schema/base/statistics.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::analysis {
namespace {

using Powers = std::vector<double>;

// 0, v_0, v_0 + v_1, ...: one value more than the input.
std::vector<double> running_sums(const std::vector<double>& values) {
  std::vector<double> sums(values.size() + 1, 0.0);
  std::partial_sum(values.begin(), values.end(), sums.begin() + 1);
  return sums;
}

// Mean over `reach` values to each side. Near an end the reach is shorter, but equal to both sides.
std::vector<double> local_mean(const std::vector<double>& values, std::size_t reach) {
  const std::vector<double> sums = running_sums(values);
  std::vector<double> means(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::size_t r = std::min({reach, k, values.size() - 1 - k});
    means[k] = (sums[k + r + 1] - sums[k - r]) / static_cast<double>(2 * r + 1);
  }
  return means;
}

constexpr double kTapered = 0.125;                             // of the length, at each end
constexpr std::size_t kDensity = 48, kLevel = 192, kNear = 8;  // half bins to each side
constexpr double kFewestBins = 30;
constexpr double kLineFloor = 1e-6;  // of the strongest place, as for the verdict's bands
// Bandwidths in bins, from a line's peak over the density of its bin: of the taper (1.1) and of Hann (1.5).
constexpr double kTaperBandwidth = 1.102, kHannWidth = 1.5;

// The power that 0.5 % of the pairs exceed: fitted to 30-7,680 bins (tests/analysis/compare_thresholds.py),
// within 3 %.
double chance_power(double bins) {
  const double log = std::log(bins);
  return 7.7 + 0.8 * log + 0.02 * log * log;
}

// A line of mean power P is found in 8 of 10 pairs if sqrt(P) exceeds the threshold's root by 0.84 standard
// deviations of a bin's amplitude, sqrt(1/2). The mean of 17 half bins beside the line, and frequencies
// between half bins, cost 0.8 dB (measured: compare_narrow_test).
double detectable_power(double threshold) {
  constexpr double kLost = 1.2;
  return kLost * std::pow(std::sqrt(threshold) + 0.841621 * std::numbers::sqrt2 / 2, 2);
}

Powers tapered(std::span<const double> values, std::size_t length) {
  Powers out(length, 0.0);
  const std::size_t n = values.size();
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n);
  const auto edge = static_cast<std::size_t>(kTapered * static_cast<double>(n));
  const auto weight = [&](std::size_t from_end) {
    if (from_end >= edge) return 1.0;
    return schema::rising_cosine(std::numbers::pi * (static_cast<double>(from_end) + 0.5) /
                                 static_cast<double>(edge));
  };
  for (std::size_t i = 0; i < n; ++i) out[i] = weight(std::min(i, n - 1 - i)) * (values[i] - mean);
  return out;
}

// Powers of the bins within the band; the floor covers window leakage and rounding.
Powers line_powers(std::span<const double> values, spatial::RealFft& fft, std::size_t first,
                   std::size_t count) {
  const Powers frame = tapered(values, fft.length());
  std::vector<std::complex<double>> spectrum(fft.bins());
  fft.forward(frame, spectrum);
  Powers powers;
  for (std::size_t k = first; k < first + count; ++k) powers.push_back(std::norm(spectrum[k]));
  const double least = kLineFloor * std::ranges::max(local_mean(powers, kNear));
  for (double& power : powers) power += least;
  return powers;
}

Powers logarithms(const Powers& values) {
  Powers out(values.size());
  std::ranges::transform(values, out.begin(), [](double v) { return std::log(v); });
  return out;
}

// Divides each by the smooth density of both, at its own level, so that the mean is 1.
void flatten(Powers& a, Powers& b) {
  const Powers log_a = logarithms(a), log_b = logarithms(b);
  const Powers near_a = local_mean(log_a, kDensity), near_b = local_mean(log_b, kDensity);
  const Powers far_a = local_mean(log_a, kLevel), far_b = local_mean(log_b, kLevel);
  for (std::size_t k = 0; k < a.size(); ++k) {
    // The mean logarithm of an exponential variable is -gamma.
    const double density = 0.5 * (near_a[k] + near_b[k]) + std::numbers::egamma;
    const double half_level = 0.5 * (far_b[k] - far_a[k]);
    a[k] = std::exp(log_a[k] - density + half_level);
    b[k] = std::exp(log_b[k] - density - half_level);
  }
}

struct Peak {
  std::size_t at = 0;
  double power = 0;
};
Peak highest_over(const Powers& powers, const Powers& others) {
  const Powers beside = local_mean(others, kNear);
  Peak peak;
  for (std::size_t k = 0; k < powers.size(); ++k)
    if (const double power = powers[k] / std::max(1.0, beside[k]); power > peak.power) peak = {k, power};
  return peak;
}

using Values = std::vector<double>;

constexpr std::array<std::size_t, 10> kWidths = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32};
constexpr std::size_t kFewestCells = 6;
constexpr std::size_t kWhitened = 8;  // cells to each side for the smooth density
constexpr double kDecibels = 10 / std::numbers::ln10;
constexpr double kOverlap = 19.0 / 18;  // variance of a mean over half-overlapping Hann windows (Welch 1967)
constexpr double kCellFloor = 1e-6;     // of the strongest cell, as for the verdict's bands
constexpr double kEightInTen = 0.841621;  // standard deviations, for a detection rate of 80 %

// Scores that 4.5 % of the pairs of white Gaussian noise exceed, 15 segments each (4,000 pairs and more up to
// 192 cells, 600 to 2,000 above), from tests/analysis/compare_thresholds.py. With 8 or 30 segments they
// differ by 1 %.
struct ChanceScore {
  double cells, score;
};
constexpr std::array<ChanceScore, 9> kChance = {{{6, 2.49},
                                                 {12, 2.92},
                                                 {24, 3.26},
                                                 {48, 3.55},
                                                 {96, 3.77},
                                                 {192, 3.97},
                                                 {384, 4.15},
                                                 {768, 4.33},
                                                 {1536, 4.50}}};

// Interpolates along ln(cells); extrapolates the table's last line.
double chance_score(std::size_t cells) {
  const auto count = static_cast<double>(cells);
  std::size_t i = 1;
  while (i + 1 < kChance.size() && kChance[i].cells < count) ++i;
  const ChanceScore &low = kChance[i - 1], &high = kChance[i];
  const double part = std::log(count / low.cells) / std::log(high.cells / low.cells);
  return low.score + part * (high.score - low.score);
}

double trigamma(double x) {  // Abramowitz and Stegun 6.4.12; within 1e-4 from 3 on
  return 1 / x + 1 / (2 * x * x) + 1 / (6 * x * x * x);
}

// Shape of the gamma distribution of a band's power: `width` cells of n half-overlapping Hann windows of
// white noise. The correlation of two cells' powers is the squared transform of w(x) w(x + s).
double gamma_shape(std::size_t width, std::size_t segments) {
  constexpr std::array<double, 4> kSameSegment = {1, 4.0 / 9, 1.0 / 36, 0};
  constexpr std::array<double, 4> kNextSegment = {1.0 / 36, 0.0200141, 1.0 / 144, 0.000800562};
  const auto n = static_cast<double>(segments), w = static_cast<double>(width);
  double variance = 0;
  for (std::size_t d = 0; d < std::min<std::size_t>(width, 4); ++d)
    variance += (d == 0 ? 1 : 2) * (w - static_cast<double>(d)) *
                (kSameSegment[d] + 2 * (n - 1) / n * kNextSegment[d]);
  return w * w * n / variance;
}

Values mean_row(const Values& rows, std::size_t cells) {
  Values mean(cells, 0.0);
  for (std::size_t i = 0; i < rows.size(); ++i) mean[i % cells] += rows[i];
  const double count = static_cast<double>(rows.size()) / static_cast<double>(cells);
  for (double& value : mean) value /= count;
  return mean;
}

// The cells of one texture: mean over all segments, and over all segments but one.
class CellPowers {
 public:
  CellPowers(const Values& rows, const Values& smooth) : segments_(rows.size() / smooth.size()) {
    Values mean = mean_row(rows, smooth.size());
    const auto n = static_cast<double>(segments_);
    for (std::size_t row = 0; row < segments_; ++row) {
      Values rest(smooth.size());
      for (std::size_t k = 0; k < rest.size(); ++k)
        rest[k] = (n * mean[k] - rows[row * rest.size() + k]) / ((n - 1) * smooth[k]);
      without_.push_back(whitened(rest));
    }
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] /= smooth[k];
    all_ = whitened(mean);
  }

  struct Powers {
    Values sums;          // running sums over the cells
    double mean_log = 0;  // over the cells
    double log_of(std::size_t first, std::size_t width) const {
      return std::log(sums[first + width] - sums[first]) - mean_log;
    }
  };
  std::size_t segments() const { return segments_; }
  std::size_t cells() const { return all_.sums.size() - 1; }
  const Powers& all() const { return all_; }
  const Powers& without(std::size_t segment) const { return without_[segment]; }

 private:
  static Powers whitened(const Values& cells) {
    double sum = 0;
    for (const double power : cells) sum += std::log(power);
    return {running_sums(cells), sum / static_cast<double>(cells.size())};
  }

  std::size_t segments_;
  Powers all_;
  std::vector<Powers> without_;
};

// The cells within the band, each raised to the floor.
Values cells_of(const Values& density, const SegmentSpectra& spectra, std::size_t first, std::size_t cells) {
  Values rows, mean(cells, 0.0);
  for (std::size_t row = 0; row < density.size() / spectra.bins; ++row)
    for (std::size_t k = 0; k < cells; ++k) {
      rows.push_back(density[row * spectra.bins + first + k]);
      mean[k] += rows.back();
    }
  const double least = kCellFloor * *std::ranges::max_element(mean) * static_cast<double>(cells) /
                       static_cast<double>(rows.size());
  for (double& power : rows) power += least;
  return rows;
}

Values smooth_density(const Values& a, const Values& b, std::size_t cells) {
  const Values of_a = mean_row(a, cells), of_b = mean_row(b, cells);
  Values logs(cells);
  for (std::size_t k = 0; k < cells; ++k) logs[k] = 0.5 * std::log(of_a[k] * of_b[k]);
  logs = local_mean(logs, kWhitened);
  for (double& value : logs) value = std::exp(value);
  return logs;
}

// The jackknife variance (Efron 1979) of values, each computed without one segment.
double jackknife_variance(const Values& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return (n - 1) / n * squares;
}

// Variance of ln(B / A) in the band from the scatter of the segments; paired segments are compared in pairs.
double seen_variance(const CellPowers& a, const CellPowers& b, bool paired, std::size_t first,
                     std::size_t width) {
  Values of_a, of_b;
  for (std::size_t i = 0; i < a.segments(); ++i) of_a.push_back(a.without(i).log_of(first, width));
  for (std::size_t i = 0; i < b.segments(); ++i) of_b.push_back(b.without(i).log_of(first, width));
  if (!paired) return kOverlap * (jackknife_variance(of_a) + jackknife_variance(of_b));
  for (std::size_t i = 0; i < of_b.size(); ++i) of_b[i] -= of_a[i];
  return kOverlap * jackknife_variance(of_b);
}

double steady_variance(const CellPowers& a, const CellPowers& b, std::size_t width) {
  const auto cells = static_cast<double>(a.cells());
  return (trigamma(gamma_shape(width, a.segments())) + trigamma(gamma_shape(width, b.segments()))) *
         (1 - static_cast<double>(width) / cells);  // the band is itself a part of the mean level
}

// Standard error of the level of a band of this width, dB: that of steady textures, or the scatter of the
// segments averaged over all places if it is larger. The scatter of a single band is too uncertain to divide
// by.
double standard_error(const CellPowers& a, const CellPowers& b, bool paired, std::size_t width) {
  const std::size_t places = a.cells() - width + 1;
  double seen = 0;
  for (std::size_t first = 0; first < places; ++first) seen += seen_variance(a, b, paired, first, width);
  return kDecibels * std::sqrt(std::max(seen / static_cast<double>(places), steady_variance(a, b, width)));
}

// Rise of a band of so many cells that is found, and exceeds the tolerance, in 8 of 10 pairs. The rise also
// lifts the mean level, which is subtracted. With Hann's window and edges between cells, the power of a third
// of a cell falls outside of the band (measured: compare_narrow_test).
double detectable_db(double standard_error_db, const NarrowBand& best, double tolerance_db, std::size_t width,
                     std::size_t cells) {
  constexpr double kLostCells = 0.35;
  const auto w = static_cast<double>(width), c = static_cast<double>(cells);
  const double threshold_db = std::max(best.chance_score * standard_error_db, tolerance_db);
  const double seen_db = (threshold_db + kEightInTen * standard_error_db) / (1 - w / c);
  return kDecibels * std::log1p(std::expm1(seen_db / kDecibels) / (1 - kLostCells / w));
}

struct BandAxis {
  double step, low;  // distance of the cells; lower edge of the first cell
};

void scan_width(NarrowBand& best, const CellPowers& a, const CellPowers& b, bool paired, std::size_t width,
                const BandAxis& axis, double tolerance_db) {
  const double error_db = standard_error(a, b, paired, width);
  // A wide band with a high score but a level within the tolerance must not hide a band beyond the tolerance.
  const auto rank = [&](double level_db, double score) {
    return std::pair(std::abs(level_db) > tolerance_db, score);
  };
  for (std::size_t first = 0; first + width <= a.cells(); ++first) {
    const double level_db = kDecibels * (b.all().log_of(first, width) - a.all().log_of(first, width));
    const double score = std::abs(level_db) / error_db;
    if (rank(level_db, score) > rank(best.level_db, best.score)) {
      best.score = score;
      best.level_db = level_db;
      best.low_per_m = axis.low + axis.step * static_cast<double>(first);
      best.high_per_m = best.low_per_m + axis.step * static_cast<double>(width);
    }
  }
  best.detectable.push_back({axis.step * static_cast<double>(width),
                             detectable_db(error_db, best, tolerance_db, width, a.cells())});
}

constexpr std::size_t kDraws = 1000;
constexpr std::uint64_t kDrawSeed = 6;
constexpr double kFloorDb = 60;  // lower powers come from windows and converters, not from the texture

double db_of(double ratio) {
  return schema::power_db(ratio);
}

using Bands = std::vector<double>;

Bands summed(std::span<const double> rows, std::size_t bands, std::span<const std::size_t> drawn) {
  Bands sum(bands, 0.0);
  for (const std::size_t row : drawn)
    for (std::size_t b = 0; b < bands; ++b) sum[b] += rows[row * bands + b];
  const double least = *std::ranges::max_element(sum) * schema::power_of_db(-kFloorDb);
  for (double& power : sum) power = std::max(power, least) / static_cast<double>(drawn.size());
  return sum;
}

Bands differences_db(const Bands& a, const Bands& b) {
  Bands out(a.size());
  std::ranges::transform(a, b, out.begin(), [](double x, double y) { return db_of(y / x); });
  return out;
}

std::vector<std::size_t> all_rows(std::size_t rows) {
  std::vector<std::size_t> all(rows);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::vector<std::size_t> some_rows(std::size_t rows, std::mt19937_64& random) {
  std::vector<std::size_t> drawn(rows);
  for (std::size_t& row : drawn) row = random() % rows;
  return drawn;
}

// Deviations of the bands' differences from the measured ones, one draw per row.
std::vector<Bands> drawn_deviations(const BandPowers& powers, const Bands& seen) {
  std::mt19937_64 random(kDrawSeed);
  const std::size_t rows_a = powers.a.size() / powers.bands, rows_b = powers.b.size() / powers.bands;
  const auto n = static_cast<double>(std::min(rows_a, rows_b));
  const double widened = std::sqrt(n / (n - 1) * 19.0 / 18);
  std::vector<Bands> draws(kDraws);
  for (Bands& draw : draws) {
    const auto of_a = some_rows(rows_a, random);
    const auto of_b = powers.paired ? of_a : some_rows(rows_b, random);
    draw = differences_db(summed(powers.a, powers.bands, of_a), summed(powers.b, powers.bands, of_b));
    for (std::size_t b = 0; b < draw.size(); ++b) draw[b] = widened * (draw[b] - seen[b]);
  }
  return draws;
}

double weighted_mean(const Bands& values, const Bands& weights) {
  return std::inner_product(values.begin(), values.end(), weights.begin(), 0.0);
}

// RMS deviation from the weighted mean; the weights sum to 1.
double shape_of(const Bands& values, const Bands& weights) {
  const double mean = weighted_mean(values, weights);
  double sum = 0;
  for (std::size_t b = 0; b < values.size(); ++b) sum += weights[b] * std::pow(values[b] - mean, 2);
  return std::sqrt(sum);
}

Bands scatter_of(const std::vector<Bands>& draws, std::size_t bands) {
  Bands scatter(bands);
  for (std::size_t b = 0; b < bands; ++b) {
    std::vector<double> column;
    for (const Bands& draw : draws) column.push_back(draw[b]);
    scatter[b] = schema::rms_of(column);
  }
  return scatter;
}

Bands weights_of(const Bands& scatter, double tolerance_db) {
  Bands weights;
  for (const double s : scatter) weights.push_back(1 / (s * s + tolerance_db * tolerance_db));
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

void judge_level(Evidence& evidence, const std::vector<Bands>& draws, const Bands& weights) {
  std::vector<double> levels;
  for (const Bands& draw : draws) levels.push_back(weighted_mean(draw, weights));
  const double reach = schema::student_t(static_cast<double>(evidence.segments - 1), schema::kOneSided95) *
                       schema::rms_of(levels);
  evidence.level_db = weighted_mean(evidence.band_db, weights);
  evidence.level_low_db = evidence.level_db - reach;
  evidence.level_high_db = evidence.level_db + reach;
}

void judge_shape(Evidence& evidence, const std::vector<Bands>& draws, const Bands& weights) {
  std::vector<double> shapes;
  for (const Bands& draw : draws) shapes.push_back(shape_of(draw, weights));
  const double mean_square = std::pow(schema::rms_of(shapes), 2);
  std::ranges::sort(shapes);
  evidence.shape_db = shape_of(evidence.band_db, weights);
  evidence.shape_chance_db = shapes[kDraws * 95 / 100];
  evidence.shape_excess_db = std::sqrt(std::max(0.0, std::pow(evidence.shape_db, 2) - mean_square));
  evidence.finest_shape_db = std::sqrt(std::max(0.0, std::pow(evidence.shape_chance_db, 2) - mean_square));
}

std::string frequency_words(double per_m) {
  return schema::for_people(per_m, schema::Dimension::spatial_frequency);
}

std::string band_words(const NarrowBand& band) {
  return fmt::format(
      "from {} to {} B is {:.1f} dB {} A, relative to the mean level (score {:.1f}, chance {:.1f})",
      frequency_words(band.low_per_m), frequency_words(band.high_per_m), std::abs(band.level_db),
      band.level_db > 0 ? "above" : "below", band.score, band.chance_score);
}

std::string line_words(const SpectralLine& line) {
  return fmt::format(
      "{} has a line at {} that {} does not have, {:.1f} dB above the density (score {:.1f}, chance {:.1f})",
      line.in_b ? "B" : "A", frequency_words(line.frequency_per_m), line.in_b ? "A" : "B", line.level_db,
      line.score, line.chance_score);
}

// A sentence about narrow bands and lines that differ; empty if none does.
std::string narrow_words(const Evidence& e, double tolerance_db) {
  std::string words;
  if (band_differs(e, tolerance_db)) words = band_words(*e.narrow);
  if (line_differs(e, tolerance_db)) words += (words.empty() ? "" : "; ") + line_words(*e.line);
  return words;
}

std::string shape_words(const Evidence& e, double tolerance_db) {
  return fmt::format(
      "the one-third-octave bands differ by {:.1f} dB RMS about their mean (chance {:.1f} dB; {:.2f} dB "
      "beyond it, "
      "tolerance {:g} dB)",
      e.shape_db, e.shape_chance_db, e.shape_excess_db, tolerance_db);
}

std::string level_words(const Evidence& e) {
  const auto rounded = [](double db) { return std::round(10 * db) / 10 + 0.0; };  // never "-0.0"
  return fmt::format("level of B over A {:+.1f} dB ({:+.1f} to {:+.1f})", rounded(e.level_db),
                     rounded(e.level_low_db), rounded(e.level_high_db));
}

Verdict by_level(const Evidence& e, double tolerance_db) {
  const std::string shape = fmt::format("no difference in shape found ({:.1f} dB, chance up to {:.1f} dB)",
                                        e.shape_db, e.shape_chance_db);
  const std::string words = shape + ", " + level_words(e);
  const bool certain = e.level_low_db > 0 || e.level_high_db < 0;
  if (certain && std::abs(e.level_db) > tolerance_db)
    return {e.level_db > 0 ? Likeness::louder : Likeness::quieter, words};
  if (e.level_low_db >= -tolerance_db && e.level_high_db <= tolerance_db)
    return {Likeness::none, fmt::format("{}, within {:g} dB", words, tolerance_db)};
  return {Likeness::undecided,
          fmt::format("{}: this interval includes values beyond {:g} dB and values that are not", words,
                      tolerance_db)};
}

}  // namespace

std::optional<SpectralLine> strongest_line(std::span<const double> a, std::span<const double> b, double pitch,
                                           double low, double high, double window) {
  const std::size_t n = std::min(a.size(), b.size());
  const double length = static_cast<double>(n) * pitch, bins = (high - low) * length;
  if (bins < kFewestBins) return std::nullopt;
  spatial::RealFft fft(spatial::fast_length(2 * n));
  const double step = 1 / (static_cast<double>(fft.length()) * pitch);
  const auto first = static_cast<std::size_t>(std::ceil(low / step));
  const auto last = std::min(fft.bins() - 1, static_cast<std::size_t>(high / step));
  Powers of_a = line_powers(a.first(n), fft, first, last - first + 1);
  Powers of_b = line_powers(b.first(n), fft, first, last - first + 1);
  flatten(of_a, of_b);
  const Peak in_a = highest_over(of_a, of_b), in_b = highest_over(of_b, of_a);
  const Peak& peak = in_b.power > in_a.power ? in_b : in_a;
  const auto level_db = [&](double power) {  // `power` in units of a bin's power
    return schema::power_db(1 + power * kTaperBandwidth * window / (kHannWidth * static_cast<double>(n)));
  };
  const double threshold = chance_power(bins);
  return SpectralLine{static_cast<double>(first + peak.at) * step,
                      in_b.power > in_a.power,
                      level_db(std::max(0.0, peak.power - 1)),
                      peak.power,
                      threshold,
                      level_db(detectable_power(threshold))};
}

std::optional<NarrowBand> strongest_band(const SegmentSpectra& spectra, double low, double high,
                                         double tolerance_db) {
  std::size_t first = 0, cells = 0;
  for (std::size_t k = 0; k < spectra.bins; ++k)
    if (spectra.frequency(k) < low)
      first = k + 1;
    else if (spectra.frequency(k) <= high)
      ++cells;
  if (cells < kFewestCells || std::min(spectra.segments_a, spectra.segments_b) < 2) return std::nullopt;
  const Values rows_a = cells_of(spectra.aa, spectra, first, cells);
  const Values rows_b = cells_of(spectra.bb, spectra, first, cells);
  const Values smooth = smooth_density(rows_a, rows_b, cells);
  const CellPowers a(rows_a, smooth), b(rows_b, smooth);
  NarrowBand best;
  best.chance_score = chance_score(cells);
  const BandAxis axis{spectra.step, spectra.frequency(first) - 0.5 * spectra.step};
  for (const std::size_t width : kWidths)
    if (width <= cells / 2) scan_width(best, a, b, !spectra.ab.empty(), width, axis, tolerance_db);
  if (best.high_per_m == 0) best.high_per_m = high;  // of equal spectra no band has a score: the whole one
  // The outer cells extend half a cell beyond the band.
  best.low_per_m = std::max(best.low_per_m, low);
  best.high_per_m = std::min(best.high_per_m, high);
  return best;
}

std::string_view to_string(Likeness likeness) {
  constexpr std::array<std::string_view, 5> kWords = {"none", "louder", "quieter", "different", "undecided"};
  return kWords[static_cast<std::size_t>(likeness)];
}

std::string verdict_words(Likeness likeness) {
  if (likeness == Likeness::undecided) return "undecided";
  if (likeness == Likeness::none) return "no difference beyond measurement noise";
  return fmt::format("{} beyond measurement noise", to_string(likeness));
}

Evidence evidence_of(const BandPowers& powers, double tolerance_db) {
  const std::size_t rows_a = powers.a.size() / powers.bands, rows_b = powers.b.size() / powers.bands;
  Evidence evidence;
  evidence.bands = powers.bands;
  evidence.segments = std::min(rows_a, rows_b);
  evidence.band_db = differences_db(summed(powers.a, powers.bands, all_rows(rows_a)),
                                    summed(powers.b, powers.bands, all_rows(rows_b)));
  const auto draws = drawn_deviations(powers, evidence.band_db);
  evidence.scatter_db = scatter_of(draws, powers.bands);
  const Bands weights = weights_of(evidence.scatter_db, tolerance_db);
  judge_level(evidence, draws, weights);
  judge_shape(evidence, draws, weights);
  return evidence;
}

bool band_differs(const Evidence& e, double tolerance_db) {
  return e.narrow && e.narrow->score > e.narrow->chance_score && std::abs(e.narrow->level_db) > tolerance_db;
}

bool line_differs(const Evidence& e, double tolerance_db) {
  return e.line && e.line->score > e.line->chance_score && e.line->level_db > tolerance_db;
}

std::string detectable_words(const Evidence& e, double tolerance_db) {
  std::vector<std::string> parts;
  if (e.narrow) {
    const auto& all = e.narrow->detectable;
    for (const std::size_t i : {std::size_t{0}, all.size() / 2, all.size() - 1})
      parts.push_back(fmt::format("{:.1f} dB over {}", all[i].level_db, frequency_words(all[i].width_per_m)));
  }
  if (e.line)
    parts.push_back(
        fmt::format("or a line {:.1f} dB above the density", std::max(e.line->detectable_db, tolerance_db)));
  return parts.empty() ? ""
                       : fmt::format("{} (each is found in at least 8 of 10 pairs)", fmt::join(parts, ", "));
}

Verdict verdict_of(const Evidence& e, double tolerance_db) {
  if (e.segments < kFewestSegments)
    return {Likeness::undecided, fmt::format("too short: {} segments of the window, at least {} are needed",
                                             e.segments, kFewestSegments)};
  if (e.bands < kFewestBands)
    return {Likeness::undecided,
            fmt::format("too little in common: {} one-third-octave bands, at least an octave ({}) is needed",
                        e.bands, kFewestBands)};
  const std::string narrow = narrow_words(e, tolerance_db);
  const bool shape = e.shape_db > e.shape_chance_db && e.shape_excess_db > tolerance_db;
  if (shape || !narrow.empty())
    return {Likeness::different, fmt::format("{}{}{}; {}", narrow, shape && !narrow.empty() ? "; " : "",
                                             shape ? shape_words(e, tolerance_db) : "", level_words(e))};
  if (e.finest_shape_db > tolerance_db)
    return {Likeness::undecided,
            fmt::format("too noisy: only differences in shape above {:.1f} dB could be detected; {}",
                        e.finest_shape_db, level_words(e))};
  return by_level(e, tolerance_db);
}

}  // namespace tacto::analysis
