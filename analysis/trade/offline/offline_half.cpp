// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/offline/offline_half.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/trade/offline/spectrogram_trade.hpp"
#include "analysis/trade/rows/cpu_cost.hpp"
#include "analysis/trade/rows/stroked_texture.hpp"
#include "data-schema/base/quantity.hpp"
#include "playback/model/texture_lookup.hpp"
#include "spatial/spectrogram/budget.hpp"
#include "spatial/texture/time_filter.hpp"

namespace tacto::analysis {
namespace {

using schema::length_for_people;
using schema::Result;
using spatial::ResampleMethod;

constexpr double kEnds_m = 1e-3;

// Error of the texture as playback interpolates it, made by one method on one grid, against the exact values.
double error_read(const StrokedTexture& stroked, const spatial::SpaceGrid& grid, std::vector<double> values) {
  const schema::SpaceSignal made{grid.pitch_m, 0, std::move(values)};
  const playback::TextureLookup lookup(made, grid.origin_m());
  std::vector<double> read, truth;
  constexpr double kReadingStep_m = 0.618e-6;
  for (double x = grid.origin_m() + kEnds_m + lookup.fade_m(); x < stroked.path.way_m.back() - 2 * kEnds_m;
       x += kReadingStep_m) {
    read.push_back(lookup(x));
    truth.push_back(stroked.value(x));
  }
  return relative_error(read, truth, 0);
}

TradeRow resampled(const StrokedTexture& stroked, ResampleMethod method, double pitch_m) {
  const auto grid = spatial::grid_along(stroked.path, 1, pitch_m);
  spatial::Resampler resampler(method);
  std::vector<double> values(grid->count);
  const auto work = [&] { resampler(stroked.path, 1, *grid, stroked.force, 0, values); };
  const double cost_ns = median_cost_ns(work, static_cast<double>(stroked.force.size()));
  return {"interpolation and grid",
          fmt::format("{}, {}", name_of(method), length_for_people(pitch_m)),
          error_read(stroked, *grid, values),
          cost_ns,
          "frame",
          4 * static_cast<double>(grid->count),
          0,
          {}};
}

// Error of a filter in the band, in the presence of components outside of the band.
Result<TradeRow> filtered(const StrokedTexture& stroked, const spatial::TimeFilter& filter,
                          const std::string& name) {
  std::vector<double> dirty = stroked.force;
  double power = 0;
  for (const double force : dirty) power += force * force;
  const double amplitude = std::sqrt(power / static_cast<double>(dirty.size()) / 2);
  constexpr double kDrift_hz = 2, kHum_hz = 1700;
  for (std::size_t i = 0; i < dirty.size(); ++i) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(i) / StrokedTexture::kRate_hz;
    dirty[i] += amplitude * (std::cos(kDrift_hz * turn) + std::sin(kHum_hz * turn));
  }
  auto kept = spatial::filter_in_time(dirty, StrokedTexture::kRate_hz, filter);
  TACTO_TRY(kept);
  const auto work = [&] {
    static_cast<void>(spatial::filter_in_time(dirty, StrokedTexture::kRate_hz, filter));
  };
  const auto frames = static_cast<double>(dirty.size());
  return TradeRow{"filter",
                  name,
                  relative_error(*kept, stroked.force, dirty.size() / 20),
                  median_cost_ns(work, frames),
                  "frame",
                  8 * frames,
                  0,
                  {}};
}

Result<std::vector<TradeRow>> filters(const StrokedTexture& stroked) {
  using spatial::Edges;
  using spatial::FilterMethod;
  struct Named {
    FilterMethod method;
    Edges edges;
    int order;
    const char* name;
  };
  std::vector<TradeRow> rows;
  for (const Named& each : {Named{FilterMethod::fourier, Edges::treated, 4, "fourier, edges treated"},
                            {FilterMethod::fourier, Edges::none, 4, "fourier, edges as they are"},
                            {FilterMethod::butterworth, Edges::treated, 2, "butterworth, order 2"},
                            {FilterMethod::butterworth, Edges::treated, 4, "butterworth, order 4"},
                            {FilterMethod::butterworth, Edges::treated, 8, "butterworth, order 8"}}) {
    spatial::TimeFilter filter;
    filter.method = each.method;
    filter.edges = each.edges;
    filter.order = each.order;
    filter.band = {StrokedTexture::kLow_hz, StrokedTexture::kHigh_hz};
    auto row = filtered(stroked, filter, each.name);
    TACTO_TRY(row);
    rows.push_back(std::move(*row));
  }
  return rows;
}

// The file's single precision against double precision.
TradeRow stored_single(const StrokedTexture& stroked) {
  const std::vector<double>& values = stroked.banded.signal.values;
  std::vector<double> rounded;
  for (const double value : values) rounded.push_back(static_cast<double>(static_cast<float>(value)));
  return {"stored",
          "single precision",
          relative_error(rounded, values, 0),
          0,
          "sample",
          4 * static_cast<double>(values.size()),
          0,
          "as texture files are"};
}

}  // namespace

Result<std::vector<TradeRow>> measure_offline(const schema::Texture& texture,
                                              const std::function<void(double)>& progress) {
  const auto stroked = StrokedTexture::of(texture);
  TACTO_TRY(stroked);
  std::vector<TradeRow> rows;
  constexpr ResampleMethod kMethods[] = {ResampleMethod::hermite, ResampleMethod::sinc};
  for (const ResampleMethod method : kMethods)
    for (const double pitch_m : spatial::kGrids_m) {
      rows.push_back(resampled(*stroked, method, pitch_m));
      if (progress)
        progress(0.6 * static_cast<double>(rows.size()) /
                 static_cast<double>(std::size(kMethods) * std::size(spatial::kGrids_m)));
    }
  auto more = filters(*stroked);
  TACTO_TRY(more);
  std::ranges::move(*more, std::back_inserter(rows));
  rows.push_back(stored_single(*stroked));
  if (progress) progress(0.75);
  more = measure_spectrogram_trade(stroked->banded);
  TACTO_TRY(more);
  std::ranges::move(*more, std::back_inserter(rows));
  return rows;
}

}  // namespace tacto::analysis
