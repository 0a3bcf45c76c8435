// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>

#include "analysis/live/live_query.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/recording/recording.hpp"
#include "firmware-host/core/scene/grooves.hpp"
#include "firmware-host/core/scene/noise.hpp"
#include "playback/prepare/relief/groove_series.hpp"
#include "playback/prepare/relief/noise_octaves.hpp"
#include "spatial/transform/stretch.hpp"
#include "spatial/transform/transform.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;
using schema::for_people;
using schema::Result;
using schema::Texture;

// The parameters of computed textures. A narrower period or edge has less than ten samples.
struct ShapeNumber {
  std::string_view name;
  double LiveShape::*member;
  double least, most;
};
constexpr std::array<ShapeNumber, 7> kNumbers = {{
    {"stretch", &LiveShape::stretch, spatial::kLeastStretch, spatial::kMostStretch},
    {"period_m", &LiveShape::period_m, 2e-4, 20e-3},
    {"depth_m", &LiveShape::depth_m, 1e-7, 1e-3},
    {"duty", &LiveShape::duty, 0.05, 0.95},
    {"smooth_m", &LiveShape::smooth_m, 2e-5, 1e-3},
    {"slope_db", &LiveShape::slope_db, -24, 0},
    {"seed", &LiveShape::seed, 0, 1e6},
}};

constexpr double kPitchM = 5e-6, kLengthM = 40e-3;  // the samples of Wiertlewski 2011 have 40 mm
constexpr double kKappaN = schema::kTargetLoad_n.middle;
constexpr double kFinestOctaveM = 2e-4;
constexpr double kLeastFilterPeriods = 1.0 / 76;  // below it harmonics are left out: automatic_filter_m()
constexpr std::int64_t kOffLattice = 0x5EB851EC;  // 0.37 of a cell

std::string names() {
  std::string all = "keep_slope, low_per_m, high_per_m";
  for (const ShapeNumber& number : kNumbers) all += fmt::format(", {}", number.name);
  return all;
}

Texture computed(const std::string& what, const std::string& parameters,
                 const std::function<double(double x_m)>& slope_at) {
  Texture texture;
  texture.signal.pitch_m = kPitchM;
  texture.signal.values.resize(static_cast<std::size_t>(std::lround(kLengthM / kPitchM)) + 1);
  for (std::size_t i = 0; i < texture.signal.values.size(); ++i)
    texture.signal.values[i] = kKappaN * slope_at(texture.signal.position_m(i));
  texture.surface = "computed " + what;
  texture.notes = fmt::format("{}; force = {} x slope", parameters, for_people(kKappaN, Dimension::force));
  texture.created = schema::creation_time();
  texture.creator = "tactograph live";
  return texture;
}

}  // namespace

Result<LiveShape> parse_shape(const std::string& query) {
  LiveShape shape;
  const ShapeNumber* beyond = nullptr;
  const auto take = [&](std::string_view name, double value) {
    if (name == "keep_slope") {
      shape.keep_slope = value != 0;
    } else if (name == "low_per_m") {
      shape.low_per_m = value;
    } else if (name == "high_per_m") {
      shape.high_per_m = value;
    } else {
      const auto* const number = std::ranges::find(kNumbers, name, &ShapeNumber::name);
      if (number == kNumbers.end()) return false;
      if (value < number->least || value > number->most) beyond = number;
      shape.*(number->member) = value;
    }
    return true;
  };
  TACTO_TRY(read_query(query, names(), take));
  if (beyond != nullptr)
    return schema::fail(schema::ErrorKind::usage, "is out of its range", std::string(beyond->name),
                        fmt::format("use {:g} to {:g}", beyond->least, beyond->most));
  return shape;
}

Result<ShapedTexture> shaped_texture(const std::string& file, const LiveShape& shape) {
  ShapedTexture shaped;
  auto texture = spatial::read_transform_source(file);
  TACTO_TRY(texture);
  if (shape.low_per_m || shape.high_per_m) {
    constexpr double kWholeGrid = 0.45;  // of the samples per metre: up to there the grid is exact
    texture = spatial::filtered(*texture, shape.low_per_m.value_or(0),
                                shape.high_per_m.value_or(kWholeGrid / texture->signal.pitch_m));
    shaped.ending += "-band";
  }
  if (texture && shape.stretch != 1) {
    spatial::Stretch stretch;
    stretch.factor = shape.stretch;
    stretch.keep_slope = shape.keep_slope;
    texture = spatial::stretch(*texture, stretch);
    shaped.ending += "-stretched";
  }
  if (!texture) texture.error().where = file;
  TACTO_TRY(texture);
  shaped.texture = std::move(*texture);
  for (const schema::TransformStep& step : shaped.texture.transform->steps)
    for (const auto& [name, member] : schema::kTransformNumbers)
      if (step.*member) shaped.effective.add(name, *(step.*member));
  return shaped;
}

ShapedTexture grating_texture(const LiveShape& shape) {
  const double filter_periods = std::max(shape.smooth_m / shape.period_m, kLeastFilterPeriods);
  const double smooth_m = filter_periods * shape.period_m;
  std::vector<float> amplitudes;
  std::ranges::copy(playback::groove_amplitudes(schema::GrooveProfile::square, filter_periods, shape.duty),
                    std::back_inserter(amplitudes));
  const core::Grooves grooves{amplitudes.data(), static_cast<std::uint32_t>(amplitudes.size())};
  const auto slope_at = [&](double x_m) {
    const double periods = x_m / shape.period_m;
    const auto phase =
        static_cast<std::uint32_t>(static_cast<std::uint64_t>(std::ldexp(periods - std::floor(periods), 32)));
    return shape.depth_m / shape.period_m * double{core::groove_at(grooves, phase, 0).by_phase};
  };
  ShapedTexture shaped;
  shaped.texture = computed(
      "grating",
      fmt::format("period {}, depth {}, {:g} % high, edges smoothed by {}",
                  for_people(shape.period_m, Dimension::length), for_people(shape.depth_m, Dimension::length),
                  100 * shape.duty, for_people(smooth_m, Dimension::length)),
      slope_at);
  shaped.ending = "grating";
  shaped.effective.add("period_m", shape.period_m)
      .add("depth_m", shape.depth_m)
      .add("duty", shape.duty)
      .add("smooth_m", smooth_m);
  return shaped;
}

ShapedTexture noise_texture(const LiveShape& shape) {
  schema::NoiseLayer layer;
  layer.octaves.value = 1 + std::floor(std::log2(shape.period_m / kFinestOctaveM));
  layer.roughness.value = schema::amplitude_of_db(shape.slope_db);
  const auto seed = static_cast<std::uint32_t>(shape.seed);
  const core::NoiseTable table = core::shuffled_noise(seed);
  std::vector<float> weights;
  std::ranges::copy(playback::octave_amplitudes(layer), std::back_inserter(weights));
  const auto slope_at = [&](double x_m) {
    const auto x = static_cast<core::Q32>(std::llround(std::ldexp(x_m / shape.period_m, 32)));
    return shape.depth_m / shape.period_m *
           double{core::fractal_noise(table, x, kOffLattice, kOffLattice, weights.data(),
                                      static_cast<std::uint32_t>(weights.size()))
                      .by_x};
  };
  ShapedTexture shaped;
  shaped.texture =
      computed("noise",
               fmt::format("{} octaves from {} down, depth {}, {:g} dB from each octave to the next, seed {}",
                           weights.size(), for_people(shape.period_m, Dimension::length),
                           for_people(shape.depth_m, Dimension::length), shape.slope_db, seed),
               slope_at);
  shaped.ending = "noise";
  shaped.effective.add("period_m", shape.period_m)
      .add("depth_m", shape.depth_m)
      .add("slope_db", shape.slope_db)
      .add("octaves", weights.size())
      .add("seed", std::int64_t{seed});
  return shaped;
}

}  // namespace tacto::analysis
