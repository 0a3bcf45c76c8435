// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <span>

#include "data-schema/base/decibels.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/base/statistics.hpp"

namespace tacto::analysis {
namespace {

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
