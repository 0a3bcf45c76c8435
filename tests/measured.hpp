// SPDX-License-Identifier: GPL-3.0-or-later
// Figures that tests compute, for tests/MEASURED.md (tests/README.md, "Measured results").
#pragma once

#include <cctype>
#include <cstdio>
#include <string>

namespace tacto {

/// Prints "[measured] KEY VALUE", which tests/measured.py collects. Call it beside the assertion of the same
/// figure. KEY is `<subject>.<figure>_<unit>` of a-z, 0-9, '_' and '.', and unique among all tests.
inline void measured(const std::string& key, double value) {
  std::printf("[measured] %s %.10g\n", key.c_str(), value);
}

/// Says why keys are not printed in this run: KEYS is one key, or ends in '*'.
inline void not_measured(const std::string& keys, const std::string& reason) {
  std::printf("[not measured] %s %s\n", keys.c_str(), reason.c_str());
}

/// Words as a part of a key: "20 kHz, loop" is "20_khz_loop".
inline std::string key_part(const std::string& words) {
  std::string part;
  for (const unsigned char c : words)
    if (std::isalnum(c) != 0)
      part += static_cast<char>(std::tolower(c));
    else if (c != '+' && !part.empty() && part.back() != '_')  // 1e+12 is 1e12, 1e-12 is 1e_12
      part += '_';
  if (part.ends_with('_')) part.pop_back();
  return part;
}

}  // namespace tacto
