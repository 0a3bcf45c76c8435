// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <random>

#include "analysis/extremes/extreme.hpp"
#include "data-schema/base/decibels.hpp"
#include "spatial/features/formants.hpp"
#include "spatial/spectrogram/spectrogram.hpp"

namespace tacto::analysis {
namespace {

using schema::Formant;

constexpr double kFormantPitchM = 10e-6, kFormantWindowM = 10e-3;
constexpr double kBinPerM = 1 / kFormantWindowM;  // of the unpadded window
constexpr double kStatedBins = 0.02;              // find_formants: for a line 20 dB over its background
constexpr double kLinePerM = 3210;
constexpr std::size_t kFormantSamples = 6000;

struct ExtremeLine {
  double per_m, amplitude;
};

schema::Texture texture_of_lines(std::vector<double> values, const std::vector<ExtremeLine>& lines) {
  schema::Texture texture;
  texture.signal = {kFormantPitchM, 0, std::move(values)};
  for (std::size_t i = 0; i < texture.signal.values.size(); ++i)
    for (const ExtremeLine& line : lines)
      texture.signal.values[i] += line.amplitude * std::sin(2 * std::numbers::pi * line.per_m *
                                                            kFormantPitchM * static_cast<double>(i));
  return texture;
}

schema::Texture texture_of_lines(const std::vector<ExtremeLine>& lines) {
  return texture_of_lines(std::vector<double>(kFormantSamples), lines);
}

spatial::SpectrogramOptions formant_options() {
  spatial::SpectrogramOptions options;
  options.window_m = kFormantWindowM;
  options.padded_m = 2 * kFormantWindowM;
  options.max_frequency_per_m = 20e3;
  options.hop_m = 0.5e-3;
  return options;
}

std::vector<Formant> formants_in(const schema::Texture& texture,
                                 std::optional<schema::KnownBand> known = {}) {
  auto spectrogram = spatial::spatial_spectrogram(texture, formant_options());
  if (!spectrogram) return {};
  if (known) spectrogram->known.assign(spectrogram->position_m.size(), *known);
  return spatial::find_formants(*spectrogram).value_or(std::vector<Formant>{});
}

// |sum of w_n x_n exp(-2 pi i k n)|^2 around a place, in long double.
long double exact_power(const std::vector<double>& values, double centre_m, double per_m) {
  const auto window = static_cast<std::size_t>(std::lround(kFormantWindowM / kFormantPitchM));
  const auto first = static_cast<std::size_t>(std::lround(centre_m / kFormantPitchM)) - window / 2;
  constexpr long double kTurn = 2 * std::numbers::pi_v<long double>;
  std::complex<long double> sum = 0;
  for (std::size_t n = 0; n < window; ++n) {
    const long double turn = kTurn * static_cast<long double>(n) / static_cast<long double>(window);
    const long double w = 0.42L - 0.5L * std::cos(turn) + 0.08L * std::cos(2 * turn);
    sum += w * static_cast<long double>(values[first + n]) *
           std::polar(1.0L, -kTurn * per_m * kFormantPitchM * static_cast<long double>(n));
  }
  return std::norm(sum);
}

// Maximum of the lobe that contains a point, by golden section.
double exact_top(const std::vector<double>& values, double centre_m, double near_per_m) {
  constexpr double kGolden = 0.6180339887498949;
  double low = near_per_m - 0.5 * kBinPerM, high = near_per_m + 0.5 * kBinPerM;
  while (high - low > 1e-4 * kBinPerM) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    const bool below = exact_power(values, centre_m, a) > exact_power(values, centre_m, b);
    (below ? high : low) = below ? b : a;
  }
  return 0.5 * (low + high);
}

// Two lines within one lobe: distance of each point of the ridge from the lobe's maximum, in bins.
double one_lobe_error() {
  const schema::Texture texture = texture_of_lines({{kLinePerM, 1}, {kLinePerM + kBinPerM, 0.5}});
  const auto found = formants_in(texture);
  if (found.empty()) return INFINITY;
  double error = 0;
  for (const auto& point : found.front().track)
    error =
        std::max(error, std::abs(point.frequency_per_m -
                                 exact_top(texture.signal.values, point.position_m, point.frequency_per_m)));
  return error / kBinPerM;
}

// The largest |found - line|, in bins, of lines that each give a ridge along the whole texture.
double lines_error(const std::vector<Formant>& found, const std::vector<ExtremeLine>& lines) {
  double error = 0;
  for (const ExtremeLine& line : lines) {
    double nearest = INFINITY;
    for (const Formant& formant : found)
      nearest = std::min(nearest, std::abs(formant.frequency_per_m - line.per_m));
    error = std::max(error, nearest / kBinPerM);
  }
  return error;
}

std::vector<ExtremeLine> pair_apart(double bins) {
  return {{kLinePerM, 1}, {kLinePerM + bins * kBinPerM, 1}};
}

// Smallest resolved distance, in steps of a quarter of a bin.
double resolved_from_bins() {
  double bins = 8;
  while (bins > 0.25 &&
         lines_error(formants_in(texture_of_lines(pair_apart(bins - 0.25))), pair_apart(bins - 0.25)) < 0.25)
    bins -= 0.25;
  return bins;
}

constexpr schema::KnownBand kKnown{1000, 5000};

double edge_error(double bins_inside) {
  const std::vector<ExtremeLine> line = {{kKnown.high_per_m - bins_inside * kBinPerM, 1}};
  return lines_error(formants_in(texture_of_lines(line), kKnown), line);
}

double nearest_to_edge_bins() {
  double bins = 6;
  while (bins > 0 && edge_error(bins - 0.1) < kStatedBins) bins -= 0.1;
  return bins;
}

// Noise through three poles at 0.2 /mm: constant below, decreasing by 60 dB per decade above. Its one-sided
// density is 2 pitch |1 / (1 - r exp(-i w))|^6.
constexpr double kSlopePole = 0.98751;  // exp(-2 pi 0.2 /mm 10 um)

double slope_density(double per_m) {
  const double turn = 2 * std::numbers::pi * per_m * kFormantPitchM;
  return 2 * kFormantPitchM / std::pow(std::norm(1.0 - std::polar(kSlopePole, -turn)), 3);
}

std::vector<double> slope_values() {
  constexpr std::size_t kSettled = 2000;
  std::mt19937_64 random(17);
  std::normal_distribution<double> normal;
  std::vector<double> values;
  double state[3] = {};
  for (std::size_t i = 0; i < kSettled + kFormantSamples; ++i) {
    double value = normal(random);
    for (double& each : state) value = each = kSlopePole * each + value;
    if (i >= kSettled) values.push_back(value);
  }
  return values;
}

// Blackman's sums are 0.42 W and 0.3046 W, so the density of a line is A^2 / 2 0.42^2 / 0.3046 window.
ExtremeLine line_on_slope(double per_m) {
  constexpr double kOver = 100;  // 20 dB
  return {per_m, std::sqrt(2 * kOver * slope_density(per_m) * 0.3046 / (0.42 * 0.42 * kFormantWindowM))};
}

double slope_error(double per_m) {
  const std::vector<ExtremeLine> line = {line_on_slope(per_m)};
  return lines_error(formants_in(texture_of_lines(slope_values(), line)), line);
}

double under_strongest_db(double per_m) {
  const double strongest = slope_density(2 * kBinPerM), line = 100 * slope_density(per_m);
  return schema::power_db(strongest / line);
}

double deepest_on_slope_db() {
  double per_m = 2000;
  while (per_m < 10000 && slope_error(1.05 * per_m) < 0.25) per_m *= 1.05;
  return under_strongest_db(per_m);
}

// A line 100 dB below another is below the window's side lobes: one formant must be found, and no side lobe.
double found_beside_strong_line() {
  const auto found = formants_in(texture_of_lines({{kLinePerM, 1}, {3 * kLinePerM, 1e-5}}));
  return std::abs(static_cast<double>(found.size()) - 1);
}

double size_error(double size_n) {
  const auto found = formants_in(texture_of_lines({{kLinePerM, size_n}}));
  const auto usual = formants_in(texture_of_lines({{kLinePerM, 1}}));
  if (found.size() != 1 || usual.size() != 1) return INFINITY;
  return std::max(std::abs(found[0].frequency_per_m - usual[0].frequency_per_m) / kBinPerM,
                  std::abs(found[0].level_db - usual[0].level_db - schema::amplitude_db(size_n)));
}

// The spectrogram's cells are squares in single precision, so that very large and very small forces are
// refused.
bool is_refused(double size_n) {
  return !spatial::spatial_spectrogram(texture_of_lines({{kLinePerM, size_n}}), formant_options());
}

// By bisection; `good_n` is not refused.
double refused_from_n(double good_n, double bad_n) {
  while (std::max(bad_n / good_n, good_n / bad_n) > 1.02) {
    const double middle_n = std::sqrt(good_n * bad_n);
    (is_refused(middle_n) ? bad_n : good_n) = middle_n;
  }
  return bad_n;
}

}  // namespace

std::vector<Extreme> formant_extremes() {
  constexpr double kOnSlopePerM = 2400;
  const std::vector<ExtremeLine> apart = pair_apart(4);
  std::vector<Extreme> rows = {
      {"spatial",
       "formants: two lines a bin apart, one lobe; in bins",
       "the top of the lobe, by the transform's definition in long double",
       one_lobe_error(),
       kStatedBins,
       {}},
      {"spatial", "formants: two equal lines 4 bins apart; in bins", "the lines'",
       lines_error(formants_in(texture_of_lines(apart)), apart), kStatedBins,
       fmt::format("separable from {:g} bins on", resolved_from_bins())},
      {"spatial", "formants: a line 2 bins from the band's edge; in bins", "the line's", edge_error(2),
       kStatedBins, fmt::format("none is reported nearer than {:.1f} bins", nearest_to_edge_bins())},
      {"spatial",
       fmt::format("formants: a line {:.0f} dB down on a slope of 60 dB a decade; in bins",
                   under_strongest_db(kOnSlopePerM)),
       "the line's", slope_error(kOnSlopePerM), kStatedBins,
       fmt::format("none is reported deeper than {:.0f} dB below the strongest of its row",
                   deepest_on_slope_db())},
      {"spatial", "formants: a line 100 dB below another: false formants", "one", found_beside_strong_line(),
       0, "the window's side lobes are at -58 dB"}};
  for (const double size_n : {1e-12, 1e18})
    rows.push_back(
        {"spatial", fmt::format("formants: a line of {:g} N; in bins and dB", size_n),
         "that of 1 N, and 20 log10 of it", size_error(size_n), 1e-4,
         fmt::format("{} {:.1g} N its densities do not fit single precision: refused",
                     size_n < 1 ? "below" : "from", refused_from_n(size_n, size_n < 1 ? 1e-16 : 1e25))});
  return rows;
}

}  // namespace tacto::analysis
