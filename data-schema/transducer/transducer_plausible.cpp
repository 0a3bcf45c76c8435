// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/transducer/transducer_plausible.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "data-schema/base/plausible_range.hpp"

namespace tacto::schema {
namespace {

using Range = PlausibleRange;

struct PlausibleMember {
  const char* name;
  double Transducer::*member;
  Range range;
};

// Anchors: Wiertlewski 2011, Table I (82 um, 100 V, 76 kN/m, 6.8 g, 4.5 N s/m, 0.82 uF); bimorphs of
// catalogues (rphotronics.com, MTP: 1.4 to 2.6 mm at 150 to 200 V, 0.1 to 0.2 N/mm, 10 to 120 nF); multilayer
// stacks at the other end (tens of um at 100 V, 10 to 500 N/um, up to some 10 uF). Each range goes at least
// two orders of magnitude beyond what is made, so that it refuses slips of a unit or a sign of an exponent,
// and no transducer.
constexpr PlausibleMember kPlausible[] = {
    // nm of a thin stack to cm of a long bimorph
    {"deflection_m", &Transducer::deflection_m, {1e-9, 0.1}},
    // 5 V of small multilayers to kV of fibre composites
    {"max_voltage_v", &Transducer::max_voltage_v, {0.1, 1e5}},
    // 0.1 N/mm of a long bimorph to 500 N/um of a stack
    {"bender_stiffness_n_per_m", &Transducer::bender_stiffness_n_per_m, {1e-2, 1e9}},
    // a flexure stiffer than any actuator moves nothing; none at all is possible
    {"flexure_stiffness_n_per_m", &Transducer::flexure_stiffness_n_per_m, {1e-6, 1e9, true}},
    // 1 mg, less than any tray, to 100 kg
    {"mass_kg", &Transducer::mass_kg, {1e-6, 100}},
    // damping ratios of 1e-4 to 10 of the stiffnesses and masses above, 2 zeta sqrt(k m), rounded outwards
    {"damping_n_s_per_m", &Transducer::damping_n_s_per_m, {1e-8, 1e7}},
    // pF of a single crystal to mF, beyond the largest stacks
    {"capacitance_f", &Transducer::capacitance_f, {1e-12, 1e-3}},
    // instrumentation amplifiers have 1 to 1e4
    {"sensor_gain", &Transducer::sensor_gain, {1e-6, 1e9}},
    // a shunt to an electrometer's input
    {"sensor_resistance_ohm", &Transducer::sensor_resistance_ohm, {1e-3, 1e14}},
    // a divider to kV from mV
    {"amplifier_gain", &Transducer::amplifier_gain, {1e-4, 1e6}},
    {"amplifier_resistance_ohm", &Transducer::amplifier_resistance_ohm, {1e-4, 1e10}},
    // identified over theoretical; the paper's are 0.53 and 1.28
    {"sensor_scale", &Transducer::sensor_scale, {1e-6, 1e6}},
    {"actuator_scale", &Transducer::actuator_scale, {1e-6, 1e6}},
    {"converter_range_v", &Transducer::converter_range_v, {1e-3, 1e4}},
    // the paper's 25 uN/sqrt(Hz); 1 kN is more than any of them carries
    {"noise_n_per_sqrt_hz", &Transducer::noise_n_per_sqrt_hz, {1e-15, 1e3, true}},
    // at the amplifier's input
    {"drive_limit_v", &Transducer::drive_limit_v, {1e-6, 1e5}},
    {"displacement_limit_m", &Transducer::displacement_limit_m, {1e-9, 1}},
    // a full swing of the largest drive at 100 kHz, and a millionth of a volt in a second
    {"slew_limit_v_per_s", &Transducer::slew_limit_v_per_s, {1e-6, 1e12}},
};

constexpr Range kModeHz{0.1, 1e7};             // the tray's own resonances and filters, wide
constexpr Range kModeDamping{1e-6, 1e3};       // a quartz crystal to a thick fluid
constexpr Range kThresholdV{1e-9, 1e5, true};  // of hysteresis, as the drive
constexpr Range kWeight{1e-9, 1e6, true};

// Single precision ends at 3.4e38, and squares are taken.
constexpr Range kComputable{1e-18, 1e18, true};
// m/V over the band that is played: the inverse's taps are as large as its inverse.
constexpr Range kComputableResponse{1e-18, 1e18};
constexpr std::array kProbedHz = {0.0, 1.0, 10.0, 100.0, 1e3};

// A number of a file, with its name in the file.
struct NamedNumber {
  std::string name;
  double value;
  Range plausible;
};

void add_mode(std::vector<NamedNumber>& numbers, const ModeAbove& mode) {
  numbers.push_back({"second_mode/frequency_hz", mode.frequency_hz, kModeHz});
  numbers.push_back({"second_mode/damping_ratio", mode.damping_ratio, kModeDamping});
  numbers.push_back({"second_mode/zero_hz", mode.zero_hz, kModeHz});
  numbers.push_back({"second_mode/zero_damping_ratio", mode.zero_damping_ratio, kModeDamping});
}

std::vector<NamedNumber> numbers_of(const Transducer& transducer) {
  std::vector<NamedNumber> numbers;
  for (const auto& [name, member, range] : kPlausible) numbers.push_back({name, transducer.*member, range});
  if (transducer.second_mode) add_mode(numbers, *transducer.second_mode);
  if (transducer.reconstruction_cutoff_hz)
    numbers.push_back({"reconstruction_cutoff_hz", *transducer.reconstruction_cutoff_hz, kModeHz});
  if (!transducer.hysteresis) return numbers;
  const auto& [thresholds_v, weights] = *transducer.hysteresis;
  for (std::size_t i = 0; i < thresholds_v.size(); ++i)
    numbers.push_back({fmt::format("hysteresis/thresholds_v/{}", i), thresholds_v[i], kThresholdV});
  for (std::size_t i = 0; i < weights.size(); ++i)
    numbers.push_back({fmt::format("hysteresis/weights/{}", i), weights[i], kWeight});
  return numbers;
}

}  // namespace

Result<void> check_plausible(const Transducer& transducer, const std::string& where) {
  for (const NamedNumber& number : numbers_of(transducer))
    TACTO_TRY(check_range(number.plausible, number.value, number.name, where,
                          "correct it; render, play, explain and trade accept it with --implausible"));
  return {};
}

Result<void> check_computable(const Transducer& transducer, const std::string& where) {
  for (const NamedNumber& number : numbers_of(transducer))
    if (!kComputable.contains(number.value))
      return fail(ErrorKind::unsuitable,
                  fmt::format("{} is {:g}: computations need a value from {:g} to {:g}", number.name,
                              number.value, kComputable.lowest, kComputable.highest),
                  place_of_member(where, number.name), "correct it");
  for (const double hz : kProbedHz)
    if (const double size = std::abs(actuator_response(transducer, hz)); !kComputableResponse.contains(size))
      return fail(
          ErrorKind::unsuitable,
          fmt::format("its members together give {:g} m/V at {:g} Hz, which cannot be used for a computation",
                      size, hz),
          where, "correct them");
  return {};
}

}  // namespace tacto::schema
