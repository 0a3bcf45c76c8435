// SPDX-License-Identifier: GPL-3.0-or-later
// A hand on a force device: a mass on a spring and a damper, about a place that moves (Minsky 1990).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// The hand's force on the device is stiffness (place - x) - damping x' - mass x'', where `place` is the
/// place to which the person moves the hand.
struct Hand {
  std::string name;
  double mass_kg = 0;
  double damping_n_s_per_m = 0;
  double stiffness_n_per_m = 0;
  std::string source;  ///< paper and equation, or measurement; required
  std::string notes;
  std::string extra_json;     ///< members that the schema does not name
  std::string newer_version;  ///< with which it is written again
  std::vector<std::string> unknown_members = {};
};

/// Checks that each number can belong to a hand (the ranges and their origins are in the .cpp). Errors:
/// unsuitable, at `where`#/member, with value and range.
Result<void> check_hand(const Hand& hand, const std::string& where);

/// The names of the hands that come with tactograph.
std::vector<std::string_view> hand_preset_names();

/// By preset name, stem or file (NAME.hand.json). Errors: not_found (with the presets), malformed (also an
/// unknown member, with the nearest known one; in a newer minor version it is kept), unsupported_version;
/// unsuitable: by check_hand.
Result<Hand> read_hand(const std::string& name);

/// NAME.hand.json of a stem or file name; replaces an existing file. Errors: cannot_write; unsuitable: by
/// check_hand and by the schema.
Result<void> write_hand(const std::string& stem, const Hand& hand);

}  // namespace tacto::schema
