// SPDX-License-Identifier: GPL-3.0-or-later
// Units for print: with a prefix that suits the numbers, and raised exponents.
#pragma once

#include <string>

namespace tacto::spatial {

struct DisplayUnit {
  std::string text;   ///< "mN"
  double factor = 1;  ///< from the SI value to this unit
};

/// For values up to `largest`: 0.02 N is shown in mN. Compound units are not changed.
DisplayUnit display_unit(const std::string& si_unit, double largest);

/// "N^2 mm" as "N² mm", "um" as "µm".
std::string typeset(std::string unit);

/// A quantity's name for an axis: "force" for every force, otherwise words instead of underscores.
std::string axis_name(const std::string& quantity);

}  // namespace tacto::spatial
