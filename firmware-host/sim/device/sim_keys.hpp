// SPDX-License-Identifier: GPL-3.0-or-later
// The keys of the emulated device.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "data-schema/base/quantity.hpp"
#include "firmware-host/sim/device/sim_parameters.hpp"

namespace tacto::firmware_host {

/// A key whose value is a quantity; whole ones are counts and seeds. `meaning` ends with the default.
struct NumberKey {
  std::string_view key, meaning;
  schema::Dimension dimension;
  double least, most;
  bool whole;
  void (*store)(SimParameters& p, double value);
};

/// A key whose value is a word: one of `choices`, or any word if there are no choices.
struct WordKey {
  std::string_view key, meaning;
  std::vector<std::string_view> choices;
  void (*store)(SimParameters& p, std::string_view value);
};

std::span<const NumberKey> sim_number_keys();
std::span<const WordKey> sim_word_keys();

}  // namespace tacto::firmware_host
