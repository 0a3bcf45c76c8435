// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "analysis/design/boundary.hpp"
#include "analysis/design/design.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/report/value_text.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/prepare/scene/stable_scene.hpp"

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
  const char* key;  // with the ending of its unit
  bool raised;
  double end;
  double& (*of)(LoadedLoop& on);
};

std::vector<LoopNumber> loop_numbers(const JudgedLoop& loop, const VirtualLoad& load, Holder judged) {
  std::vector<LoopNumber> numbers;
  if (load.stiffness_n_per_m > 0 || load.bodies.empty())
    numbers.push_back({"stiffness", "_n_per_m", false, 1e-6,
                       [](LoadedLoop& on) -> double& { return on.load.stiffness_n_per_m; }});
  if (load.bodies.size() == 1) {
    numbers.push_back({"stiffness of the body", "_n_per_m", false, 1e-6,
                       [](LoadedLoop& on) -> double& { return on.load.bodies.front().stiffness_n_per_m; }});
    numbers.push_back({"damping of the body", "_n_s_per_m", true, 1e4,
                       [](LoadedLoop& on) -> double& { return on.load.bodies.front().damping_n_s_per_m; }});
  }
  const LoopNumber dampings[] = {{"viscous friction of the device", "_n_s_per_m", true, 1e5,
                                  [](LoadedLoop& on) -> double& { return on.loop.axis.viscous_n_s_per_m; }},
                                 {"damper of the scene", "_n_s_per_m", true, 1e4,
                                  [](LoadedLoop& on) -> double& { return on.load.damping_n_s_per_m; }}};
  numbers.insert(numbers.end(), std::begin(dampings), std::end(dampings));
  if (loop.delay_s > 0)
    numbers.push_back({"delay", "_s", false, 1e-6 * loop.period_s,
                       [](LoadedLoop& on) -> double& { return on.loop.delay_s; }});
  if (is_proof(judged))
    numbers.push_back({"encoder step", "_m", false, 1e-12,
                       [](LoadedLoop& on) -> double& { return on.loop.axis.encoder_step_m; }});
  return numbers;
}

Remedy changed_alone(const LoopNumber& number, LoadedLoop changed, Holder judged) {
  double& value = number.of(changed);
  const double now = value;
  const auto good = [&](double tried) {
    value = tried;
    return changed.loop.carries(judged, changed.load);
  };
  const auto words = [&](double of) { return cli::cell_text(number.key, of); };
  constexpr double kLeast = 1e-3;  // N s/m: where a search upwards from 0 begins
  const double needed = number.raised ? first_above(std::max(now, kLeast), number.end, good).value_or(0)
                        : now > 0     ? last_good(now, number.end, now, good)
                                      : 0;
  if (needed <= 0) return {number.name, words(now), "none suffices", std::nullopt};
  value = needed;
  return {number.name, words(now), (number.raised ? "above " : "below ") + words(needed),
          changed.loop.limit(judged, changed.load)};
}

// The lowest higher rate of the device that suffices.
Remedy raised_rate(const JudgedLayer& layer, const DesignRequest& request) {
  const auto words = [](double rate_hz) { return schema::for_people(rate_hz, Dimension::frequency); };
  for (const double rate_hz : request.device.rates_hz) {
    JudgedLoop loop = layer.loop;
    loop.period_s = 1 / rate_hz;
    if (rate_hz <= request.rate_hz || loop.timing().delay_ticks > kMostDelayTicks) continue;
    if (loop.carries(request.judged, layer.total))
      return {"rate", words(request.rate_hz), words(rate_hz), loop.limit(request.judged, layer.total)};
  }
  const double period_s = layer.loop.greatest_period_s(request.judged, layer.total);
  return {"rate", words(request.rate_hz),
          period_s > 0 ? fmt::format("above {}, which the device does not have", words(1 / period_s))
                       : "none suffices",
          std::nullopt};
}

// Of grooves: the sigma of the filter that smooths their profile.
std::optional<Remedy> wider_filter(const JudgedLayer& layer, const schema::ForceLayer& of,
                                   const DesignRequest& request) {
  std::optional<Remedy> remedy;
  of.visit(
      [&](const schema::GroovesLayer& grooves) {
        VirtualLoad load = layer.total;
        const auto good = [&](double filter_m) {
          schema::GroovesLayer tried = grooves;
          tried.filter_m = schema::LayerNumber{filter_m};
          load.stiffness_n_per_m = layer.total.stiffness_n_per_m - layer.own.stiffness_n_per_m +
                                   playback::local_stiffness_n_per_m(tried);
          return layer.loop.carries(request.judged, load);
        };
        const auto words = [](double filter_m) { return cli::cell_text("_m", filter_m); };
        const double now_m = grooves.filter_m->value, period_m = grooves.period_m.value;
        const auto needed_m = first_above(std::max(now_m, 1e-3 * period_m), period_m, good);
        remedy = {"filter of the grooves", words(now_m), "none suffices", std::nullopt};
        if (!needed_m) return;
        remedy->needed = "above " + words(*needed_m);
        remedy->limit_n_per_m = layer.loop.limit(request.judged, layer.total);
      },
      [](const auto& /*other*/) {});
  return remedy;
}

// The damper that `adaptive` of all layers there would add; it is computed for nothing held, or for the hand.
Remedy adaptive_viscosity(const JudgedLayer& layer, const DesignRequest& request) {
  const char* const name = "adaptive viscosity";
  VirtualLoad with = layer.total;
  const double damping = with.damping_n_s_per_m;
  const auto added = playback::added_damping({with.stiffness_n_per_m, damping, damping}, request.device,
                                             request.rate_hz, request.hand);
  if (!added) return {name, "none", "none suffices: " + added.error().what, std::nullopt};
  with.damping_n_s_per_m += *added;
  if (!layer.loop.carries(request.judged, with)) return {name, "none", "none suffices", std::nullopt};
  return {name, "none", "adds " + cli::cell_text("_n_s_per_m", *added),
          layer.loop.limit(request.judged, with)};
}

}  // namespace

std::vector<Remedy> remedies_for(const JudgedLayer& layer, const schema::ForceLayer& of,
                                 const DesignRequest& request) {
  std::vector<Remedy> remedies = {raised_rate(layer, request)};
  for (const LoopNumber& number : loop_numbers(layer.loop, layer.total, request.judged))
    remedies.push_back(changed_alone(number, {layer.loop, layer.total}, request.judged));
  if (auto filter = wider_filter(layer, of, request)) remedies.push_back(std::move(*filter));
  remedies.push_back(adaptive_viscosity(layer, request));
  return remedies;
}

}  // namespace tacto::analysis
