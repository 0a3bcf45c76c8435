// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/simulated_sides.hpp"

#include <fmt/format.h>

#include "analysis/page/html.hpp"

namespace tacto::analysis {

std::string SimulatedSides::words() const {
  if (only_one())
    return a.empty() ? fmt::format("B {}; A was measured", b) : fmt::format("A {}; B was measured", a);
  return a == b ? a : fmt::format("A {}; B {}", a, b);
}

std::string SimulatedSides::warning() const {
  if (!only_one()) return "";
  return fmt::format(
      "{} was measured, {} is simulated: a difference can be one between the device and its emulation",
      a.empty() ? "A" : "B", a.empty() ? "B" : "A");
}

std::string SimulatedSides::box() const {
  if (!only_one()) return simulated_box(words());
  return fmt::format("<p class=\"simulated\"><strong>Simulated</strong> {}.</p>\n", escaped(words()));
}

}  // namespace tacto::analysis
