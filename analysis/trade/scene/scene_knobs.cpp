// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/scene/scene_knobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data-schema/base/quantity.hpp"
#include "playback/prepare/relief/groove_series.hpp"
#include "playback/prepare/relief/noise_octaves.hpp"
#include "playback/prepare/scene/field_section.hpp"

namespace tacto::analysis {
namespace {

constexpr double kUnit = 0x1p-24;           // rounding of one operation in single precision
constexpr double kPlaceOfPeriod = 0x1p-31;  // of a place on a surface (core::place_on())

double largest_size(const schema::LayerNumber& number) {
  double size = std::abs(number.value);
  if (number.slider) size = std::max({size, std::abs(number.slider->from), std::abs(number.slider->to)});
  return size;
}

schema::LayerNumber scaled_number(schema::LayerNumber number, double factor) {
  number.value *= factor;
  if (number.slider)
    number.slider = schema::SliderRange{number.slider->from * factor, number.slider->to * factor};
  return number;
}

// The force of a surface whose slope is 1 per period.
double force_per_slope_n(const schema::LayerNumber& kappa_n, const schema::LayerNumber& depth_m,
                         double period_m) {
  return largest_size(kappa_n) * largest_size(depth_m) / period_m;
}

std::vector<LayerChoice> octave_choices(const schema::NoiseLayer& noise) {
  const auto amplitudes = playback::octave_amplitudes(noise);
  const double force_n = force_per_slope_n(noise.kappa_n, noise.depth_m, noise.period_m.value);
  std::vector<LayerChoice> choices;
  double left_out = 0;
  for (std::size_t n = amplitudes.size(); n > 0; --n) {
    schema::NoiseLayer changed = noise;
    if (n < amplitudes.size()) {
      left_out += amplitudes[n] * std::exp2(static_cast<double>(n));
      changed.octaves = {static_cast<double>(n)};
      changed.depth_m = scaled_number(noise.depth_m, amplitudes[0] / playback::octave_amplitudes(changed)[0]);
    }
    choices.push_back(
        {fmt::format("{} octave{}", n, n == 1 ? "" : "s"), changed, force_n * kNoiseSlope * left_out});
  }
  return choices;
}

std::vector<double> series_of(const schema::GroovesLayer& grooves) {
  return playback::groove_amplitudes(grooves.profile, grooves.filter_m->value / grooves.period_m.value);
}

// The sum of n |a - b|.
double slope_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i)
    sum += static_cast<double>(i + 1) * std::abs((i < a.size() ? a[i] : 0) - (i < b.size() ? b[i] : 0));
  return sum;
}

std::vector<LayerChoice> filter_choices(const schema::GroovesLayer& grooves) {
  const auto words = [](const schema::GroovesLayer& of) {
    return "filter " + schema::for_people(of.filter_m->value, schema::Dimension::length);
  };
  std::vector<LayerChoice> choices = {{words(grooves), grooves, 0}};
  if (grooves.profile == schema::GrooveProfile::sine) return choices;
  const double period_m = grooves.period_m.value;
  const double force_n = 2 * std::numbers::pi * force_per_slope_n(grooves.kappa_n, grooves.depth_m, period_m);
  const auto whole = series_of(grooves);
  std::size_t harmonics = whole.size();
  for (const double part : {64, 48, 32, 24, 16, 12, 8, 6, 4}) {
    schema::GroovesLayer changed = grooves;
    changed.filter_m = schema::LayerNumber{period_m / part};
    const auto series = series_of(changed);
    if (changed.filter_m->value <= grooves.filter_m->value || series.size() >= harmonics) continue;
    harmonics = series.size();
    choices.push_back({words(changed), changed, force_n * slope_difference(whole, series)});
  }
  return choices;
}

double half_diagonal_m(const schema::Patch& patch) {
  return std::hypot(patch.width_m, patch.height_m) / 2;
}

// The largest slope of each level by the differences of its coefficients, of which a B-spline's slope is a
// mean; along rows and columns together.
double slope_bound(const playback::Relief& relief) {
  double largest = 0;
  for (const playback::ReliefLevel& level : relief.levels) {
    double by_column = 0, by_row = 0;
    for (std::size_t at = 0; at < level.coefficients.size(); ++at) {
      const double here = double{level.coefficients[at]};
      if ((at + 1) % level.columns != 0)
        by_column = std::max(by_column, std::abs(double{level.coefficients[at + 1]} - here));
      if (at + level.columns < level.coefficients.size())
        by_row = std::max(by_row, std::abs(double{level.coefficients[at + level.columns]} - here));
    }
    const auto per_m = [&](std::size_t of_level, std::size_t of_map) {
      return static_cast<double>(of_level) / (static_cast<double>(of_map) * relief.pitch_m);
    };
    largest = std::max(
        largest, by_column * per_m(level.columns, relief.columns) + by_row * per_m(level.rows, relief.rows));
  }
  return largest;
}

// Of the largest coefficient: the weights of the sixteen sum to 1. 16 operations round each, the place in its
// cell is rounded by 2^-25 or less on a slope of at most two coefficients, and with the angle of a level's
// mixture these stay below 64 roundings.
double rounding_of_map_n(const playback::ForceRelief& forces) {
  double largest = 0;
  for (const playback::Relief* component : {&forces.x, &forces.y})
    for (const playback::ReliefLevel& level : component->levels)
      for (const float c : level.coefficients) largest = std::max(largest, std::abs(double{c}));
  return std::numbers::sqrt2 * 64 * kUnit * largest;
}

double rounding_of_grooves_n(const schema::GroovesLayer& grooves) {
  const auto series = series_of(grooves);
  double slopes = 0, curvatures = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(i + 1);
    slopes += turn * std::abs(series[i]);
    curvatures += turn * turn * std::abs(series[i]);
  }
  return force_per_slope_n(grooves.kappa_n, grooves.depth_m, grooves.period_m.value) *
         (3e-6 * slopes + kPlaceOfPeriod * curvatures);
}

// Of the place of the hand, as of a spring, times the largest sum of what it adds to the motion of the body:
// 1 + 2 / zeta bounds the sum of the absolute response of a spring with the damping ratio zeta. Where a body
// with friction sticks or slips a tick later than in double precision, its place is another one; this is not
// in it.
double rounding_of_coupling_n(double far_m, double stiffness, double damping, double mass_kg) {
  const double zeta = damping / (2 * std::sqrt(stiffness * mass_kg));
  const double at_speed_n = damping * playback::kFastestHandMps;
  return 16 * kUnit * (stiffness * far_m + at_speed_n) * (1 + 2 / std::min(zeta, 1.0));
}

double rounding_of_noise_n(const schema::NoiseLayer& noise) {
  const auto amplitudes = playback::octave_amplitudes(noise);
  constexpr double kCurvature = 12.5;  // of one octave, per squared cell (scene_device.cpp)
  double sum = 0;
  for (std::size_t i = 0; i < amplitudes.size(); ++i) {
    const double cells = std::exp2(static_cast<double>(i));
    sum += amplitudes[i] * cells * (1e-5 + kPlaceOfPeriod * cells * kCurvature);
  }
  return force_per_slope_n(noise.kappa_n, noise.depth_m, noise.period_m.value) * sum;
}

}  // namespace

std::vector<LayerKnob> layer_knobs(const std::vector<schema::Patch>& patches) {
  std::vector<LayerKnob> knobs;
  for (std::size_t i = 0; i < patches.size(); ++i)
    for (std::size_t j = 0; j < patches[i].layers.size(); ++j) {
      const schema::ForceLayer& layer = patches[i].layers[j];
      LayerKnob knob{i, j, "", {}};
      const auto name = [&](const char* what) {
        knob.name = fmt::format("{} of {} {} of '{}'", what, type_of(layer), j, patches[i].name);
      };
      layer.visit(
          [&](const schema::NoiseLayer& noise) {
            name("octaves");
            knob.choices = octave_choices(noise);
          },
          [&](const schema::GroovesLayer& grooves) {
            name("filter");
            knob.choices = filter_choices(grooves);
          },
          [](const auto& /*without a choice*/) {});
      if (knob.choices.size() > 1) knobs.push_back(std::move(knob));
    }
  return knobs;
}

double rounding_bound_n(const schema::Patch& patch, const schema::ForceLayer& layer,
                        const playback::Reliefs& reliefs) {
  constexpr double kOperations = 16;  // of a place, and of its distance from the centre of a spring
  return layer.visit(
      [&](const schema::SpringLayer& spring) {
        const double far_m = std::hypot(patch.x_m, patch.y_m) + 2 * half_diagonal_m(patch) +
                             std::hypot(largest_size(spring.centre_x_m), largest_size(spring.centre_y_m));
        return kOperations * kUnit * largest_size(spring.stiffness_n_per_m) * far_m;
      },
      [&](const schema::DamperLayer& damper) {
        return kOperations * kUnit * largest_size(damper.damping_n_s_per_m) * playback::kFastestHandMps;
      },
      [](const schema::GroovesLayer& grooves) { return rounding_of_grooves_n(grooves); },
      [](const schema::NoiseLayer& noise) { return rounding_of_noise_n(noise); },
      [&](const schema::HeightMapLayer& map) {
        return 1e-5 * largest_size(map.kappa_n) * slope_bound(reliefs.of(map));
      },
      [&](const schema::TextureForceLayer& texture) {
        return 1e-5 * largest_size(texture.gain) * slope_bound(reliefs.of(texture));
      },
      [&](const schema::MoverLayer& mover) {
        const double fastest_mps = playback::kFastestHandMps + largest_size(mover.speed_mps);
        return kOperations * kUnit * largest_size(mover.damping_n_s_per_m) * fastest_mps;
      },
      [&](const schema::BodyLayer& body) {
        return rounding_of_coupling_n(2 * half_diagonal_m(patch) + std::hypot(patch.x_m, patch.y_m),
                                      largest_size(body.stiffness_n_per_m),
                                      largest_size(body.damping_n_s_per_m), body.mass_kg.value);
      },
      [&](const schema::LassoLayer& lasso) {
        return rounding_of_coupling_n(2 * half_diagonal_m(patch) + std::hypot(patch.x_m, patch.y_m),
                                      largest_size(lasso.stiffness_n_per_m),
                                      largest_size(lasso.damping_n_s_per_m), lasso.mass_kg.value);
      },
      [&](const schema::FieldLayer& field) {
        const auto section = playback::field_section(field, reliefs.of(field), patch);
        return largest_size(field.force_scale) *
               playback::field_rounding_n(section, patch, least_value(field.z_m), largest_value(field.z_m));
      },
      [&](const schema::ForceMapLayer& map) {
        return largest_size(map.gain) * rounding_of_map_n(reliefs.of(map));
      });
}

}  // namespace tacto::analysis
