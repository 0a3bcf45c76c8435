// SPDX-License-Identifier: GPL-3.0-or-later
// Ranges that refuse a wrong unit, or a wrong sign of an exponent, in a file's numbers.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// From `lowest` to `highest`, both included; also 0 if `or_zero`.
struct PlausibleRange {
  double lowest, highest;
  bool or_zero = false;

  bool contains(double value) const {
    return (or_zero && value == 0) || (value >= lowest && value <= highest);
  }
};

/// FILE#/member; `where` may already be FILE#/object.
std::string place_of_member(const std::string& where, const std::string& member);

/// Errors: unsuitable, at the member, with its value and the range: "mass_kg is 500: a plausible value is
/// from 0.001 to 100".
Result<void> check_range(const PlausibleRange& range, double value, const std::string& member,
                         const std::string& where, const std::string& remedy = "correct it");

}  // namespace tacto::schema
