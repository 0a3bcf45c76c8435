// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/resample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>

#include "data-schema/base/quantity.hpp"
#include "spatial/dsp/resample/hermite.hpp"
#include "spatial/dsp/resample/hermite_inverse.hpp"

namespace tacto::spatial {
namespace {

constexpr double kMostSamples = 1e9;
// A position within this distance of a grid point is on it, in spite of rounding. In pitches.
constexpr double kOnGrid = 1e-6;
constexpr std::size_t kPiece = 2048;

// The times at which the finger was at increasing positions.
using Times = std::function<void(std::span<const double> way, std::span<double> sample)>;
using Value = std::function<double(double sample)>;

void clamp_all(std::span<double> values, double low, double high) {
  for (double& value : values) value = std::clamp(value, low, high);
}

Times linear_times(const MonotonePath& path) {
  return [&path, i = std::size_t{0}](std::span<const double> way, std::span<double> sample) mutable {
    for (std::size_t k = 0; k < way.size(); ++k) {
      while (i + 2 < path.way_m.size() && way[k] >= path.way_m[i + 1]) ++i;
      const double share = (way[k] - path.way_m[i]) / (path.way_m[i + 1] - path.way_m[i]);
      sample[k] = path.sample[i] + share * (path.sample[i + 1] - path.sample[i]);
    }
    clamp_all(sample, path.sample.front(), path.sample.back());
  };
}

Times swapped_times(const MonotonePath& path) {
  return [&path, sample_at = HermiteCurve(path.way_m, path.sample)](std::span<const double> way,
                                                                    std::span<double> sample) {
    sample_at.evaluate_sorted(way, sample);
    clamp_all(sample, path.sample.front(), path.sample.back());
  };
}

Times true_times(const MonotonePath& path) {
  return
      [sample_at = HermiteInverse(path.sample, path.way_m)](
          std::span<const double> way, std::span<double> sample) { sample_at.evaluate_sorted(way, sample); };
}

Times times_of(ResampleMethod method, const MonotonePath& path) {
  if (method == ResampleMethod::linear) return linear_times(path);
  return method == ResampleMethod::swapped ? swapped_times(path) : true_times(path);
}

Value values_of(ResampleMethod method, std::span<const double> values, std::size_t margin,
                const WindowedSinc* sinc) {
  const double before = static_cast<double>(margin);
  if (method == ResampleMethod::sinc) return [=](double sample) { return (*sinc)(values, sample + before); };
  if (method == ResampleMethod::swapped) return UniformHermiteCurve(-before, 1, values);
  return [=](double sample) {
    const double place = sample + before;
    const double i = std::clamp(std::floor(place), 0.0, static_cast<double>(values.size() - 2));
    const auto k = static_cast<std::size_t>(i);
    return values[k] + (place - i) * (values[k + 1] - values[k]);
  };
}

void in_two_steps(const EvenPlaces& places, const Times& times, const Value& value, std::span<double> out) {
  std::array<double, kPiece> way, sample;
  for (std::size_t begin = 0; begin < places.count; begin += kPiece) {
    const std::size_t size = std::min(kPiece, places.count - begin);
    for (std::size_t k = 0; k < size; ++k) way[k] = places.at(begin + k);
    times(std::span(way).first(size), std::span(sample).first(size));
    for (std::size_t k = 0; k < size; ++k) out[begin + k] = value(sample[k]);
  }
}

}  // namespace

std::string_view name_of(ResampleMethod method) {
  switch (method) {
    case ResampleMethod::linear:
      return "linear";
    case ResampleMethod::swapped:
      return "swapped";
    case ResampleMethod::sinc:
      return "sinc";
    case ResampleMethod::hermite:
      break;
  }
  return "hermite";
}

double kept_hz(ResampleMethod method, double sample_rate_hz) {
  switch (method) {
    case ResampleMethod::linear:
      return 0.178 * sample_rate_hz;
    case ResampleMethod::sinc:
      return 0.45 * sample_rate_hz;
    case ResampleMethod::hermite:
    case ResampleMethod::swapped:
      break;
  }
  return 0.24 * sample_rate_hz;
}

std::size_t margin_of(ResampleMethod method) {
  // The monotone cubic's slope at the next sample depends on one sample more.
  return method == ResampleMethod::sinc ? WindowedSinc::kReach : 2;
}

schema::Result<SpaceGrid> grid_along(const MonotonePath& path, int direction, double pitch_m) {
  using schema::ErrorKind;
  const auto [low_m, high_m] = std::minmax({direction * path.way_m.front(), direction * path.way_m.back()});
  const double first = std::ceil(low_m / pitch_m - kOnGrid), last = std::floor(high_m / pitch_m + kOnGrid);
  if (last - first < 1)
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("the stroke of {} is between two points of the grid of {}",
                    schema::length_for_people(high_m - low_m), schema::length_for_people(pitch_m)),
        {}, "use a finer --grid");
  if (last - first >= kMostSamples)
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("a grid of {} on {} needs more than 1e9 samples", schema::length_for_people(pitch_m),
                    schema::length_for_people(high_m - low_m)),
        {}, "use a coarser --grid");
  return SpaceGrid{pitch_m, first, static_cast<std::size_t>(last - first) + 1};
}

Resampler::Resampler(ResampleMethod method) : method_(method) {
  if (method == ResampleMethod::sinc) sinc_ = std::make_unique<const WindowedSinc>();
}

void Resampler::operator()(const MonotonePath& path, int direction, const SpaceGrid& grid,
                           std::span<const double> values, std::size_t margin, std::span<double> out) {
  assert(out.size() == grid.count && (direction == 1 || direction == -1));
  // A backward stroke reaches the grid's last point first.
  const double first = direction > 0 ? grid.first : -(grid.first + static_cast<double>(grid.count - 1));
  const EvenPlaces places{first, grid.pitch_m, grid.count};
  if (method_ == ResampleMethod::hermite)
    hermite_(path.sample, path.way_m, values, margin, places, out);
  else
    in_two_steps(places, times_of(method_, path), values_of(method_, values, margin, sinc_.get()), out);
  if (direction < 0) std::ranges::reverse(out);
}

std::vector<double> resample(const MonotonePath& path, int direction, const SpaceGrid& grid,
                             std::span<const double> values, std::size_t margin, ResampleMethod method) {
  std::vector<double> result(grid.count);
  Resampler resampler(method);
  resampler(path, direction, grid, values, margin, result);
  return result;
}

}  // namespace tacto::spatial
