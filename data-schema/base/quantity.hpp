// SPDX-License-Identifier: GPL-3.0-or-later
// Physical quantities as people write them ("10mm", "15/mm", "0.5um", "1mm/N"), read into SI and written
// back.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

enum class Dimension {
  length,             ///< m
  time,               ///< s
  frequency,          ///< Hz
  spatial_frequency,  ///< 1/m
  speed,              ///< m/s
  acceleration,       ///< m/s^2
  force,              ///< N
  voltage,            ///< V
  compliance,         ///< m/N
  none,               ///< 1: a plain number, for counts and signals without a unit
  level,              ///< dB
  mass,               ///< kg
  share,              ///< 1, of a whole: for errors
};

/// By definition (3rd CGPM 1901; ISO 80000-3).
inline constexpr double kStandardGravity_mps2 = 9.80665;

/// A unit and its worth in the SI unit of its dimension: "mm" is {length, 1e-3}.
struct Unit {
  std::string_view symbol;
  Dimension dimension;
  double si;
  std::string_view ending =
      {};                  ///< in names of members, columns and reports: "_mn"; empty if it is "_" + symbol
  bool only_read = false;  ///< people may write it; no value is printed in it
};

/// Reads a number with its unit, such as "10mm", "1e-3 m" or "15/mm", to SI.
/// Errors: usage, naming the units that fit, for a bare number, an unknown unit, one of another dimension,
/// NaN, Inf.
Result<double> parse_quantity(std::string_view text, Dimension dimension);

/// Finds a unit by its symbol in any dimension ("N", "um", "mm/s", "1"). "u" and both micro signs are alike.
/// Errors: usage, with the known units.
Result<Unit> parse_unit(std::string_view symbol);

/// The unit with this ending of a name: "N" of "_n", "m/N" of "_m_per_n". nullopt if there is none.
std::optional<Unit> unit_with_ending(std::string_view ending);

/// `key` with the ending of a unit in SI: key_in("rms", "N") is "rms_n". Unchanged for "1" and unknown units.
std::string key_in(std::string_view key, std::string_view symbol);

/// The units people may write for a dimension, for messages and help: "nm, um, mm, cm, m".
std::string units_of(Dimension dimension);

/// The SI symbol of a dimension: "m", "1/m", "1" ...
std::string_view si_symbol(Dimension dimension);

/// A value for people, with the prefix that keeps it between 1 and 1000: 0.0123 m is "12.3 mm". At most 4
/// digits.
std::string for_people(double value_si, Dimension dimension);
inline std::string length_for_people(double metres) {
  return for_people(metres, Dimension::length);
}

}  // namespace tacto::schema
