// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/along_path.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "spatial/strokes/monotone_path.hpp"
#include "spatial/strokes/smoothed_speed.hpp"
#include "spatial/texture/resample.hpp"
#include "spatial/texture/valid_band.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr std::size_t kFewestAlong = 64;
constexpr spatial::ResampleMethod kAlongMethod = spatial::ResampleMethod::sinc;

std::vector<schema::BandPoint> band_along_path(const SignalAlongPath& signal,
                                               const spatial::MonotonePath& path,
                                               const spatial::SpaceGrid& grid, int direction) {
  const double duration_s = static_cast<double>(signal.values.size() - 1) / signal.rate_hz;
  const double mean_mps = (path.way_m.back() - path.way_m.front()) / duration_s;
  const auto least = static_cast<double>(spatial::speed_window(signal.quantum_m, mean_mps, signal.rate_hz));
  const spatial::LocalSpeed speed(
      path, signal.rate_hz, spatial::speed_windows(signal.quantum_m, least, signal.band, signal.rate_hz));
  const double length_m = static_cast<double>(grid.count - 1) * grid.pitch_m;
  const auto profile = spatial::speed_profile(speed, grid.origin_m(), length_m, direction);
  const spatial::Band kept{signal.band.low_hz,
                           std::min(signal.band.high_hz, spatial::kept_hz(kAlongMethod, signal.rate_hz))};
  auto band = spatial::valid_band(profile, kept);
  spatial::narrow(band, 0, 0.5 / grid.pitch_m);
  return band;
}

}  // namespace

Result<schema::Texture> texture_along(const SignalAlongPath& signal) {
  if (signal.values.size() < kFewestAlong)
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("has {} samples, at least {} are needed", signal.values.size(), kFewestAlong), "stroke");
  const int direction = signal.position_m.back() > signal.position_m.front() ? 1 : -1;
  const auto path = spatial::monotone_path(signal.position_m, direction, {signal.quantum_m, 0});
  if (path.way_m.size() < 2) return schema::fail(ErrorKind::unsuitable, "the finger does not move", "stroke");
  const auto grid = spatial::grid_along(path, direction, signal.pitch_m);
  TACTO_TRY(grid);
  schema::Texture texture;
  texture.signal = {signal.pitch_m, 0,
                    spatial::resample(path, direction, *grid, signal.values, 0, kAlongMethod)};
  texture.source_origin_m = grid->origin_m();
  texture.direction = direction;
  texture.quantity = signal.quantity;
  texture.unit = signal.unit;
  texture.valid_band = band_along_path(signal, path, *grid, direction);
  return texture;
}

}  // namespace tacto::analysis
