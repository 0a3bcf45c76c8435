// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/resample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "data-schema/base/quantity.hpp"
#include "spatial/dsp/resample/hermite_inverse.hpp"

namespace tacto::spatial {
namespace {

constexpr double kMostSamples = 1e9;
// A position within this distance of a grid point is on it, in spite of rounding. In pitches.
constexpr double kOnGrid = 1e-6;
constexpr std::size_t kPiece = 2048;

void by_sinc(const MonotonePath& path, const EvenPlaces& places, std::span<const double> values,
             std::size_t margin, const WindowedSinc& sinc, std::span<double> out) {
  const HermiteInverse sample_at(path.sample, path.way_m);
  std::array<double, kPiece> way, sample;
  for (std::size_t begin = 0; begin < places.count; begin += kPiece) {
    const std::size_t size = std::min(kPiece, places.count - begin);
    for (std::size_t k = 0; k < size; ++k) way[k] = places.at(begin + k);
    sample_at.evaluate_sorted(std::span(way).first(size), std::span(sample).first(size));
    for (std::size_t k = 0; k < size; ++k)
      out[begin + k] = sinc(values, sample[k] + static_cast<double>(margin));
  }
}

}  // namespace

std::string_view name_of(ResampleMethod method) {
  return method == ResampleMethod::sinc ? "sinc" : "hermite";
}

double kept_hz(ResampleMethod method, double sample_rate_hz) {
  return (method == ResampleMethod::sinc ? 0.45 : 0.24) * sample_rate_hz;
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
    by_sinc(path, places, values, margin, *sinc_, out);
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
