// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "analysis/design/boundary.hpp"
#include "analysis/design/design.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;

struct LoadedLoop {
  JudgedLoop loop;
  VirtualLoad load;
};

// A number that is raised or lowered until the loop is stable. Searched up to or down to `end`.
struct LoopNumber {
  const char* name;
  double now;
  bool raised;
  double end;
  void (*set)(LoadedLoop& on, double value);
  std::string (*words)(double value);
};

std::string loop_damping_words(double n_s_per_m) {
  return fmt::format("{:.4g} N s/m", n_s_per_m);
}

std::vector<LoopNumber> loop_numbers(const JudgedLayer& layer, Holder judged) {
  const JudgedLoop& loop = layer.loop;
  std::vector<LoopNumber> numbers = {
      {"stiffness", layer.total.stiffness_n_per_m, false, 1e-6,
       [](LoadedLoop& on, double value) { on.load.stiffness_n_per_m = value; },
       [](double value) { return fmt::format("{:.4g} N/m", value); }},
      {"viscous friction of the device", loop.axis.viscous_n_s_per_m, true, 1e5,
       [](LoadedLoop& on, double value) { on.loop.axis.viscous_n_s_per_m = value; }, loop_damping_words},
      {"damper of the scene", layer.total.damping_n_s_per_m, true, 1e4,
       [](LoadedLoop& on, double value) { on.load.damping_n_s_per_m = value; }, loop_damping_words}};
  if (loop.delay_s > 0)
    numbers.push_back({"delay", loop.delay_s, false, 1e-6 * loop.period_s,
                       [](LoadedLoop& on, double value) { on.loop.delay_s = value; },
                       [](double value) { return schema::for_people(value, Dimension::time); }});
  if (is_proof(judged))
    numbers.push_back({"encoder step", loop.axis.encoder_step_m, false, 1e-12,
                       [](LoadedLoop& on, double value) { on.loop.axis.encoder_step_m = value; },
                       [](double value) { return schema::for_people(value, Dimension::length); }});
  return numbers;
}

Remedy changed_alone(const LoopNumber& number, const LoadedLoop& from, Holder judged) {
  const auto with = [&](double value) {
    LoadedLoop changed = from;
    number.set(changed, value);
    return changed;
  };
  const auto good = [&](double value) {
    const LoadedLoop changed = with(value);
    return changed.loop.carries(judged, changed.load);
  };
  constexpr double kLeast = 1e-3;  // N s/m: where a search upwards from 0 begins
  const double needed = number.raised
                            ? first_above(std::max(number.now, kLeast), number.end, good).value_or(0)
                        : number.now > 0 ? last_good(number.now, number.end, number.now, good)
                                         : 0;
  if (needed <= 0) return {number.name, number.words(number.now), "none suffices", std::nullopt};
  const LoadedLoop changed = with(needed);
  return {number.name, number.words(number.now), (number.raised ? "above " : "below ") + number.words(needed),
          changed.loop.limit(judged, changed.load.damping_n_s_per_m)};
}

// The lowest higher rate of the device that suffices.
Remedy raised_rate(const JudgedLayer& layer, const DesignRequest& request) {
  const auto words = [](double rate_hz) { return schema::for_people(rate_hz, Dimension::frequency); };
  for (const double rate_hz : request.device.rates_hz) {
    JudgedLoop loop = layer.loop;
    loop.period_s = 1 / rate_hz;
    if (rate_hz <= request.rate_hz || loop.timing().delay_ticks > kMostDelayTicks) continue;
    if (loop.carries(request.judged, layer.total))
      return {"rate", words(request.rate_hz), words(rate_hz),
              loop.limit(request.judged, layer.total.damping_n_s_per_m)};
  }
  const double period_s = layer.loop.greatest_period_s(request.judged, layer.total);
  return {"rate", words(request.rate_hz),
          period_s > 0 ? fmt::format("above {}, which the device does not have", words(1 / period_s))
                       : "none suffices",
          std::nullopt};
}

}  // namespace

std::vector<Remedy> remedies_for(const JudgedLayer& layer, const DesignRequest& request) {
  std::vector<Remedy> remedies = {raised_rate(layer, request)};
  for (const LoopNumber& number : loop_numbers(layer, request.judged))
    remedies.push_back(changed_alone(number, {layer.loop, layer.total}, request.judged));
  return remedies;
}

}  // namespace tacto::analysis
