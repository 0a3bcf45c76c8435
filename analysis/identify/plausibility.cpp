// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/plausibility.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "analysis/identify/hold.hpp"
#include "analysis/identify/starting_values.hpp"

namespace tacto::analysis {
namespace {

using schema::fail;
using schema::Fault;
using schema::Result;

constexpr double kClearly = 0.25;
constexpr double kBadStart = 0.2;  // of the data's weight: the grid alone leaves less of a sound response
constexpr double kHalfTurn =
    2.2;                      // rad: a step between neighbours that is nearer to a half turn than to none
constexpr double kLevel = 2;  // amplitudes of neighbours within this factor
constexpr double kOtherUnit = 200;

template <class Change>
BodeData changed(BodeData data, Change change) {
  for (std::size_t i = 0; i < data.size(); ++i) data.response[i] = change(data.response[i]);
  return data;
}

double left_by_grid(const ResponseModel& model, const BodeData& data) {
  BodeData plain = data;
  plain.noise.clear();  // relative: what matters is the phase everywhere
  return starting_values(model, plain).left;
}

// Half turns that come from one neighbour to the next are taken back.
BodeData without_half_turns(BodeData data, std::size_t& first_step) {
  double sign = 1;
  auto before = data.response.front();
  for (std::size_t i = 1; i < data.size(); ++i) {
    const auto here = data.response[i];
    const double step = std::abs(std::arg(here / before)), ratio = std::abs(here / before);
    if (step > kHalfTurn && ratio < kLevel && ratio > 1 / kLevel) {
      sign = -sign;
      if (first_step == 0) first_step = i;
    }
    before = here;
    data.response[i] *= sign;
  }
  return data;
}

std::string unit_words(double times) {
  const double powers = std::round(std::log10(times) / 3) * 3;
  return fmt::format(
      "{:.3g} times what '{{}}' gives; if the values are in a unit 10^{:g} times {} than was said, name it",
      times, std::abs(powers), times > 1 ? "smaller" : "larger");
}

}  // namespace

Result<void> check_phases(const BodeData& measured, const ModelChoice& choice,
                          const schema::Transducer& base) {
  if (choice.finger) return {};
  const BodeData data =
      without_hold(measured, [&](double hz) { return schema::actuator_response(base, hz); });
  const ResponseModel model({choice.direction, false, false, false}, base, data);
  const double left = left_by_grid(model, data);
  if (left < kBadStart) return {};
  std::size_t step = 0;
  const double unturned = left_by_grid(model, without_half_turns(data, step));
  if (step > 0 && unturned < kClearly * left)
    return fail(
        Fault::unsuitable,
        fmt::format(
            "the phase steps by half a turn from {:.4g} to {:.4g} Hz where the amplitude does not fall: it "
            "was unwrapped wrongly",
            data.frequency_hz[step - 1], data.frequency_hz[step]),
        data.source, "take the phase of the complex ratio (atan2), not of a quotient");
  if (left_by_grid(model, changed(data, [](auto h) { return std::conj(h); })) < kClearly * left)
    return fail(Fault::unsuitable, "the phase grows where a lag must fall: it has the other sign convention",
                data.source, "give --phase-sign -1");
  if (left_by_grid(model, changed(data, [](auto h) { return -h; })) < kClearly * left)
    return fail(Fault::unsuitable, "the response is upside down: a positive drive gives a negative answer",
                data.source, "turn the sensor's polarity round, or give --invert");
  return {};
}

Result<void> check_size(const ResponseFit& fit, const schema::Transducer& base) {
  const bool actuator = fit.data.direction == Direction::actuator;
  const double times = actuator ? fit.transducer.actuator_scale / base.actuator_scale
                                : fit.transducer.sensor_scale / base.sensor_scale;
  if (times < kOtherUnit && times > 1 / kOtherUnit) return {};
  return fail(Fault::unsuitable, "the gain is " + fmt::format(fmt::runtime(unit_words(times)), base.name),
              fit.data.source, "give --amplitude-unit, or --force where the gain is right");
}

}  // namespace tacto::analysis
