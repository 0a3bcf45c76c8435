// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/compare/band_sums.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/base/quantity.hpp"
#include "playback/session/session_rows.hpp"
#include "spatial/dsp/resample/low_pass.hpp"
#include "spatial/dsp/resample/thinned.hpp"
#include "spatial/dsp/resample/windowed_sinc.hpp"
#include "spatial/features/steady_part.hpp"
#include "spatial/features/third_octaves.hpp"
#include "spatial/spectrogram/spectrogram.hpp"
#include "spatial/texture/align_textures.hpp"
#include "spatial/texture/valid_band.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;
using schema::ErrorKind;
using schema::for_people;
using schema::Result;
using schema::Texture;

constexpr std::size_t kFewestPairSamples = 64;
constexpr double kSameGrid = 1e-6;      // of a pitch: a smaller difference is rounding
constexpr double kFractionPass = 0.35;  // cycles per coarse sample kept if the ratio is not an integer
constexpr double kFractionStop = 1 - kFractionPass;  // higher frequencies would alias onto the kept ones

// The steady part of one texture, on the common grid.
struct Side {
  double from_m = 0;   // in the texture
  double bench_m = 0;  // place of its first sample on the bench
  double pitch_m = 0;
  std::vector<double> values;
  schema::BandPoint band;
};

schema::BandPoint band_of_side(const Texture& texture) {
  schema::BandPoint band{0, 0, INFINITY};
  if (!texture.valid_band.empty()) band = spatial::band_throughout(texture.valid_band);
  band.high_per_m = std::min(band.high_per_m, 0.5 / texture.signal.pitch_m);
  return band;
}

Side side_of(const Texture& texture) {
  spatial::SteadyPart part = spatial::steady_part(texture);
  Side side{part.from_m, texture.source_origin_m + part.from_m, texture.signal.pitch_m, {}, {}};
  side.band = band_of_side(part.texture);
  side.values = std::move(part.texture.signal.values);
  return side;
}

std::vector<double> filtered(std::span<const double> values, std::span<const double> filter) {
  const auto reach = static_cast<std::ptrdiff_t>(filter.size() / 2);
  const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
  std::vector<double> out(values.size());
  for (std::ptrdiff_t at = 0; at <= last; ++at)
    for (std::ptrdiff_t i = -reach; i <= reach; ++i)
      out[static_cast<std::size_t>(at)] +=
          filter[static_cast<std::size_t>(i + reach)] *
          values[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at + i, 0, last))];
  return out;
}

// Values at the places `first + i step`, in samples, until the end of the values.
std::vector<double> at_places(std::span<const double> values, double first, double step) {
  const spatial::WindowedSinc sinc;
  std::vector<double> out;
  const double last = static_cast<double>(values.size() - 1) + kSameGrid;
  for (double i = 0; first + i * step <= last; ++i) out.push_back(sinc(values, first + i * step));
  return out;
}

void coarsen(Side& side, double pitch_m) {
  const double ratio = pitch_m / side.pitch_m;
  if (ratio < 1 + kSameGrid) return;
  const double whole = std::floor(ratio + kSameGrid), rest = ratio / whole;
  side.values = spatial::thinned(side.values, static_cast<std::size_t>(whole));
  double kept = whole > 1 ? spatial::kThinnedPass / (whole * side.pitch_m) : 0.5 / side.pitch_m;
  if (rest > 1 + kSameGrid) {
    if (kFractionStop / rest < 0.5)
      side.values = filtered(side.values, spatial::low_pass(kFractionPass / rest, kFractionStop / rest));
    side.values = at_places(side.values, 0, rest);
    kept = std::min(kept, kFractionPass / pitch_m);
  }
  side.band.high_per_m = std::min(side.band.high_per_m, kept);
  side.pitch_m = pitch_m;
}

void onto_one_grid(Side& a, Side& b, TexturePair& pair) {
  pair.pitch_m = std::max(a.pitch_m, b.pitch_m);
  const double finer_m = std::min(a.pitch_m, b.pitch_m);
  if (pair.pitch_m < finer_m * (1 + kSameGrid)) return;
  pair.notes.push_back(fmt::format(
      "{} is on a grid of {}, the other of {}: it was low-passed and resampled on the coarser one",
      a.pitch_m < b.pitch_m ? "A" : "B", for_people(finer_m, Dimension::length),
      for_people(pair.pitch_m, Dimension::length)));
  coarsen(a, pair.pitch_m);
  coarsen(b, pair.pitch_m);
}

// Number of common samples of both; the second begins `apart` samples after the first.
double common_samples(const Side& a, const Side& b, double apart) {
  const double end =
      std::min(static_cast<double>(a.values.size()), apart + static_cast<double>(b.values.size()));
  return end - std::max(0.0, apart);
}

// Distance from A's first sample to B's first sample, in samples.
double place_apart(const Side& a, const Side& b, TexturePair& pair) {
  const double apart = (b.bench_m - a.bench_m) / pair.pitch_m;
  const auto shorter = static_cast<double>(std::min(a.values.size(), b.values.size()));
  if (common_samples(a, b, apart) >= shorter / 2) {
    pair.aligned = "place";
    return apart;
  }
  pair.aligned = "start";
  pair.notes.emplace_back(
      "on the bench they share less than half of the shorter one: they are compared from their starts, not "
      "place by place");
  return 0;
}

std::vector<double> without_mean(std::span<const double> values) {
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  std::vector<double> out(values.begin(), values.end());
  for (double& value : out) value -= mean;
  return out;
}

double correlated_apart(const Side& a, const Side& b, double apart, const PairOptions& options,
                        TexturePair& pair) {
  const auto left = without_mean(a.values), right = without_mean(b.values);
  const spatial::Alignment found =
      spatial::align({0, left}, {apart, right}, options.max_shift_m / pair.pitch_m);
  pair.correlation = found.correlation;
  if (!found.found) {
    pair.notes.push_back(fmt::format("they agree at no shift within {} (correlation {:.2f})",
                                     for_people(options.max_shift_m, Dimension::length), found.correlation));
    return apart;
  }
  pair.aligned = "correlation";
  pair.shift_m = found.shift * pair.pitch_m;
  return apart + found.shift;
}

void cut(const Side& a, const Side& b, double apart, TexturePair& pair) {
  const double first = std::ceil(std::max(0.0, apart) - kSameGrid);
  const double place_in_b = first - apart;
  const bool on_grid = std::abs(place_in_b - std::round(place_in_b)) < kSameGrid;
  pair.b = on_grid
               ? std::vector<double>(b.values.begin() + static_cast<std::ptrdiff_t>(std::round(place_in_b)),
                                     b.values.end())
               : at_places(b.values, place_in_b, 1);
  pair.a.assign(a.values.begin() + static_cast<std::ptrdiff_t>(first), a.values.end());
  const std::size_t size = std::min(pair.a.size(), pair.b.size());
  pair.a.resize(size);
  pair.b.resize(size);
  pair.a_from_m = a.from_m + first * pair.pitch_m;
  pair.b_from_m = b.from_m + place_in_b * pair.pitch_m;
}

void pair_places(Side& a, Side& b, const PairOptions& options, TexturePair& pair) {
  if (options.align == PairAlign::none) {
    pair.aligned = "none";
    pair.paired = false;
    pair.a = std::move(a.values);
    pair.b = std::move(b.values);
    pair.a_from_m = a.from_m;
    pair.b_from_m = b.from_m;
    return;
  }
  double apart = place_apart(a, b, pair);
  if (options.align == PairAlign::correlation) apart = correlated_apart(a, b, apart, options, pair);
  cut(a, b, apart, pair);
}

Result<void> check_alike(const Texture& a, const Texture& b) {
  if (a.quantity == b.quantity && a.unit == b.unit) return {};
  return schema::fail(ErrorKind::unsuitable,
                      fmt::format("B contains {} in {}, A {} in {}", b.quantity, b.unit, a.quantity, a.unit),
                      "quantity", "compare textures of one quantity");
}

Result<void> check_pair(const TexturePair& pair) {
  const std::size_t samples = std::min(pair.a.size(), pair.b.size());
  if (samples < kFewestPairSamples)
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("they have {} samples in common, a spectrum needs at least {}", samples,
                                    kFewestPairSamples),
                        "A and B", "use longer textures, or a finer grid");
  if (pair.low_per_m < pair.high_per_m) return {};
  return schema::fail(ErrorKind::unsuitable,
                      fmt::format("they have no band in common: one is valid from {} on, the other up to {}",
                                  for_people(pair.low_per_m, Dimension::spatial_frequency),
                                  for_people(pair.high_per_m, Dimension::spatial_frequency)),
                      "A and B", "use strokes of more similar speed, or wider bands");
}

bool share_places(const schema::Formant& a, const schema::Formant& b) {
  const double common = std::min(a.to_m, b.to_m) - std::max(a.from_m, b.from_m);
  return common >= std::min(a.to_m - a.from_m, b.to_m - b.from_m) / 2;
}

constexpr double kShortestCompareWindow = 16;  // samples
constexpr double kHannBandwidth = 1.5;         // bins
constexpr double kLeastCoherence = 0.5;        // of two copies; two gratings with common lines have less
constexpr double kAgreeing = 0.5;              // smallest correlation that counts as agreement
constexpr double kThousandDb = 60, kNearThousandDb = 1;
constexpr double kWindowsInShorter = 8, kWavelengths = 8;

double usual_window(const TexturePair& pair) {
  const auto shorter = static_cast<double>(std::min(pair.a.size(), pair.b.size()));
  const double longest = pair.low_per_m > 0 ? kWavelengths / (pair.low_per_m * pair.pitch_m) : INFINITY;
  return std::max(kShortestCompareWindow, std::min(shorter / kWindowsInShorter, longest));
}

Result<std::size_t> compare_window(const TexturePair& pair, const CompareOptions& options) {
  const auto shorter = static_cast<double>(std::min(pair.a.size(), pair.b.size()));
  const double window = options.window_m ? *options.window_m / pair.pitch_m : usual_window(pair);
  if (std::isfinite(window) && window >= kShortestCompareWindow - 0.5 && window * 1.5 < shorter + 0.5)
    return static_cast<std::size_t>(std::llround(window));
  return schema::fail(
      options.window_m ? ErrorKind::usage : ErrorKind::unsuitable,
      fmt::format("a window of {} can't be used on {}", for_people(window * pair.pitch_m, Dimension::length),
                  for_people(shorter * pair.pitch_m, Dimension::length)),
      "window", "two half-overlapping windows of at least 16 samples have to fit");
}

Result<void> set_band(Comparison& comparison) {
  comparison.low_per_m = std::max(comparison.pair.low_per_m, kHannBandwidth / comparison.window_m);
  comparison.high_per_m = comparison.pair.high_per_m;
  if (comparison.low_per_m < comparison.high_per_m) return {};
  return schema::fail(ErrorKind::unsuitable,
                      fmt::format("a window of {} resolves nothing below {}, where the common band ends",
                                  for_people(comparison.window_m, Dimension::length),
                                  for_people(comparison.low_per_m, Dimension::spatial_frequency)),
                      "A and B", "use longer textures");
}

BandComparison compared_band(const schema::ThirdOctaveBand& band, const BandSums& sums, double gain) {
  BandComparison out{band.centre_per_m,
                     band.low_per_m,
                     band.high_per_m,
                     band.partial,
                     std::sqrt(sums.aa),
                     std::sqrt(sums.bb),
                     0,
                     0,
                     {},
                     {},
                     {}};
  if (!sums.paired) return out;
  out.error_db = sums.error_db();
  out.residual_db = sums.residual_db(gain);
  out.coherence = sums.coherence();
  return out;
}

void compare_whole(Comparison& comparison, const BandSums& whole) {
  comparison.a_rms = std::sqrt(whole.aa);
  comparison.b_rms = std::sqrt(whole.bb);
  comparison.power_level_db = schema::power_db(whole.bb / whole.aa);
  if (!whole.paired) return;
  comparison.gain = whole.gain();
  comparison.error_db = whole.error_db();
  comparison.residual_db = whole.residual_db(*comparison.gain);
  comparison.coherence = whole.coherence();
  comparison.point_by_point = *comparison.coherence > comparison.chance_coherence;
}

void compare_bands(Comparison& comparison, const SegmentSpectra& spectra,
                   const std::vector<schema::ThirdOctaveBand>& bands) {
  BandPowers powers{bands.size(), comparison.pair.paired, {}, {}};
  for (const auto& band : bands) {
    const double low = std::max(band.low_per_m, comparison.low_per_m);
    const double high = std::min(band.high_per_m, comparison.high_per_m);
    const BandSums sums = band_sums(comparison.spectra, low, high);
    comparison.bands.push_back(compared_band(band, sums, comparison.gain.value_or(0)));
    add_band(powers, spectra, low, high);
  }
  by_segment(powers);
  comparison.evidence = evidence_of(powers, comparison.tolerance_db);
  double squares = 0;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    comparison.bands[i].level_db = comparison.evidence.band_db[i];
    comparison.bands[i].scatter_db = comparison.evidence.scatter_db[i];
    squares += std::pow(comparison.bands[i].level_db, 2);
  }
  comparison.spectral_distance_db = std::sqrt(squares / static_cast<double>(bands.size()));
}

// Bins near half the grid's frequency are almost real; their variance is twice as large.
void compare_narrow(Comparison& comparison, const SegmentSpectra& spectra, std::size_t window) {
  const TexturePair& pair = comparison.pair;
  const double high = std::min(comparison.high_per_m, 0.5 / pair.pitch_m - kHannBandwidth * spectra.step);
  comparison.evidence.narrow = strongest_band(spectra, comparison.low_per_m, high, comparison.tolerance_db);
  comparison.evidence.line =
      strongest_line(pair.a, pair.b, pair.pitch_m, comparison.low_per_m, high, static_cast<double>(window));
}

Result<void> compare_spectra(Comparison& comparison, std::size_t window) {
  const TexturePair& pair = comparison.pair;
  const SegmentSpectra spectra = segment_spectra(pair.a, pair.b, pair.paired, pair.pitch_m, window,
                                                 comparison.low_per_m, comparison.high_per_m);
  comparison.spectra = mean_of(spectra);
  comparison.chance_coherence =
      chance_coherence(independent_segments(std::min(spectra.segments_a, spectra.segments_b)));
  const BandSums whole = band_sums(comparison.spectra, comparison.low_per_m, comparison.high_per_m);
  if (!(whole.aa > 0 && whole.bb > 0))
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("is zero from {} to {}", for_people(comparison.low_per_m, Dimension::spatial_frequency),
                    for_people(comparison.high_per_m, Dimension::spatial_frequency)),
        whole.aa > 0 ? "B" : "A", "a texture that is zero in the band can't be compared");
  compare_whole(comparison, whole);
  compare_bands(comparison, spectra, spatial::third_octaves(comparison.low_per_m, comparison.high_per_m));
  compare_narrow(comparison, spectra, window);
  return {};
}

Result<std::vector<schema::Formant>> formants_in(const std::vector<double>& values,
                                                 const Comparison& comparison, const CompareOptions& options,
                                                 const std::function<void(double)>& progress) {
  schema::Texture texture;
  texture.signal = {comparison.pair.pitch_m, 0, values};
  texture.quantity = comparison.pair.quantity;
  texture.unit = comparison.pair.unit;
  texture.valid_band = {{0, comparison.pair.low_per_m, comparison.pair.high_per_m}};
  const auto spectrogram = spatial::spatial_spectrogram(texture, options.spectrogram, progress);
  TACTO_TRY(spectrogram);
  return spatial::find_formants(*spectrogram, options.formant);
}

// Goes through A's formants, strongest first, and matches each with the nearest unmatched frequency in B
// within half the resolution (1.7268 / window, as for linking ridges). If `by_place`, their extents must
// also overlap by half of the shorter one. Both lists use one position axis.
FormantMatch match_formants(std::span<const schema::Formant> a, std::span<const schema::Formant> b,
                            double resolution_per_m, bool by_place) {
  FormantMatch match;
  std::vector<bool> taken(b.size(), false);
  for (std::size_t i = 0; i < a.size(); ++i) {
    double nearest = resolution_per_m / 2;
    std::size_t found = b.size();
    for (std::size_t j = 0; j < b.size(); ++j) {
      const double apart = std::abs(b[j].frequency_per_m - a[i].frequency_per_m);
      if (taken[j] || apart > nearest || (by_place && !share_places(a[i], b[j]))) continue;
      nearest = apart;
      found = j;
    }
    if (found == b.size()) {
      match.missed.push_back(i);
      continue;
    }
    taken[found] = true;
    match.matched.emplace_back(i, found);
  }
  for (std::size_t j = 0; j < b.size(); ++j)
    if (!taken[j]) match.extra.push_back(j);
  return match;
}

void compare_formants(Comparison& comparison, const CompareOptions& options,
                      const std::function<void(double)>& progress) {
  if (!options.formants) return;
  auto of_a = formants_in(comparison.pair.a, comparison, options, playback::part_of(progress, 0, 0.5));
  auto of_b = formants_in(comparison.pair.b, comparison, options, playback::part_of(progress, 0.5, 1));
  if (!of_a || !of_b) {
    comparison.notes.push_back("formants are not compared: " +
                               schema::message(of_a ? of_b.error() : of_a.error()));
    return;
  }
  constexpr double kBlackmanResolution = 1.7268;  // as in spatial/features/formants.cpp for linking points
  comparison.a_formants = std::move(*of_a);
  comparison.b_formants = std::move(*of_b);
  comparison.formant_resolution_per_m = kBlackmanResolution / options.spectrogram.window_m;
  comparison.formants = match_formants(comparison.a_formants, comparison.b_formants,
                                       comparison.formant_resolution_per_m, comparison.pair.paired);
}

// A small shift hardly changes the coherence, but it changes the gain: half a wave makes the gain negative
// and leaves little of B explained.
void note_likeness(Comparison& comparison) {
  if (!comparison.point_by_point || *comparison.coherence < kLeastCoherence) return;
  const double correlation = *comparison.gain * comparison.a_rms / comparison.b_rms;
  if (correlation < -kAgreeing)
    comparison.notes.emplace_back("B is A with inverted sign: the gain is negative");
  else if (correlation < kAgreeing * std::sqrt(*comparison.coherence))
    comparison.notes.emplace_back("B is like A, but shifted: --align correlation finds the shift");
}

// A level of a thousand or a thousandth with the same shape: one of the two probably has another unit.
void note_units(Comparison& comparison) {
  const Evidence& e = comparison.evidence;
  if (std::abs(std::abs(e.level_db) - kThousandDb) > kNearThousandDb ||
      e.shape_excess_db > comparison.tolerance_db)
    return;
  comparison.notes.push_back(
      fmt::format("B is {} times A with the same shape: if a unit is wrong (mN for N, um for mm), import "
                  "that one again with its unit",
                  e.level_db > 0 ? "a thousand" : "a thousandth"));
}

// Uses the part of each at steady speed (spatial::steady_part; elsewhere the valid bands change from place
// to place). The finer texture is low-passed to 0.4 cycles per sample of the coarser grid (0.35 if the ratio
// is not an integer) and resampled by windowed sinc (error below 1e-5 of a tone). The same interpolation
// moves B onto A's places. Errors: unsuitable: different quantities or units, no common band, fewer than 64
// samples of either; usage: a shift that is not finite.
Result<TexturePair> pair_textures(const Texture& a, const Texture& b, const PairOptions& options) {
  TACTO_TRY(check_alike(a, b));
  if (!(options.max_shift_m >= 0 && std::isfinite(options.max_shift_m)))
    return schema::fail(ErrorKind::usage, "the largest shift has to be a length", "max-shift");
  if (a.signal.values.empty() || b.signal.values.empty())
    return schema::fail(ErrorKind::unsuitable, "has no samples", a.signal.values.empty() ? "A" : "B");
  Side left = side_of(a), right = side_of(b);
  TexturePair pair;
  pair.quantity = a.quantity;
  pair.unit = a.unit;
  onto_one_grid(left, right, pair);
  pair.low_per_m = std::max(left.band.low_per_m, right.band.low_per_m);
  pair.high_per_m = std::min(left.band.high_per_m, right.band.high_per_m);
  pair_places(left, right, options, pair);
  TACTO_TRY(check_pair(pair));
  return pair;
}

}  // namespace

Result<Comparison> compare(const schema::Texture& a, const schema::Texture& b, const CompareOptions& options,
                           const std::function<void(double)>& progress) {
  if (!(options.tolerance_db > 0 && std::isfinite(options.tolerance_db)))
    return schema::fail(ErrorKind::usage, "the tolerance has to be above 0 dB", "tolerance");
  auto pair = pair_textures(a, b, options.pair);
  TACTO_TRY(pair);
  const auto window = compare_window(*pair, options);
  TACTO_TRY(window);
  Comparison comparison;
  comparison.pair = std::move(*pair);
  comparison.notes = comparison.pair.notes;
  comparison.window_m = static_cast<double>(*window) * comparison.pair.pitch_m;
  comparison.tolerance_db = options.tolerance_db;
  comparison.simulated = {a.simulated, b.simulated};
  if (auto warning = comparison.simulated.warning(); !warning.empty())
    comparison.notes.push_back(std::move(warning));
  TACTO_TRY(set_band(comparison));
  TACTO_TRY(compare_spectra(comparison, *window));
  comparison.verdict = verdict_of(comparison.evidence, comparison.tolerance_db);
  compare_formants(comparison, options, progress);
  note_likeness(comparison);
  note_units(comparison);
  return comparison;
}

}  // namespace tacto::analysis
