// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/compare/band_sums.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/base/quantity.hpp"
#include "playback/session/session_rows.hpp"
#include "spatial/features/third_octaves.hpp"
#include "spatial/spectrogram/spectrogram.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;
using schema::ErrorKind;
using schema::for_people;
using schema::Result;

bool share_places(const schema::Formant& a, const schema::Formant& b) {
  const double common = std::min(a.to_m, b.to_m) - std::max(a.from_m, b.from_m);
  return common >= std::min(a.to_m - a.from_m, b.to_m - b.from_m) / 2;
}

constexpr double kShortestCompareWindow = 16;  // samples
constexpr double kHannBandwidth = 1.5;         // bins
constexpr double kLeastCoherence = 0.5;        // of two copies; two gratings with common lines have less
constexpr double kExplained = 0.5;             // smallest correlation that counts as agreement
constexpr double kThousandDb = 60, kNearThousandDb = 1;
constexpr double kParts = 8, kWavelengths = 8;

double usual_window(const TexturePair& pair) {
  const auto shorter = static_cast<double>(std::min(pair.a.size(), pair.b.size()));
  const double longest = pair.low_per_m > 0 ? kWavelengths / (pair.low_per_m * pair.pitch_m) : INFINITY;
  return std::max(kShortestCompareWindow, std::min(shorter / kParts, longest));
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
  constexpr double kBlackmanResolution = 1.7268;  // as in spatial/formants for linking points
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
  if (correlation < -kExplained)
    comparison.notes.emplace_back("B is A with inverted sign: the gain is negative");
  else if (correlation < kExplained * std::sqrt(*comparison.coherence))
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

}  // namespace

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
