// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/device/sim_parameters.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "data-schema/base/nearest_word.hpp"
#include "data-schema/base/quantity.hpp"
#include "firmware-host/sim/device/sim_keys.hpp"
#include "firmware-host/sim/physics/tray_mechanics.hpp"

namespace tacto::firmware_host {
namespace {

using schema::Dimension;
using schema::ErrorKind;
using schema::Result;

std::vector<std::string> key_names() {
  std::vector<std::string> names;
  for (const WordKey& word : sim_word_keys()) names.emplace_back(word.key);
  for (const NumberKey& number : sim_number_keys()) names.emplace_back(number.key);
  return names;
}

constexpr std::string_view kWhereTheListIs = "'tactograph help sim' lists the keys";

std::string where(std::string_view key) {
  return fmt::format("sim:{}", key);
}

std::string shown(double value, Dimension dimension) {
  return dimension == Dimension::none ? fmt::format("{:g}", value) : schema::for_people(value, dimension);
}

// A value at an end of the range may be outside by a rounding error: 50um is not exactly 50e-6.
double within_rounding(double value, const NumberKey& number) {
  for (const double end : {number.least, number.most})
    if (std::abs(value - end) <= 1e-12 * std::abs(end)) return end;
  return value;
}

Result<void> set(SimParameters& parameters, const NumberKey& number, std::string_view text) {
  const auto value = schema::parse_quantity(text, number.dimension);
  if (!value)
    return schema::fail(ErrorKind::usage, value.error().what, where(number.key), value.error().remedy);
  const double target = within_rounding(*value, number);
  const bool fits = target >= number.least && target <= number.most;
  if (!fits || (number.whole && target != std::floor(target)))
    return schema::fail(
        ErrorKind::usage, fmt::format("'{}' is out of range", text), where(number.key),
        fmt::format("give a value from {} to {}{}", shown(number.least, number.dimension),
                    shown(number.most, number.dimension), number.whole ? ", a whole number" : ""));
  number.store(parameters, target);
  return {};
}

Result<void> set(SimParameters& parameters, const WordKey& word, std::string_view text) {
  bool fits = word.choices.empty() && !text.empty();
  for (const std::string_view choice : word.choices) fits = fits || choice == text;
  if (!fits)
    return schema::fail(ErrorKind::usage, fmt::format("'{}' is not a possible value", text), where(word.key),
                        fmt::format("possible values: {}", word.meaning));
  word.store(parameters, text);
  return {};
}

Result<void> set_pair(SimParameters& parameters, std::string_view pair, std::set<std::string_view>& seen) {
  const auto equals = pair.find('=');
  if (equals == std::string_view::npos)
    return schema::fail(ErrorKind::usage, fmt::format("'{}' is not key=value", pair),
                        "sim:", std::string(kWhereTheListIs));
  const std::string_view key = pair.substr(0, equals), value = pair.substr(equals + 1);
  if (!seen.insert(key).second) return schema::fail(ErrorKind::usage, "the key is given twice", where(key));
  for (const NumberKey& number : sim_number_keys())
    if (number.key == key) return set(parameters, number, value);
  for (const WordKey& word : sim_word_keys())
    if (word.key == key) return set(parameters, word, value);
  return schema::fail(ErrorKind::usage,
                      fmt::format("there is no key '{}'{}", key, schema::did_you_mean(key, key_names())),
                      "sim:", std::string(kWhereTheListIs));
}

// Keys that are only valid together with another key.
struct Detail {
  std::string_view prefix;
  bool (*asked)(const SimParameters& p);
  std::string_view remedy;
};

constexpr Detail kDetails[] = {
    {"force_", [](const SimParameters& p) { return p.known_force; }, "add force=multisine, or another"},
    {"lvdt_", [](const SimParameters& p) { return p.has_lvdt; }, "add position=lvdt"},
    {"cutoff", [](const SimParameters& p) { return p.has_reconstruction; },
     "add reconstruction=butterworth3"},
    {"second_mode_", [](const SimParameters& p) { return p.has_second_mode; }, "add second_mode=800Hz"},
    {"tray_sensor_", [](const SimParameters& p) { return p.has_tray_sensor; }, "add tray_sensor=on"},
    {"finger_load_", [](const SimParameters& p) { return p.has_finger_load; }, "add finger_load=on"},
    {"channels", [](const SimParameters& p) { return p.counter; }, "add source=counter"},
    {"link_buffer", [](const SimParameters& p) { return p.paced; }, "add paced=1"},
};

Result<void> check_details(const SimParameters& parameters, const std::set<std::string_view>& seen) {
  for (const std::string_view key : seen)
    for (const Detail& detail : kDetails)
      if (key.starts_with(detail.prefix) && !detail.asked(parameters))
        return schema::fail(ErrorKind::usage, "the key needs another key", where(key),
                            std::string(detail.remedy));
  return {};
}

Result<void> check_force(const SimParameters& p) {
  if (!p.known_force || p.force.shape == ForceShape::release) return {};
  const bool sine = p.force.shape == ForceShape::sine;
  if (!sine && p.force.low_hz > p.force.high_hz)
    return schema::fail(ErrorKind::usage, "the lower frequency of the force is above the higher one",
                        where("force_low"), "give a force_high of at least force_low");
  if ((sine ? p.force.low_hz : p.force.high_hz) < p.sample_rate_hz / 2) return {};
  return schema::fail(
      ErrorKind::usage, "the frequency of the force is above half the rate",
      where(sine ? "force_low" : "force_high"),
      fmt::format("give a frequency below {}", shown(p.sample_rate_hz / 2, Dimension::frequency)));
}

}  // namespace

TrayPhysics SimParameters::tray() const {
  TrayPhysics physics;
  if (has_second_mode) physics.second_mode = second_mode;
  if (has_finger_load) physics.finger_load = finger_load;
  physics.hysteresis = hysteresis;
  if (has_reconstruction) physics.reconstruction_cutoff_hz = reconstruction_cutoff_hz;
  return physics;
}

Result<void> check_against(const SimParameters& p, const schema::Transducer& transducer,
                           double surface_length_m) {
  if (const auto force = check_force(p); !force) return force;
  const double least_hz = least_second_mode_hz(transducer, p.second_mode);
  if (p.has_second_mode && p.second_mode.frequency_hz < least_hz)
    return schema::fail(ErrorKind::usage, "the second mode is not above the tray's resonance",
                        where("second_mode"),
                        fmt::format("give at least {}", shown(least_hz, Dimension::frequency)));
  if (p.has_lvdt && surface_length_m > p.lvdt.range_m)
    return schema::fail(ErrorKind::usage, "the range of the LVDT is shorter than the surface",
                        where("lvdt_range"),
                        fmt::format("give at least {}", shown(surface_length_m, Dimension::length)));
  return {};
}

Result<SimParameters> parse_sim_parameters(std::string_view text) {
  SimParameters parameters;
  std::set<std::string_view> seen;
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find(','));
    TACTO_TRY(set_pair(parameters, pair, seen));
    text.remove_prefix(std::min(text.size(), pair.size() + 1));
  }
  TACTO_TRY(check_details(parameters, seen));
  if (!seen.contains("surface_seed")) parameters.surface.seed = parameters.seed;
  return parameters;
}

std::string sim_parameters_help() {
  std::string help;
  for (const WordKey& word : sim_word_keys()) help += fmt::format("  {:<24}{}\n", word.key, word.meaning);
  for (const NumberKey& number : sim_number_keys())
    help += fmt::format("  {:<24}{}\n", number.key, number.meaning);
  return help;
}

}  // namespace tacto::firmware_host
