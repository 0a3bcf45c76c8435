// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/plausibility.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "analysis/identify/fit/starting_values.hpp"
#include "analysis/identify/measure/angles.hpp"
#include "analysis/identify/measure/hold.hpp"
#include "data-schema/base/decibels.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr double kClearly = 0.25;
constexpr double kBadStart = 0.2;  // of the data's weight; the grid alone fits a good response better
constexpr double kHalfTurn = 2.2;  // rad: a step between neighbours that is nearer to a half turn than to 0
constexpr double kAmplitudeRatio = 2;  // largest ratio of neighbouring amplitudes
constexpr double kOtherUnit = 200;
constexpr double kOtherFrequency = 3.5;  // below 2 pi, and above 2 for a resonance of half the base's

template <class Change>
BodeData changed(BodeData data, Change change) {
  for (std::size_t i = 0; i < data.size(); ++i) data.response[i] = change(data.response[i]);
  return data;
}

double left_by_grid(const ResponseModel& model, const BodeData& data) {
  BodeData plain = data;
  plain.noise.clear();  // relative errors, because the phase matters at all frequencies
  return starting_values(model, plain).left;
}

// Removes half turns between neighbours.
BodeData without_half_turns(BodeData data, std::size_t& first_step) {
  double sign = 1;
  auto before = data.response.front();
  for (std::size_t i = 1; i < data.size(); ++i) {
    const auto here = data.response[i];
    const double step = std::abs(std::arg(here / before)), ratio = std::abs(here / before);
    if (step > kHalfTurn && ratio < kAmplitudeRatio && ratio > 1 / kAmplitudeRatio) {
      sign = -sign;
      if (first_step == 0) first_step = i;
    }
    before = here;
    data.response[i] *= sign;
  }
  return data;
}

std::string invert_remedy(bool inverted) {
  return inverted ? "omit --invert" : "reverse the sensor's polarity, or give --invert";
}

std::string unit_words(double times) {
  const double powers = std::round(std::log10(times) / 3) * 3;
  return fmt::format(
      "{:.3g} times that of '{{}}'; if the unit of the values is 10^{:g} times {} than stated, name the unit",
      times, std::abs(powers), times > 1 ? "smaller" : "larger");
}

Result<void> check_times(double times, const schema::Transducer& base, const std::string& source,
                         const char* remedy) {
  if (times < kOtherUnit && times > 1 / kOtherUnit) return {};
  return fail(ErrorKind::unsuitable, "the gain is " + fmt::format(fmt::runtime(unit_words(times)), base.name),
              source, remedy);
}

}  // namespace

namespace {

std::string turns_remedy(Turned needed, Turned given) {
  if (!needed.conjugated) return invert_remedy(given.inverted);
  if (!needed.inverted) return given.conjugated ? "omit --phase-sign" : "give --phase-sign -1";
  if (given.conjugated && given.inverted) return "omit --phase-sign and --invert";
  if (given.conjugated) return "omit --phase-sign, and give --invert";
  if (given.inverted) return "give --phase-sign -1, and omit --invert";
  return "give --phase-sign -1 and --invert";
}

std::string turns_words(Turned needed, Direction direction) {
  const std::string grows = "the phase increases where a lag has to decrease",
                    down = "the response has the inverted sign",
                    why = direction == Direction::actuator
                              ? ": a positive drive gives a negative displacement"
                              : ": its voltage has the opposite sign of the transducer's for the same force";
  if (!needed.inverted) return grows + ": it has the opposite sign convention";
  return needed.conjugated ? grows + ", and " + down : down + why;
}

// The change with the smallest residual, if that is clearly less than without a change; otherwise {}.
Turned turns_needed(const ResponseModel& model, const BodeData& data, double left) {
  double least = kClearly * left;
  Turned needed;
  for (const Turned turn : {Turned{true, false}, Turned{false, true}, Turned{true, true}}) {
    const double by_turn =
        left_by_grid(model, changed(data, [&](auto h) {
                       return (turn.inverted ? -1.0 : 1.0) * (turn.conjugated ? std::conj(h) : h);
                     }));
    if (by_turn < least) least = by_turn, needed = turn;
  }
  return needed;
}

}  // namespace

Result<void> check_phases(const BodeData& measured, const ModelChoice& choice, const schema::Transducer& base,
                          Turned turned) {
  if (choice.finger) return {};
  const BodeData data =
      without_hold(measured, [&](double hz) { return schema::actuator_response(base, hz); });
  const ResponseModel model({.direction = choice.direction}, base, data);
  const double left = left_by_grid(model, data);
  if (left < kBadStart) return {};
  std::size_t step = 0;
  const double unturned = left_by_grid(model, without_half_turns(data, step));
  if (step > 0 && unturned < kClearly * left)
    return fail(
        ErrorKind::unsuitable,
        fmt::format(
            "the phase steps by half a turn from {:.4g} to {:.4g} Hz where the amplitude does not fall: it "
            "was unwrapped wrongly",
            data.frequency_hz[step - 1], data.frequency_hz[step]),
        data.source, "take the phase of the complex ratio (atan2), not of a quotient");
  const Turned needed = turns_needed(model, data, left);
  if (needed.conjugated || needed.inverted)
    return fail(ErrorKind::unsuitable, turns_words(needed, data.direction), data.source,
                turns_remedy(needed, turned));
  return {};
}

namespace {

// In degrees, as in the table.
double largest_angle(const BodeData& data) {
  double most = 0;
  for (const auto& value : data.response) most = std::max(most, kDegrees * std::abs(std::arg(value)));
  return most;
}

constexpr double kLoudest = 400;        // dB: no measured level is larger, and 10^20 times the unit is finite
constexpr double kExplained = 0.99;     // R^2
constexpr double kMostRadians = kTurn;  // three poles lag by three quarters of a turn

}  // namespace

Result<void> check_units(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base) {
  if (choice.finger || !data.table_in_degrees || largest_angle(data) > kMostRadians) return {};
  const ResponseModel model({.direction = choice.direction}, base, data);
  const BodeData radians =
      changed(data, [](auto h) { return std::polar(std::abs(h), kDegrees * std::arg(h)); });
  if (left_by_grid(model, radians) >= kClearly * left_by_grid(model, data)) return {};
  return fail(
      ErrorKind::unsuitable,
      fmt::format("no phase is beyond {:.3g} degrees: these are probably radians", largest_angle(data)),
      data.source, "give --phase-unit rad, or write phase_rad into the header");
}

Result<void> check_measured(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base,
                            Turned turned) {
  if (const auto sound = check_bode(data); !sound) return sound;
  if (const auto said = check_units(data, choice, base); !said) return said;
  return check_phases(data, choice, base, turned);
}

Result<void> check_levels(const ResponseFit& fit, const schema::Transducer& base) {
  const double unit_si = fit.data.table_unit_si;
  if (!fit.misfit.found || !(unit_si > 0)) return {};
  BodeData levels = changed(fit.data, [&](auto h) {
    return std::polar(unit_si * schema::amplitude_of_db(std::min(std::abs(h) / unit_si, kLoudest)),
                      std::arg(h));
  });
  levels.noise.clear();
  levels.noise_from_residuals = false;
  const ResponseFit other = fit_response(levels, fit.choice, base);
  if (!other.claims_intervals() || other.r_squared < kExplained) return {};
  return fail(ErrorKind::unsuitable, "the amplitudes fit as levels only: these are probably decibels",
              fit.data.source, "give --amplitude-unit with \"dB \" before the unit, as \"dB um/V\"");
}

Result<void> check_size(const ResponseFit& fit, const schema::Transducer& base) {
  const bool actuator = fit.data.direction == Direction::actuator;
  return check_times(actuator ? fit.transducer.actuator_scale / base.actuator_scale
                              : fit.transducer.sensor_scale / base.sensor_scale,
                     base, fit.data.source, "give --amplitude-unit, or --implausible if the gain is correct");
}

Result<void> check_frequencies(const ResponseFit& fit, const schema::Transducer& base) {
  const FittedParameter* const resonance = fit.find("resonance_hz");
  if (resonance == nullptr || !fit.claims_intervals()) return {};
  const double times = resonance->value / schema::resonance_hz(base);
  if (times < kOtherFrequency && times > 1 / kOtherFrequency) return {};
  const bool in_khz = times < 1;
  return fail(ErrorKind::unsuitable,
              fmt::format("the resonance is {:.4g} Hz, {:.3g} times that of '{}'; if the frequencies are in "
                          "{} it is {:.4g} Hz",
                          resonance->value, times, base.name, in_khz ? "kHz" : "rad/s",
                          resonance->value * (in_khz ? 1e3 : 1 / kTurn)),
              fit.data.source,
              "write frequency_khz or frequency_rad_per_s into the header, or give --implausible if they are "
              "correct");
}

Result<void> check_size(const LoopFit& fit, const schema::Transducer& base, const std::string& source) {
  return check_times(
      std::abs(fit.gain_m_per_v) / std::abs(schema::actuator_response(base, 0)), base, source,
      "write the unit into the table's first line, or give --implausible if the gain is correct");
}

Result<void> check_upright(const LoopFit& fit, const std::string& source, bool inverted) {
  if (fit.gain_m_per_v > 0) return {};
  return fail(ErrorKind::unsuitable,
              "the loops have the inverted sign: a positive drive gives a negative displacement", source,
              invert_remedy(inverted));
}

}  // namespace tacto::analysis
