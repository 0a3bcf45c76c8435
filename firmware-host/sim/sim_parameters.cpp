// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/sim_parameters.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <vector>

#include "data-schema/quantity.hpp"

namespace tacto::firmware_host {
namespace {

using schema::Dimension;
using schema::Fault;
using schema::Result;

// A key whose value is a quantity; whole ones are counts and seeds.
struct Number {
  std::string_view key, meaning;
  Dimension dimension;
  double least, most;
  bool whole;
  void (*store)(SimParameters& p, double value);
};

// A key whose value is a word: one of `choices`, or any where they are empty.
struct Word {
  std::string_view key, meaning;
  std::vector<std::string_view> choices;
  void (*store)(SimParameters& p, std::string_view value);
};

constexpr double kLargestSeed = 0x1p53;  // what a double counts without holes

using P = SimParameters;
constexpr Number kNumbers[] = {
    {"speed", "of the finger, 50mm/s", Dimension::speed, 1e-3, 0.5, false,
     [](P& p, double v) { p.strokes.speed_mps = v; }},
    {"load", "normal force, 0.5N", Dimension::force, 0.01, 3, false, [](P& p, double v) { p.load_n = v; }},
    {"wander", "of speed and load, RMS as a part, 0.1", Dimension::none, 0, 0.3, false,
     [](P& p, double v) { p.strokes.wander = v; }},
    {"strokes", "there, back, there ..., 2", Dimension::none, 0, 1e6, true,
     [](P& p, double v) { p.strokes.strokes = static_cast<int>(v); }},
    {"seed", "of everything random but the ridges, 1", Dimension::none, 0, kLargestSeed, true,
     [](P& p, double v) { p.seed = p.surface.seed = static_cast<std::uint64_t>(v); }},
    {"person", "seed of the finger's ridges, 1", Dimension::none, 0, kLargestSeed, true,
     [](P& p, double v) { p.person = static_cast<std::uint64_t>(v); }},
    {"length", "of the surface, 40mm", Dimension::length, 10e-3, 1, false,
     [](P& p, double v) { p.surface.length_m = v; }},
    {"period", "of sine, triangle and square, 1mm", Dimension::length, 50e-6, 20e-3, false,
     [](P& p, double v) { p.surface.period_m = v; }},
    {"depth", "of the same, peak to valley, 0.1mm", Dimension::length, 0, 1e-3, false,
     [](P& p, double v) { p.surface.depth_m = v; }},
    {"friction", "force over load while sliding, 0.92", Dimension::none, 0.05, 2, false,
     [](P& p, double v) { p.finger.friction = v; }},
    {"static_ratio", "sticking over sliding friction, 1.7", Dimension::none, 1, 3, false,
     [](P& p, double v) { p.finger.static_ratio = v; }},
    {"rate", "of the frames, 10kHz", Dimension::frequency, 1e3, 200e3, false,
     [](P& p, double v) { p.sample_rate_hz = v; }},
    {"encoder_quantum", "length of one count, 1um", Dimension::length, 1e-9, 1e-3, false,
     [](P& p, double v) { p.encoder_quantum_m = v; }},
    {"sensor_gain", "of the piezo, against what the device says, 1", Dimension::none, 0.5, 2, false,
     [](P& p, double v) { p.errors.sensor_gain = v; }},
    {"cell_gain", "of the load cell, likewise, 1", Dimension::none, 0.5, 2, false,
     [](P& p, double v) { p.errors.cell_gain = v; }},
    {"encoder_gain", "counts, likewise, 1", Dimension::none, 0.5, 2, false,
     [](P& p, double v) { p.errors.encoder_gain = v; }},
    {"cell_zero", "what the load cell shows of nothing, 0N", Dimension::force, -1, 1, false,
     [](P& p, double v) { p.errors.cell_zero_n = v; }},
    {"weight", "a known load on the tray, 0N", Dimension::force, 0, 15, false,
     [](P& p, double v) { p.errors.weight_n = v; }},
    {"pull", "a known constant force along +x, 0N", Dimension::force, -10, 10, false,
     [](P& p, double v) { p.errors.pull_n = v; }},
    {"mains", "50 Hz at the piezo's converter, peak, 0V", Dimension::voltage, 0, 5, false,
     [](P& p, double v) { p.errors.mains_v = v; }},
    {"clock_ppm", "how much the device's clock is fast, 0", Dimension::none, -1e5, 1e5, false,
     [](P& p, double v) { p.errors.clock_ppm = v; }},
};

const std::vector<Word>& words() {
  static const std::vector<Word> kWords = {
      {"surface",
       "A, B, C, D, E, flat, sine, triangle or square; C",
       {},
       [](P& p, std::string_view v) { p.surface.name = v; }},
      {"finger",
       "up or down; down",
       {"up", "down"},
       [](P& p, std::string_view v) { p.finger_down = v == "down"; }},
      {"noise", "on or off; on", {"on", "off"}, [](P& p, std::string_view v) { p.noise = v == "on"; }},
      {"transducer",
       "preset or file; wiertlewski2011",
       {},
       [](P& p, std::string_view v) { p.transducer = v; }},
      {"paced",
       "1: no faster than real time; 0",
       {"0", "1"},
       [](P& p, std::string_view v) { p.paced = v == "1"; }},
  };
  return kWords;
}

std::string keys() {
  std::string list;
  for (const Word& word : words()) list += std::string(word.key) + ", ";
  for (const Number& number : kNumbers) list += std::string(number.key) + ", ";
  return list.substr(0, list.size() - 2);
}

std::string where(std::string_view key) {
  return fmt::format("sim:{}", key);
}

std::string shown(double value, Dimension dimension) {
  return dimension == Dimension::none ? fmt::format("{:g}", value) : schema::for_people(value, dimension);
}

Result<void> set(SimParameters& parameters, const Number& number, std::string_view text) {
  const auto value = schema::parse_quantity(text, number.dimension);
  if (!value) return schema::fail(Fault::usage, value.error().what, where(number.key), value.error().remedy);
  const bool fits = *value >= number.least && *value <= number.most;
  if (!fits || (number.whole && *value != std::floor(*value)))
    return schema::fail(
        Fault::usage, fmt::format("'{}' is out of range", text), where(number.key),
        fmt::format("from {} to {}{}", shown(number.least, number.dimension),
                    shown(number.most, number.dimension), number.whole ? ", whole numbers" : ""));
  number.store(parameters, *value);
  return {};
}

Result<void> set(SimParameters& parameters, const Word& word, std::string_view text) {
  bool fits = word.choices.empty() && !text.empty();
  for (const std::string_view choice : word.choices) fits = fits || choice == text;
  if (!fits)
    return schema::fail(Fault::usage, fmt::format("'{}' is no value for it", text), where(word.key),
                        fmt::format("it is: {}", word.meaning));
  word.store(parameters, text);
  return {};
}

Result<void> set_pair(SimParameters& parameters, std::string_view pair, std::set<std::string_view>& seen) {
  const auto equals = pair.find('=');
  if (equals == std::string_view::npos)
    return schema::fail(Fault::usage, fmt::format("'{}' is not key=value", pair),
                        "sim:", "the keys are: " + keys());
  const std::string_view key = pair.substr(0, equals), value = pair.substr(equals + 1);
  if (!seen.insert(key).second) return schema::fail(Fault::usage, "the key comes twice", where(key));
  for (const Number& number : kNumbers)
    if (number.key == key) return set(parameters, number, value);
  for (const Word& word : words())
    if (word.key == key) return set(parameters, word, value);
  return schema::fail(Fault::usage, fmt::format("there is no key '{}'", key),
                      "sim:", "the keys are: " + keys());
}

}  // namespace

Result<SimParameters> parse_sim_parameters(std::string_view text) {
  SimParameters parameters;
  std::set<std::string_view> seen;
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find(','));
    if (const auto done = set_pair(parameters, pair, seen); !done) return schema::forward_error(done);
    text.remove_prefix(std::min(text.size(), pair.size() + 1));
  }
  return parameters;
}

std::string sim_parameters_help() {
  std::string help;
  for (const Word& word : words()) help += fmt::format("  {:<16}{}\n", word.key, word.meaning);
  for (const Number& number : kNumbers) help += fmt::format("  {:<16}{}\n", number.key, number.meaning);
  return help;
}

}  // namespace tacto::firmware_host
