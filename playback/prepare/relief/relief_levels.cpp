// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/relief/relief_levels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "data-schema/base/raised_cosine.hpp"
#include "firmware-host/core/scene/relief.hpp"
#include "firmware-host/core/scene/scene_block.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::playback {
namespace {

using spatial::GridSize;

// (c[i-1] + 4 c[i] + c[i+1]) / 6 = h[i], with c[-1] = c[0] and c[n] = c[n-1]: elimination forwards, then
// backwards.
class SplineSystem {
 public:
  explicit SplineSystem(std::size_t size) : above_(size) {
    for (std::size_t i = 0; i < size; ++i) above_[i] = 1 / (diagonal(i) - (i > 0 ? above_[i - 1] : 0));
  }

  void solve(double* values, std::size_t stride) const {
    const std::size_t n = above_.size();
    double before = 0;
    for (std::size_t i = 0; i < n; ++i)
      before = values[i * stride] = (6 * values[i * stride] - before) * above_[i];
    for (std::size_t i = n - 1; i > 0; --i) values[(i - 1) * stride] -= above_[i - 1] * values[i * stride];
  }

 private:
  double diagonal(std::size_t i) const { return 4 + (i == 0 ? 1 : 0) + (i + 1 == above_.size() ? 1 : 0); }

  std::vector<double> above_;  // of the eliminated rows: 1 over the diagonal
};

constexpr double kLeastPower = 1e-6;  // -60 dB; cubic splines of 12 samples a period have images of -61 dB
constexpr double kSamplesPerPeriod = 12, kPassed = 0.8;  // of a level's highest frequency
constexpr std::size_t kEnoughCoefficients = std::size_t{1} << 23, kMostCoefficients = std::size_t{1} << 29;

std::vector<double> above_mean(std::vector<double> heights) {
  double sum = 0;
  for (const double height : heights) sum += height;
  for (double& height : heights) height -= sum / static_cast<double>(heights.size());
  return heights;
}

// Of a cosine of the grid, in cycles per sample.
double frequency_of(std::size_t k, std::size_t l, GridSize size) {
  return std::hypot(0.5 * static_cast<double>(k) / static_cast<double>(size.columns),
                    0.5 * static_cast<double>(l) / static_cast<double>(size.rows));
}

// sin^4 falls so smoothly to the edges that the tilt of a map does not seem to have high frequencies.
double taper(std::size_t i, std::size_t count) {
  if (count == 1) return 1;
  const double s = std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count));
  return s * s * s * s;
}

// In cycles per sample.
double highest_frequency(std::vector<double> heights, GridSize size) {
  constexpr std::size_t kBins = 4096;
  for (std::size_t j = 0; j < size.rows; ++j)
    for (std::size_t i = 0; i < size.columns; ++i)
      heights[j * size.columns + i] *= taper(i, size.columns) * taper(j, size.rows);
  to_cosines(heights, size);
  std::vector<double> power(kBins);
  double all = 0;
  for (std::size_t at = 0; at < heights.size(); ++at) {
    const double frequency = frequency_of(at % size.columns, at / size.columns, size);
    // Cosines along one axis alone count double here, which does not matter.
    const double of_slope = heights[at] * heights[at] * frequency * frequency;
    power[std::min(static_cast<std::size_t>(frequency * std::numbers::sqrt2 * kBins), kBins - 1)] += of_slope;
    all += of_slope;
  }
  double above = 0;
  std::size_t bins = kBins;
  for (; bins > 0; --bins) {
    above += power[bins - 1];
    if (above > kLeastPower * all) break;
  }
  return static_cast<double>(bins) / kBins / std::numbers::sqrt2;
}

// Along one axis; at most `finer` times those of the map.
std::size_t places_needed(std::size_t places, double highest, double finer) {
  if (places == 1) return 1;
  const double density = std::min(kSamplesPerPeriod * highest, finer);
  return static_cast<std::size_t>(std::ceil(static_cast<double>(places) * density));
}

struct LevelPlan {
  GridSize size;
  double highest = 0;  // cycles per sample of the map
};

// The levels after the first.
std::vector<LevelPlan> planned_levels(GridSize map, double highest, double fastest_by_whole, double finer) {
  const double lowest = 0.5 / static_cast<double>(std::max(map.columns, map.rows));  // of the cosines
  std::vector<LevelPlan> plans;
  for (unsigned n = 1; n < core::kMostReliefLevels && highest > 0; ++n) {
    const double of_level = highest * std::exp2(-0.5 * n);
    if (of_level < lowest || std::exp2(0.5 * (n - 1)) >= fastest_by_whole) break;
    plans.push_back(
        {{places_needed(map.columns, of_level, finer), places_needed(map.rows, of_level, finer)}, of_level});
  }
  return plans;
}

std::size_t coefficients_of(const std::vector<LevelPlan>& plans) {
  std::size_t sum = 0;
  for (const LevelPlan& plan : plans) sum += plan.size.columns * plan.size.rows;
  return sum;
}

double passed(double part) {
  return schema::falling_cosine(std::numbers::pi * std::clamp((part - kPassed) / (1 - kPassed), 0.0, 1.0));
}

// Of the B-spline in the middle of its three coefficients, for cosine k.
double spline_response(std::size_t k, std::size_t places) {
  return (2 + std::cos(std::numbers::pi * static_cast<double>(k) / static_cast<double>(places))) / 3;
}

// Of the map, whose cosines are given.
ReliefLevel level_of(const std::vector<double>& cosines, GridSize map, const LevelPlan& plan) {
  const GridSize size = plan.size;
  std::vector<double> level(size.columns * size.rows);
  const double scale = static_cast<double>(level.size()) / static_cast<double>(cosines.size());
  for (std::size_t l = 0; l < std::min(size.rows, map.rows); ++l)
    for (std::size_t k = 0; k < std::min(size.columns, map.columns); ++k)
      level[l * size.columns + k] = scale * passed(frequency_of(k, l, map) / plan.highest) *
                                    cosines[l * map.columns + k] /
                                    (spline_response(k, size.columns) * spline_response(l, size.rows));
  from_cosines(level, size);
  return {size.columns, size.rows, {level.begin(), level.end()}};
}

// Weights of the four coefficients around a place at the beginning of a cell, and in its middle.
struct Weights {
  double at, value[4], slope[4], curvature[4];
};
constexpr Weights kAtKnot = {0, {1.0 / 6, 4.0 / 6, 1.0 / 6, 0}, {-0.5, 0, 0.5, 0}, {1, -2, 1, 0}};
constexpr Weights kBetween = {
    0.5, {1.0 / 48, 23.0 / 48, 23.0 / 48, 1.0 / 48}, {-0.125, -0.625, 0.625, 0.125}, {0.5, -0.5, -0.5, 0.5}};

double weighted(const double (&weights)[4], const std::vector<double>& values, std::size_t i) {
  const std::size_t last = values.size() - 1;
  return weights[0] * values[i > 0 ? i - 1 : 0] + weights[1] * values[i] +
         weights[2] * values[std::min(i + 1, last)] + weights[3] * values[std::min(i + 2, last)];
}

// Sums along y of the first level, beside a row.
struct RowSums {
  std::vector<double> value, slope, curvature;

  RowSums(const Relief& relief, std::size_t row, const Weights& y) {
    for (std::vector<double>* sums : {&value, &slope, &curvature}) sums->resize(relief.columns);
    for (std::size_t i = 0; i < relief.columns; ++i)
      for (std::size_t m = 0; m < 4; ++m) {
        const std::size_t from = std::min(row + m > 0 ? row + m - 1 : 0, relief.rows - 1);
        const double c = double{relief.levels.front().coefficients[from * relief.columns + i]};
        value[i] += y.value[m] * c, slope[i] += y.slope[m] * c, curvature[i] += y.curvature[m] * c;
      }
  }
};

// The rows, or columns, of a map in a patch of this length, and the places halfway between them.
void each_place(const Relief& relief, int axis, double length_m, const auto& visit) {
  const std::size_t count = axis == 0 ? relief.columns : relief.rows;
  for (std::size_t i = 0; i < count; ++i)
    for (const Weights& weights : {kAtKnot, kBetween}) {
      const double from_centre = static_cast<double>(i) + weights.at - 0.5 * static_cast<double>(count - 1);
      if (std::abs(from_centre + relief.centre_m[axis] / relief.pitch_m) <=
          0.5 * length_m / relief.pitch_m + 0.5)
        visit(i, weights);
    }
}

// The largest eigenvalue, absolute, of a symmetric matrix.
double largest_eigenvalue(double xx, double xy, double yy) {
  return std::abs(0.5 * (xx + yy)) + std::hypot(0.5 * (xx - yy), xy);
}

// Heights with a mean of 0. `highest` in cycles per sample.
schema::Result<Relief> levels_of(std::vector<double> heights, GridSize whole, double highest, double pitch_m,
                                 double rate_hz, double fastest_mps, const std::string& where) {
  Relief relief{whole.columns, whole.rows, pitch_m, highest / pitch_m, 0};
  relief.levels.push_back(
      {whole.columns, whole.rows, relief_coefficients(heights, whole.columns, whole.rows)});
  const double fastest = fastest_mps / relief.whole_to_mps(rate_hz);
  double finer = std::max(1.0, kSamplesPerPeriod * highest);
  std::vector<LevelPlan> plans = planned_levels(whole, highest, fastest, finer);
  while (finer > 1 && heights.size() + coefficients_of(plans) > kEnoughCoefficients) {
    finer = std::max(1.0, finer / std::numbers::sqrt2);
    plans = planned_levels(whole, highest, fastest, finer);
  }
  if (const std::size_t all = heights.size() + coefficients_of(plans); all > kMostCoefficients)
    return schema::fail(
        schema::ErrorKind::unsuitable,
        fmt::format("it has {} coefficients in {} levels", all, plans.size() + 1), where,
        fmt::format("give it a pitch {:.2g} times as large",
                    std::sqrt(static_cast<double>(all) / static_cast<double>(kMostCoefficients))));
  if (plans.empty()) return relief;
  relief.samples_per_period = std::min(kSamplesPerPeriod, finer / plans.front().highest);
  to_cosines(heights, whole);
  for (const LevelPlan& plan : plans) relief.levels.push_back(level_of(heights, whole, plan));
  return relief;
}

// Between columns i and i + 1 of the map is sample i of the texture. There the slope of the cubic B-spline is
// (d[i-1] + 6 d[i] + d[i+1]) / 8 with the differences d of its coefficients, of which those beyond the ends
// are 0: a quadratic B-spline in d.
std::vector<double> heights_with_slope(const std::vector<double>& slope, double pitch_m) {
  const std::size_t n = slope.size();
  std::vector<double> above(n), d(n);
  for (std::size_t i = 0; i < n; ++i) {
    above[i] = 1 / (6 - (i > 0 ? above[i - 1] : 0));
    d[i] = (8 * pitch_m * slope[i] - (i > 0 ? d[i - 1] : 0)) * above[i];
  }
  for (std::size_t i = n - 1; i > 0; --i) d[i - 1] -= above[i - 1] * d[i];
  std::vector<double> heights(n + 1);
  double coefficient = 0;
  for (std::size_t i = 0; i <= n; ++i) {
    const double before = i > 0 ? d[i - 1] : 0, after = i < n ? d[i] : 0;
    coefficient += before;
    heights[i] = coefficient + (after - before) / 6;
  }
  return heights;
}

}  // namespace

std::vector<float> relief_coefficients(std::span<const double> heights, std::size_t columns,
                                       std::size_t rows) {
  assert(columns > 0 && rows > 0 && heights.size() == columns * rows);
  std::vector<double> c(heights.begin(), heights.end());
  const SplineSystem along_x(columns), along_y(rows);
  for (std::size_t row = 0; row < rows; ++row) along_x.solve(c.data() + row * columns, 1);
  for (std::size_t column = 0; column < columns; ++column) along_y.solve(c.data() + column, columns);
  return {c.begin(), c.end()};
}

// At the samples and halfway between them.
double Relief::curvature_per_m(double width_m, double height_m) const {
  double largest = 0;
  each_place(*this, 1, height_m, [&](std::size_t j, const Weights& y) {
    const RowSums row(*this, j, y);
    each_place(*this, 0, width_m, [&](std::size_t i, const Weights& x) {
      largest = std::max(
          largest, largest_eigenvalue(weighted(x.curvature, row.value, i), weighted(x.slope, row.slope, i),
                                      weighted(x.value, row.curvature, i)));
    });
  });
  return largest / (pitch_m * pitch_m);
}

double Relief::largest_slope() const {
  double largest = 0;
  each_place(*this, 1, INFINITY, [&](std::size_t j, const Weights& y) {
    const RowSums row(*this, j, y);
    each_place(*this, 0, INFINITY, [&](std::size_t i, const Weights& x) {
      largest =
          std::max(largest, std::hypot(weighted(x.slope, row.value, i), weighted(x.value, row.slope, i)));
    });
  });
  return largest / pitch_m;
}

ForceSlopes ForceRelief::slopes(double width_m, double height_m) const {
  double least = 0, most = 0, curl = 0, coefficient = 0;
  each_place(x, 1, height_m, [&](std::size_t j, const Weights& v) {
    const RowSums of_x(x, j, v), of_y(y, j, v);
    each_place(x, 0, width_m, [&](std::size_t i, const Weights& u) {
      const double x_by_u = weighted(u.slope, of_x.value, i), x_by_v = weighted(u.value, of_x.slope, i),
                   y_by_u = weighted(u.slope, of_y.value, i), y_by_v = weighted(u.value, of_y.slope, i);
      const double mean = 0.5 * (x_by_u + y_by_v),
                   apart = std::hypot(0.5 * (x_by_u - y_by_v), 0.5 * (x_by_v + y_by_u));
      least = std::min(least, mean - apart);
      most = std::max(most, mean + apart);
      curl = std::max(curl, std::abs(y_by_u - x_by_v));
    });
  });
  for (const Relief* component : {&x, &y})
    for (const float c : component->levels.front().coefficients)
      coefficient = std::max(coefficient, std::abs(double{c}));
  constexpr double kSlopeRounding = 0x1p-22;  // of two differences of coefficients in single precision
  const auto known = [&](double slope) {
    return slope > kSlopeRounding * coefficient ? slope / x.pitch_m : 0;
  };
  return {known(-least), known(most), known(curl)};
}

double Relief::whole_to_mps(double rate_hz) const {
  return double{core::kWholeReliefPerTick} * rate_hz / highest_per_m;
}

double Relief::zero_from_mps(double rate_hz) const {
  return whole_to_mps(rate_hz) * std::exp2(0.5 * static_cast<double>(levels.size()));
}

schema::Result<Relief> relief_levels(const schema::HeightMap& map, double rate_hz, double fastest_mps,
                                     const std::string& where) {
  const GridSize size{map.columns, map.rows};
  const auto heights = above_mean({map.height_m.begin(), map.height_m.end()});
  return levels_of(heights, size, highest_frequency(heights, size), map.pitch_m, rate_hz, fastest_mps, where);
}

Relief surface_relief(const schema::HeightMap& map) {
  const GridSize size{map.columns, map.rows};
  const std::vector<double> heights(map.height_m.begin(), map.height_m.end());
  Relief relief{map.columns, map.rows, map.pitch_m,
                highest_frequency(above_mean(heights), size) / map.pitch_m, 0};
  relief.levels.push_back({map.columns, map.rows, relief_coefficients(heights, map.columns, map.rows)});
  return relief;
}

schema::Result<Relief> texture_levels(const schema::SpaceSignal& force_n, double rate_hz, double fastest_mps,
                                      const std::string& where) {
  std::vector<double> slope;
  for (const double value_n : force_n.values) slope.push_back(-value_n);
  const GridSize size{slope.size() + 1, 1};
  const auto heights = above_mean(heights_with_slope(slope, force_n.pitch_m));
  return levels_of(heights, size, highest_frequency(heights, size), force_n.pitch_m, rate_hz, fastest_mps,
                   where);
}

schema::Result<ForceRelief> force_levels(const schema::ForceGrid& grid, double rate_hz, double fastest_mps,
                                         const std::string& where) {
  const GridSize size{grid.columns, grid.rows};
  const auto x_n = above_mean(grid.x_n), y_n = above_mean(grid.y_n);
  const double highest = std::max(highest_frequency(x_n, size), highest_frequency(y_n, size));
  const auto component = [&](const std::vector<double>& force_n,
                             const std::vector<double>& heights) -> schema::Result<Relief> {
    auto relief = levels_of(heights, size, highest, grid.pitch_m, rate_hz, fastest_mps, where);
    TACTO_TRY(relief);
    const double mean_n = force_n.front() - heights.front();
    for (ReliefLevel& level : relief->levels)
      for (float& c : level.coefficients) c = static_cast<float>(double{c} + mean_n);
    relief->centre_m[0] = grid.first_x_m + 0.5 * grid.pitch_m * static_cast<double>(grid.columns - 1);
    relief->centre_m[1] = grid.first_y_m + 0.5 * grid.pitch_m * static_cast<double>(grid.rows - 1);
    return relief;
  };
  auto x = component(grid.x_n, x_n);
  TACTO_TRY(x);
  auto y = component(grid.y_n, y_n);
  TACTO_TRY(y);
  return ForceRelief{std::move(*x), std::move(*y)};
}

}  // namespace tacto::playback
