// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/draw/display_unit.hpp"

#include <algorithm>
#include <string_view>

namespace tacto::spatial {
namespace {

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

}  // namespace

DisplayUnit display_unit(const std::string& si_unit, double largest) {
  struct Prefix {
    std::string_view text;
    double worth;
  };
  constexpr Prefix kPrefixes[] = {{"", 1}, {"m", 1e-3}, {"\u00b5", 1e-6}, {"n", 1e-9}};
  if (si_unit == "1") return {"1", 1};
  if (si_unit != "N" && si_unit != "m" && si_unit != "V") return {typeset(si_unit), 1};
  for (const Prefix& prefix : kPrefixes)
    if (largest >= prefix.worth || prefix.text == "n")
      return {std::string(prefix.text) + si_unit, 1 / prefix.worth};
  return {si_unit, 1};
}

std::string typeset(std::string unit) {
  replace_all(unit, "^2", "\u00b2");
  replace_all(unit, "um", "\u00b5m");
  return unit;
}

std::string axis_name(const std::string& quantity) {
  if (quantity.find("force") != std::string::npos) return "force";
  std::string name = quantity;
  std::ranges::replace(name, '_', ' ');
  return name;
}

}  // namespace tacto::spatial
