// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

#include "analysis/compare/cross_spectrum.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/base/stroke_rule.hpp"
#include "spatial/dsp/fourier/fft.hpp"
#include "spatial/features/steady_part.hpp"
#include "spatial/numbers/band_at.hpp"
#include "spatial/texture/valid_band.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;
using schema::ErrorKind;
using schema::for_people;
using schema::Result;
using schema::Texture;

constexpr double kBandsPerDecade = 20;
constexpr double kOne_per_m = 1000;
constexpr double kEdgeRounding = 1e-9;
constexpr int kTapers = 4;
constexpr double kLevelFloorDb = 60;  // lower powers come from tapers and converters, not from the texture

// One-sided density at each bin, unit^2 m.
std::vector<double> sine_taper_density(std::span<const double> values, double pitch_m) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  spatial::RealFft fft(values.size());
  std::vector<double> tapered(values.size()), density(fft.bins());
  std::vector<std::complex<double>> spectrum(fft.bins());
  const double scale = 2 * pitch_m / kTapers * 2 / (n + 1);
  for (int k = 1; k <= kTapers; ++k) {
    for (std::size_t i = 0; i < values.size(); ++i)
      tapered[i] = (values[i] - mean) * std::sin(std::numbers::pi * k * static_cast<double>(i + 1) / (n + 1));
    fft.forward(tapered, spectrum);
    for (std::size_t b = 0; b < density.size(); ++b) density[b] += scale * std::norm(spectrum[b]);
  }
  return density;
}

double power_between(const std::vector<double>& density, double step, double low, double high) {
  double power = 0;
  const auto first = static_cast<std::size_t>(std::max(0.0, std::round(low / step)));
  for (std::size_t b = first; b < density.size() && (static_cast<double>(b) - 0.5) * step < high; ++b)
    power += density[b] * width_of_bin(static_cast<double>(b) * step, step, low, high);
  return power;
}

constexpr std::size_t kFewestStrokes = 5, kFewestRecordings = 4;
constexpr std::size_t kFewestForCovariates = 12;  // units of both sides
constexpr std::size_t kFewestStrokeSamples = 64;
constexpr std::size_t kFewestSixths = 6;             // an octave
constexpr double kFewestExchanges = 2 / kTestLevel;  // with all sides exchanged the statistics are the same
constexpr double kFewestSeparable = 0.25, kPoorlySeparable = 0.5;
constexpr double kNormal80 = 0.841621;  // 80 % of normal values are below

// One stroke's steady part, and what the test needs of it.
struct ComparedStroke {
  const Texture* texture = nullptr;
  std::string name;
  bool in_b = false;
  std::vector<double> values;
  double low_per_m = 0, high_per_m = 0;
  std::optional<double> log_speed, log_load;
  std::vector<double> level_db;
  double from_s = 0, to_s = 0;  // in the recording
};

// Mean log of the speed in the steady part, from its valid band; otherwise of the stroke's mean speed.
std::optional<double> log_speed_of(const Texture& steady) {
  const schema::TextureSource& source = steady.source;
  const bool by_band = source.low_hz > 0 && !source.low_per_m && !steady.valid_band.empty();
  if (!by_band)
    return source.mean_speed_mps > 0 ? std::optional(std::log(source.mean_speed_mps)) : std::nullopt;
  constexpr int kPlaces = 1000;
  double sum = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double low_per_m =
        spatial::band_at(steady.valid_band, steady.signal.length_m() * i / (kPlaces - 1)).low_per_m;
    if (!(low_per_m > 0)) return std::nullopt;
    sum += std::log(source.low_hz / low_per_m);
  }
  return sum / kPlaces;
}

Result<ComparedStroke> compared_stroke(const Texture& texture, const std::string& name, bool in_b) {
  if (texture.average)
    return schema::fail(ErrorKind::unsuitable, "is a mean of several strokes, which has no spread of strokes",
                        name, "name the recording or the textures of single strokes");
  if (texture.signal.values.empty()) return schema::fail(ErrorKind::unsuitable, "has no samples", name);
  spatial::SteadyPart part = spatial::steady_part(texture);
  ComparedStroke stroke{
      &texture,           name, in_b, {}, 0, 0.5 / texture.signal.pitch_m, {}, {}, {}, texture.source.from_s,
      texture.source.to_s};
  if (!part.texture.valid_band.empty()) {
    const schema::BandPoint band = spatial::band_throughout(part.texture.valid_band);
    stroke.low_per_m = band.low_per_m;
    stroke.high_per_m = std::min(stroke.high_per_m, band.high_per_m);
  }
  stroke.log_speed = log_speed_of(part.texture);
  if (const auto load_n = texture.source.normal_force_n; load_n && *load_n > 0)
    stroke.log_load = std::log(*load_n);
  stroke.values = std::move(part.texture.signal.values);
  if (stroke.values.size() >= kFewestStrokeSamples) return stroke;
  return schema::fail(ErrorKind::unsuitable,
                      fmt::format("has {} samples at steady speed, a spectrum needs at least {}",
                                  stroke.values.size(), kFewestStrokeSamples),
                      name, "leave it out");
}

using Strokes = std::vector<ComparedStroke>;

Result<void> add_side(Strokes& strokes, const SurfaceSide& side, bool in_b) {
  for (std::size_t i = 0; i < side.strokes.size(); ++i) {
    auto stroke = compared_stroke(side.strokes[i], side.stroke_names[i], in_b);
    TACTO_TRY(stroke);
    strokes.push_back(std::move(*stroke));
  }
  return {};
}

bool one_stretch(const schema::TextureSource& a, const schema::TextureSource& b) {
  return !a.recording_sha256.empty() && a.recording_sha256 == b.recording_sha256 && a.from_s < b.to_s &&
         b.from_s < a.to_s;
}

Result<void> check_strokes(const Strokes& strokes) {
  const Texture& first = *strokes.front().texture;
  for (auto stroke = strokes.begin(); stroke != strokes.end(); ++stroke) {
    const Texture& texture = *stroke->texture;
    const Texture& of_side = *std::ranges::find(strokes, stroke->in_b, &ComparedStroke::in_b)->texture;
    if (texture.simulated.empty() != of_side.simulated.empty())
      return schema::fail(ErrorKind::unsuitable, "one side has measured and simulated strokes", stroke->name,
                          "compare measured strokes with measured ones, simulated with simulated ones");
    if (texture.quantity != first.quantity || texture.unit != first.unit)
      return schema::fail(ErrorKind::unsuitable,
                          fmt::format("contains {} in {}, but {} contains {} in {}", texture.quantity,
                                      texture.unit, strokes.front().name, first.quantity, first.unit),
                          stroke->name, "compare textures of one quantity");
    const auto twin = std::find_if(strokes.begin(), stroke, [&](const ComparedStroke& other) {
      return one_stretch(other.texture->source, texture.source);
    });
    if (twin != stroke)
      return schema::fail(ErrorKind::usage,
                          fmt::format("is of the same section of a recording as {}", twin->name),
                          stroke->name, "name each stroke once, on one side");
  }
  return {};
}

// The bands that are valid in all strokes, but not narrower than the spectrum of the shortest one resolves.
Result<std::vector<double>> common_edges(const Strokes& strokes) {
  double low_per_m = 0, high_per_m = INFINITY;
  for (const ComparedStroke& stroke : strokes) {
    const double length_m = static_cast<double>(stroke.values.size()) * stroke.texture->signal.pitch_m;
    low_per_m = std::max({low_per_m, stroke.low_per_m, 1 / length_m});
    high_per_m = std::min(high_per_m, stroke.high_per_m);
  }
  std::vector<double> edges;
  if (low_per_m < high_per_m) edges = sixth_octave_edges(low_per_m, high_per_m);
  if (edges.size() > kFewestSixths) return edges;
  return schema::fail(
      ErrorKind::unsuitable,
      fmt::format("the strokes have less than an octave in common: one is valid from {} on, one "
                  "up to {}",
                  for_people(low_per_m, Dimension::spatial_frequency),
                  for_people(high_per_m, Dimension::spatial_frequency)),
      "A and B", "use longer strokes, or of more similar speed");
}

Result<void> add_levels(Strokes& strokes, const std::vector<double>& edges_per_m) {
  for (ComparedStroke& stroke : strokes) {
    stroke.level_db = stroke_levels_db(stroke.values, stroke.texture->signal.pitch_m, edges_per_m);
    if (stroke.level_db.empty())
      return schema::fail(ErrorKind::unsuitable, "is zero in the bands that are compared", stroke.name,
                          "leave it out");
  }
  return {};
}

// Whether one continues the other behind a gap of the recording.
bool adjoin(const ComparedStroke& a, const ComparedStroke& b) {
  const std::string& recording = a.texture->source.recording_sha256;
  return !recording.empty() && recording == b.texture->source.recording_sha256 && a.in_b == b.in_b &&
         a.texture->direction == b.texture->direction &&
         std::max(a.from_s, b.from_s) - std::min(a.to_s, b.to_s) < schema::kStrokePause_s;
}

// Means over the samples of both: of power, of log speed and log load.
void append(ComparedStroke& stroke, const ComparedStroke& next) {
  const auto n = static_cast<double>(stroke.values.size()), more = static_cast<double>(next.values.size());
  const auto mean = [&](double before, double after) { return (n * before + more * after) / (n + more); };
  for (std::size_t b = 0; b < stroke.level_db.size(); ++b)
    stroke.level_db[b] = schema::power_db(
        mean(schema::power_of_db(stroke.level_db[b]), schema::power_of_db(next.level_db[b])));
  for (const auto member : {&ComparedStroke::log_speed, &ComparedStroke::log_load})
    stroke.*member = stroke.*member && next.*member ? std::optional(mean(*(stroke.*member), *(next.*member)))
                                                    : std::nullopt;
  stroke.values.insert(stroke.values.end(), next.values.begin(), next.values.end());
  stroke.from_s = std::min(stroke.from_s, next.from_s);
  stroke.to_s = std::max(stroke.to_s, next.to_s);
}

// The pieces of a stroke between gaps are alike: only the whole stroke is a draw of the finger. Returns how
// many textures were pieces of an earlier one.
std::size_t join_pieces(Strokes& strokes) {
  Strokes whole;
  for (ComparedStroke& stroke : strokes) {
    const auto other = std::ranges::find_if(whole, [&](const auto& each) { return adjoin(each, stroke); });
    if (other == whole.end())
      whole.push_back(std::move(stroke));
    else
      append(*other, stroke);
  }
  const std::size_t pieces = strokes.size() - whole.size();
  strokes = std::move(whole);
  return pieces;
}

std::string recording_of(const ComparedStroke& stroke) {
  const std::string& sum = stroke.texture->source.recording_sha256;
  return sum.empty() ? "\n" + stroke.name : sum;  // a texture without a recording counts as one
}

std::optional<double> mean_exp(const Strokes& strokes, bool in_b,
                               std::optional<double> ComparedStroke::*logarithm) {
  double sum = 0, count = 0;
  for (const ComparedStroke& stroke : strokes) {
    if (stroke.in_b != in_b) continue;
    if (!(stroke.*logarithm)) return std::nullopt;
    sum += *(stroke.*logarithm);
    ++count;
  }
  return std::exp(sum / count);
}

SideFacts facts_of(const Strokes& strokes, const SurfaceSide& side, bool in_b) {
  SideFacts facts;
  facts.name = side.name;
  facts.speed_mps = mean_exp(strokes, in_b, &ComparedStroke::log_speed);
  facts.load_n = mean_exp(strokes, in_b, &ComparedStroke::log_load);
  std::set<std::string> recordings;
  for (const ComparedStroke& stroke : strokes) {
    if (stroke.in_b != in_b) continue;
    ++facts.strokes;
    recordings.insert(recording_of(stroke));
    if (facts.simulated.empty()) facts.simulated = stroke.texture->simulated;
    facts.level_db.resize(stroke.level_db.size());
    for (std::size_t b = 0; b < facts.level_db.size(); ++b) facts.level_db[b] += stroke.level_db[b];
  }
  facts.recordings = recordings.size();
  for (double& level : facts.level_db) level /= static_cast<double>(facts.strokes);
  return facts;
}

// Whether every stroke has this member, and each of its values is on both sides.
bool on_both_sides(const Strokes& strokes, std::string Texture::*member) {
  std::set<std::string> a, b;
  for (const ComparedStroke& stroke : strokes) (stroke.in_b ? b : a).insert(stroke.texture->*member);
  return a == b && !a.contains("");
}

// Equal numbers for strokes of one subject and finger, where both sides have the same ones, and, if `by_way`,
// of one direction.
std::vector<int> strata_of_strokes(const Strokes& strokes, bool by_way) {
  const bool subject = on_both_sides(strokes, &Texture::subject);
  const bool finger = on_both_sides(strokes, &Texture::finger);
  std::map<std::array<std::string, 3>, int> numbers;
  std::vector<int> strata;
  for (const ComparedStroke& stroke : strokes) {
    const Texture& t = *stroke.texture;
    const std::array<std::string, 3> key{by_way && t.direction < 0 ? "back" : "", subject ? t.subject : "",
                                         finger ? t.finger : ""};
    strata.push_back(numbers.emplace(key, static_cast<int>(numbers.size())).first->second);
  }
  return strata;
}

bool all_have(const Strokes& strokes, std::optional<double> ComparedStroke::*member) {
  return std::ranges::all_of(strokes, [&](const ComparedStroke& s) { return (s.*member).has_value(); });
}

// Speed and load, where all strokes have them.
constexpr std::array<std::optional<double> ComparedStroke::*, 2> kCovariates = {&ComparedStroke::log_speed,
                                                                                &ComparedStroke::log_load};

LabelledLevels by_stroke(const Strokes& strokes) {
  LabelledLevels data;
  data.bands = strokes.front().level_db.size();
  data.stratum = strata_of_strokes(strokes, true);
  for (const ComparedStroke& stroke : strokes) {
    data.in_b.push_back(stroke.in_b);
    data.level_db.insert(data.level_db.end(), stroke.level_db.begin(), stroke.level_db.end());
  }
  for (const auto member : kCovariates) {
    if (!all_have(strokes, member)) continue;
    std::vector<double>& column = data.covariates.emplace_back();
    for (const ComparedStroke& stroke : strokes) column.push_back(*(stroke.*member));
  }
  return data;
}

// Subtracts from each value the mean of its stratum.
void centre(std::vector<double>& values, std::size_t columns, const std::vector<int>& stratum) {
  for (std::size_t column = 0; column < columns; ++column) {
    std::map<int, std::pair<double, double>> sums;
    for (std::size_t i = 0; i < stratum.size(); ++i) {
      sums[stratum[i]].first += values[i * columns + column];
      sums[stratum[i]].second += 1;
    }
    for (std::size_t i = 0; i < stratum.size(); ++i)
      values[i * columns + column] -= sums[stratum[i]].first / sums[stratum[i]].second;
  }
}

// Rows with one number become their mean.
std::vector<double> mean_rows(const std::vector<double>& values, std::size_t columns,
                              const std::vector<std::size_t>& number, std::size_t rows) {
  std::vector<double> sums(rows * columns), counts(rows);
  for (std::size_t i = 0; i < number.size(); ++i) {
    ++counts[number[i]];
    for (std::size_t c = 0; c < columns; ++c) sums[number[i] * columns + c] += values[i * columns + c];
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= counts[i / columns];
  return sums;
}

// Means of recordings, of levels less the mean of their direction.
LabelledLevels by_recording(const Strokes& strokes) {
  LabelledLevels data = by_stroke(strokes);
  std::vector<int> ways;
  for (const ComparedStroke& stroke : strokes) ways.push_back(stroke.texture->direction);
  const std::vector<int> strata = strata_of_strokes(strokes, false);
  std::map<std::pair<bool, std::string>, std::size_t> numbers;
  std::vector<std::size_t> number;
  LabelledLevels means;
  means.bands = data.bands;
  for (const ComparedStroke& stroke : strokes) {
    const auto [place, added] = numbers.emplace(std::pair(stroke.in_b, recording_of(stroke)), numbers.size());
    if (added) {
      means.in_b.push_back(stroke.in_b);
      means.stratum.push_back(strata[number.size()]);
    }
    number.push_back(place->second);
  }
  centre(data.level_db, data.bands, ways);
  means.level_db = mean_rows(data.level_db, data.bands, number, means.strokes());
  for (std::vector<double>& covariate : data.covariates) {
    centre(covariate, 1, ways);
    means.covariates.push_back(mean_rows(covariate, 1, number, means.strokes()));
  }
  return means;
}

// "speed 50 mm/s against 60 mm/s": the one of both that explains more of the side.
std::string hiding_words(const SurfaceComparison& c, const LabelledLevels& data, const Strokes& strokes) {
  std::string words;
  double least = 2;
  auto covariate = data.covariates.begin();
  for (const auto member : kCovariates) {
    if (!all_have(strokes, member)) continue;
    LabelledLevels one = data;
    one.covariates = {*covariate++};
    const double part = separable_part(one);
    if (part >= least) continue;
    least = part;
    const bool speed = member == &ComparedStroke::log_speed;
    const auto shown = [&](const SideFacts& side) {
      return for_people(speed ? *side.speed_mps : *side.load_n, speed ? Dimension::speed : Dimension::force);
    };
    words = fmt::format("{} {} against {}", speed ? "speed" : "load", shown(c.a), shown(c.b));
  }
  return words;
}

std::size_t count_of(const std::vector<bool>& in_b, bool side) {
  return static_cast<std::size_t>(std::ranges::count(in_b, side));
}

// Why the data cannot decide; empty if they can.
std::string too_little(const SurfaceComparison& c, const LabelledLevels& data, const Strokes& strokes) {
  if (!c.by_recording && std::min(c.units_a, c.units_b) < kFewestStrokes)
    return fmt::format("{} + {} strokes are too few: at least {} a side are needed", c.units_a, c.units_b,
                       kFewestStrokes);
  if (const double ways = exchanges(data); ways < kFewestExchanges)
    return fmt::format(
        "A and B have too few strokes in the same direction, of the same subject and finger: {:g} "
        "exchanges of A and B are possible, at least {:g} are needed",
        ways, kFewestExchanges);
  if (c.separable < kFewestSeparable)
    return fmt::format("{} hides the surface: it explains {:.0f} % of the difference between the sides",
                       hiding_words(c, data, strokes), 100 * (1 - c.separable));
  return "";
}

// The smallest difference that is found in 8 of 10 comparisons, at the place of the largest scatter, over
// windows of so many bands.
double finest_db(const LabelTest& test, std::size_t bands, double tolerance_db) {
  double error_db = 0;
  for (const BandWindow& window : test.windows)
    if (window.bands == bands) error_db = std::max(error_db, window.error_db);
  return std::max(test.reach * error_db, tolerance_db) + kNormal80 * error_db;
}

std::string strongest_words(const SurfaceComparison& c) {
  const BandWindow& window = c.test->windows[c.test->strongest];
  const double reach_db = c.test->reach * window.error_db;
  return fmt::format("from {} to {} B is {:.1f} dB {} A (simultaneous 95 % interval {:+.1f} to {:+.1f} dB)",
                     for_people(c.low_per_m(window), Dimension::spatial_frequency),
                     for_people(c.high_per_m(window), Dimension::spatial_frequency),
                     std::abs(window.level_db), window.level_db > 0 ? "above" : "below",
                     window.level_db - reach_db, window.level_db + reach_db);
}

void judge(SurfaceComparison& c) {
  const LabelTest& test = *c.test;
  c.finest_third_octave_db = finest_db(test, 2, c.tolerance_db);
  c.finest_level_db = finest_db(test, test.windows.back().bands, c.tolerance_db);
  const bool by_chance = test.p > kTestLevel;
  const bool small = std::abs(test.windows[test.strongest].level_db) < c.tolerance_db;
  c.verdict = by_chance || small ? SurfaceVerdict::no_difference_found : SurfaceVerdict::different;
  c.because = strongest_words(c);
  if (const BandWindow& window = test.windows[test.strongest];
      !by_chance && std::abs(window.level_db) <= test.reach * window.error_db)
    c.because = fmt::format(
        "the spectra differ in shape (p {:.3f}, all bands together), but no band by itself: the strongest "
        "difference has an interval that contains 0 dB: {}",
        test.shape_p, c.because);
  if (by_chance) c.because = "the largest difference is within the spread of the strokes: " + c.because;
  if (!by_chance && small) c.because += fmt::format(", below the tolerance of {:g} dB", c.tolerance_db);
}

// A side that speed or load explains in part: the null model removes what is proportional to their
// logarithms.
void note_conditions(SurfaceComparison& c, const LabelledLevels& data, const Strokes& strokes) {
  if (c.separable >= kPoorlySeparable) return;
  c.notes.push_back(
      fmt::format("{} explains {:.0f} % of the difference between the sides: a difference may be caused by "
                  "it; record both "
                  "sides alike",
                  hiding_words(c, data, strokes), 100 * (1 - c.separable)));
}

}  // namespace

std::vector<double> sixth_octave_edges(double low_per_m, double high_per_m) {
  const auto number = [](double per_m) { return kBandsPerDecade * std::log10(per_m / kOne_per_m); };
  std::vector<double> edges;
  const double last = std::floor(number(high_per_m) + kEdgeRounding);
  for (double x = std::ceil(number(low_per_m) - kEdgeRounding); x <= last; ++x)
    edges.push_back(kOne_per_m * std::pow(10, x / kBandsPerDecade));
  if (edges.size() < 2) edges.clear();
  return edges;
}

std::vector<double> stroke_levels_db(std::span<const double> values, double pitch_m,
                                     std::span<const double> edges_per_m) {
  const std::vector<double> density = sine_taper_density(values, pitch_m);
  const double step = 1 / (static_cast<double>(values.size()) * pitch_m);
  std::vector<double> levels;
  for (std::size_t i = 0; i + 1 < edges_per_m.size(); ++i)
    levels.push_back(power_between(density, step, edges_per_m[i], edges_per_m[i + 1]));
  const double most = *std::ranges::max_element(levels);
  if (!(most > 0)) return {};
  const double least = most * schema::power_of_db(-kLevelFloorDb);
  for (double& level : levels) level = schema::power_db(std::max(level, least));
  return levels;
}

std::string_view to_string(SurfaceVerdict verdict) {
  constexpr std::array<std::string_view, 3> kWords = {"different", "no difference found", "undecided"};
  return kWords[static_cast<std::size_t>(verdict)];
}

Result<SurfaceComparison> compare_surfaces(const SurfaceSide& a, const SurfaceSide& b, double tolerance_db) {
  if (!(tolerance_db > 0 && std::isfinite(tolerance_db)))
    return schema::fail(ErrorKind::usage, "the tolerance has to be above 0 dB", "tolerance");
  Strokes strokes;
  TACTO_TRY(add_side(strokes, a, false));
  TACTO_TRY(add_side(strokes, b, true));
  TACTO_TRY(check_strokes(strokes));
  const auto edges = common_edges(strokes);
  TACTO_TRY(edges);
  TACTO_TRY(add_levels(strokes, *edges));
  SurfaceComparison c;
  if (const std::size_t pieces = join_pieces(strokes); pieces > 0)
    c.notes.push_back(
        fmt::format("{} textures continue an earlier one behind a gap of less than {:g} s: they count as one "
                    "stroke with it",
                    pieces, schema::kStrokePause_s));
  c.tolerance_db = tolerance_db;
  c.edges_per_m = *edges;
  c.unit = strokes.front().texture->unit;
  c.a = facts_of(strokes, a, false);
  c.b = facts_of(strokes, b, true);
  if (auto warning = c.simulated().warning(); !warning.empty()) c.notes.push_back(std::move(warning));
  c.by_recording = std::min(c.a.recordings, c.b.recordings) >= kFewestRecordings;
  LabelledLevels data = c.by_recording ? by_recording(strokes) : by_stroke(strokes);
  c.units_a = count_of(data.in_b, false);
  c.units_b = count_of(data.in_b, true);
  c.separable = separable_part(data);
  c.because = too_little(c, data, strokes);
  if (!c.because.empty()) return c;
  note_conditions(c, data, strokes);
  if (data.strokes() < kFewestForCovariates) data.covariates.clear();
  c.test = label_test(data);
  judge(c);
  return c;
}

}  // namespace tacto::analysis
