// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/gain.hpp"

#include <fmt/format.h>

#include <cmath>

#include "data-schema/base/quantity.hpp"

namespace tacto::schema {

Result<Gain> parse_gain(std::string_view text) {
  for (const auto& [suffix, whole] : {std::pair{'x', 1.0}, std::pair{'%', 100.0}}) {
    if (!text.ends_with(suffix)) continue;
    if (const auto factor = parse_quantity(text.substr(0, text.size() - 1), Dimension::none))
      return Gain{*factor / whole, true};
  }
  if (const auto gain = parse_quantity(text, Dimension::compliance)) return Gain{*gain, false};
  return fail(ErrorKind::usage, fmt::format("'{}' is not a gain", text), {},
              fmt::format("give {}", kGainForms));
}

double rounded_down(double value) {
  if (value == 0 || !std::isfinite(value)) return value;
  const double digit = std::pow(10, std::floor(std::log10(std::abs(value))) - 3);
  return std::trunc(value / digit) * digit;
}

std::string gain_in_words(double gain_m_per_n, double default_m_per_n) {
  const std::string gain = fmt::format("{:.4g}mm/N", 1e3 * rounded_down(gain_m_per_n));
  if (default_m_per_n == 0) return gain;
  return fmt::format("{} ({:.4g}x)", gain, rounded_down(gain_m_per_n / default_m_per_n));
}

}  // namespace tacto::schema
