// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/texture_pair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "data-schema/base/quantity.hpp"
#include "spatial/dsp/resample/low_pass.hpp"
#include "spatial/dsp/resample/thinned.hpp"
#include "spatial/dsp/resample/windowed_sinc.hpp"
#include "spatial/features/steady_part.hpp"
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

}  // namespace

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

}  // namespace tacto::analysis
