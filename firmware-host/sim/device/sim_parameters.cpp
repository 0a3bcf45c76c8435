// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/device/sim_parameters.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/nearest_word.hpp"
#include "data-schema/base/quantity.hpp"
#include "firmware-host/core/wire/message_types.hpp"
#include "firmware-host/sim/physics/tray_mechanics.hpp"

namespace tacto::firmware_host {
namespace {

using schema::Dimension;
using schema::ErrorKind;
using schema::Result;

// A key whose value is a quantity; whole ones are counts and seeds. `meaning` ends with the default.
struct NumberKey {
  std::string_view key, meaning;
  schema::Dimension dimension;
  double least, most;
  bool whole;
  void (*store)(SimParameters& p, double value);
};

// A key whose value is a word: one of `choices`, or any word if there are no choices.
struct WordKey {
  std::string_view key, meaning;
  std::vector<std::string_view> choices;
  void (*store)(SimParameters& p, std::string_view value);
};
using P = SimParameters;

constexpr double kLargestSeed = 0x1p53;  // up to here a double represents every integer

constexpr NumberKey kNumbers[] = {
    {"speed", "of the finger, 50mm/s", Dimension::speed, 1e-3, 0.5, false,
     [](P& p, double v) { p.strokes.speed_mps = v; }},
    {"load", "normal force, 0.5N", Dimension::force, 0.01, 3, false, [](P& p, double v) { p.load_n = v; }},
    {"wander", "variation of speed and load, relative RMS, 0.1", Dimension::none, 0, 0.3, false,
     [](P& p, double v) { p.strokes.wander = v; }},
    {"strokes", "number of strokes, alternately forth and back, 2; when recorded, until the recording ends",
     Dimension::none, 0, 1e6, true, [](P& p, double v) { p.strokes.strokes = static_cast<int>(v); }},
    {"seed",
     "of the surface, the finger's motion and the noise: another seed is another sample; to keep the sample, "
     "give "
     "surface_seed, too; 1",
     Dimension::none, 0, kLargestSeed, true, [](P& p, double v) { p.seed = static_cast<std::uint64_t>(v); }},
    {"surface_seed",
     "of the surface alone: with one surface_seed, another seed is another recording of the same sample; the "
     "value of seed",
     Dimension::none, 0, kLargestSeed, true,
     [](P& p, double v) { p.surface.seed = static_cast<std::uint64_t>(v); }},
    {"person", "seed of the finger's ridges, 1", Dimension::none, 0, kLargestSeed, true,
     [](P& p, double v) { p.person = static_cast<std::uint64_t>(v); }},
    {"length", "of the surface, 40mm", Dimension::length, 10e-3, 1, false,
     [](P& p, double v) { p.surface.length_m = v; }},
    {"period", "of sine, triangle and square, 1mm", Dimension::length, 50e-6, 20e-3, false,
     [](P& p, double v) { p.surface.period_m = v; }},
    {"depth", "of the same surfaces, peak to valley, 0.1mm", Dimension::length, 0, 1e-3, false,
     [](P& p, double v) { p.surface.depth_m = v; }},
    {"friction", "friction force over load while sliding, 0.92", Dimension::none, 0.05, 2, false,
     [](P& p, double v) { p.finger.friction = v; }},
    {"static_ratio", "sticking over sliding friction, 1.7", Dimension::none, 1, 3, false,
     [](P& p, double v) { p.finger.static_ratio = v; }},
    {"rate", "of the frames, 10kHz", Dimension::frequency, 1e3, 200e3, false,
     [](P& p, double v) { p.sample_rate_hz = v; }},
    {"encoder_quantum", "length of one count, 1um", Dimension::length, 1e-9, 1e-3, false,
     [](P& p, double v) { p.encoder_quantum_m = v; }},
    {"sensor_gain", "of the piezo, relative to the reported one, 1", Dimension::none, 0.5, 2, false,
     [](P& p, double v) { p.errors.sensor_gain = v; }},
    {"cell_gain", "of the load cell, relative to the reported one, 1", Dimension::none, 0.5, 2, false,
     [](P& p, double v) { p.errors.cell_gain = v; }},
    {"encoder_gain", "of the counts, relative to the reported one, 1", Dimension::none, 0.5, 2, false,
     [](P& p, double v) { p.errors.encoder_gain = v; }},
    {"cell_zero", "offset of the load cell without load, 0N", Dimension::force, -1, 1, false,
     [](P& p, double v) { p.errors.cell_zero_n = v; }},
    {"weight", "a known load on the tray, 0N", Dimension::force, 0, 15, false,
     [](P& p, double v) { p.errors.weight_n = v; }},
    {"pull", "a known constant force along +x, 0N", Dimension::force, -10, 10, false,
     [](P& p, double v) { p.errors.pull_n = v; }},
    {"mains", "50 Hz at the piezo's converter, peak, 0V", Dimension::voltage, 0, 5, false,
     [](P& p, double v) { p.errors.mains_v = v; }},
    {"clock_ppm", "deviation of the device's clock (positive: fast), 0", Dimension::none, -1e5, 1e5, false,
     [](P& p, double v) { p.errors.clock_ppm = v; }},
    {"lvdt_range", "length of its range, 60mm", Dimension::length, 10e-3, 1, false,
     [](P& p, double v) { p.lvdt.range_m = v; }},
    {"lvdt_bandwidth", "of its low-pass (first order), 200Hz", Dimension::frequency, 1, 5e3, false,
     [](P& p, double v) { p.lvdt.bandwidth_hz = v; }},
    {"lvdt_noise", "RMS, 2um", Dimension::length, 0, 1e-3, false, [](P& p, double v) { p.lvdt.noise_m = v; }},
    {"force_amplitude", "peak; of a multisine, of each tone, 20mN", Dimension::force, 1e-6, 5, false,
     [](P& p, double v) { p.force.amplitude_n = v; }},
    {"force_low", "lowest frequency, or that of a sine, 15Hz", Dimension::frequency, 0.1, 100e3, false,
     [](P& p, double v) { p.force.low_hz = v; }},
    {"force_high", "highest frequency, 500Hz", Dimension::frequency, 0.1, 100e3, false,
     [](P& p, double v) { p.force.high_hz = v; }},
    {"force_tones", "number of tones of a multisine, even in octaves, 16", Dimension::none, 2, 256, true,
     [](P& p, double v) { p.force.tones = static_cast<int>(v); }},
    {"force_sweep", "duration of a chirp from low to high (and back), or time of a release until the cut; 1s",
     Dimension::time, 0.01, 3600, false, [](P& p, double v) { p.force.sweep_s = v; }},
    {"hysteresis", "of the driven bender: width of its loop over its height, 0 (paper: 0.16)",
     Dimension::none, 0, 0.3, false, [](P& p, double v) { p.hysteresis = v; }},
    {"cutoff", "of the filter of reconstruction after the drive's converter, 600Hz", Dimension::frequency, 10,
     5e3, false, [](P& p, double v) { p.reconstruction_cutoff_hz = v; }},
    {"second_mode", "frequency of a second mode of the tray; none (paper: 800Hz)", Dimension::frequency, 100,
     5e3, false, [](P& p, double v) { p.second_mode.frequency_hz = v, p.has_second_mode = true; }},
    {"second_mode_damping", "ratio, of the inner mass alone, 0.03", Dimension::none, 0, 0.5, false,
     [](P& p, double v) { p.second_mode.damping_ratio = v; }},
    {"second_mode_share", "of the moving mass, 0.15", Dimension::none, 0.01, 0.5, false,
     [](P& p, double v) { p.second_mode.mass_share = v; }},
    {"finger_load_compliance", "of the pulp, 1mm/N", Dimension::compliance, 0.1e-3, 10e-3, false,
     [](P& p, double v) { p.finger_load.compliance_m_per_n = v; }},
    {"finger_load_corner", "frequency below which the pulp's spring dominates, above it its damper, 90Hz",
     Dimension::frequency, 10, 1e4, false, [](P& p, double v) { p.finger_load.corner_hz = v; }},
    {"finger_load_mass", "of the pulp, relative to that of the tray, 0.015", Dimension::none, 0, 1, false,
     [](P& p, double v) { p.finger_load.mass_share = v; }},
    {"tray_sensor_noise", "RMS, 20nm", Dimension::length, 0, 1e-5, false,
     [](P& p, double v) { p.tray_sensor_noise_m = v; }},
    {"channels", "of the counter, 4", Dimension::none, 1, wire::kMaxChannels, true,
     [](P& p, double v) { p.channels = static_cast<int>(v); }},
    {"link_buffer", "with paced=1: unread data are lost after this time; never", Dimension::time, 10e-3, 60,
     false, [](P& p, double v) { p.link_buffer_s = v; }},
};

void store_force(P& p, std::string_view word) {
  p.known_force = word != "finger";
  p.force.shape = word == "sine"      ? ForceShape::sine
                  : word == "chirp"   ? ForceShape::chirp
                  : word == "release" ? ForceShape::release
                                      : ForceShape::multisine;
}

std::span<const NumberKey> sim_number_keys() {
  return kNumbers;
}

std::span<const WordKey> sim_word_keys() {
  static const std::string kSurfaceWords = surface_names() + ", or profile:NAME (a texture of heights); C";
  static const std::vector<WordKey> kWords = {
      {"surface", kSurfaceWords, {}, [](P& p, std::string_view v) { p.surface.name = v; }},
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
       "1: in real time; 0: as fast as the computer allows; 0",
       {"0", "1"},
       [](P& p, std::string_view v) { p.paced = v == "1"; }},
      {"position",
       "sensor of the position, encoder or lvdt; encoder",
       {"encoder", "lvdt"},
       [](P& p, std::string_view v) { p.has_lvdt = v == "lvdt"; }},
      {"force",
       "force on the tray: finger, or a known sine, multisine or chirp, or a weight on a thread that is cut "
       "(release); finger",
       {"finger", "sine", "multisine", "chirp", "release"},
       store_force},
      {"reconstruction",
       "none or butterworth3: an analog low-pass of third order between the drive's converter and the "
       "bender's amplifier; none (paper: butterworth3)",
       {"none", "butterworth3"},
       [](P& p, std::string_view v) { p.has_reconstruction = v == "butterworth3"; }},
      {"finger_load",
       "on or off: a resting finger on the driven tray; off",
       {"on", "off"},
       [](P& p, std::string_view v) { p.has_finger_load = v == "on"; }},
      {"tray_sensor",
       "on or off: a channel with the driven tray's displacement; off",
       {"on", "off"},
       [](P& p, std::string_view v) { p.has_tray_sensor = v == "on"; }},
      {"source",
       "physics, or counter: frames that contain their numbers; physics",
       {"physics", "counter"},
       [](P& p, std::string_view v) { p.counter = v == "counter"; }},
  };
  return kWords;
}

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
