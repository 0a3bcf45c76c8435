// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/report/interval_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tacto::analysis {
namespace {

constexpr double kLeastDigits = 5, kMostDigits = 17;  // a double has 17 significant digits

// Decimal exponent of the first digit: 2 for 547.7, -5 for 2e-05.
double place_of(double value) {
  return std::floor(std::log10(std::abs(value)));
}

int digits_of(const FittedParameter& p) {
  const double shows_two = place_of(p.value) - place_of(0.5 * (p.high - p.low)) + 2;
  return static_cast<int>(std::clamp(shows_two, kLeastDigits, kMostDigits));
}

}  // namespace

std::string interval_words(const FittedParameter& p, bool claimed) {
  if (p.held) return fmt::format("{:.5g}, held", p.value);
  if (!claimed) return fmt::format("{:.5g}, without interval", p.value);
  const int digits = digits_of(p);
  return fmt::format("{:#.{}g} ({:#.{}g} to {:#.{}g})", p.value, digits, p.low, digits, p.high, digits);
}

bool interval_is_hidden(const FittedParameter& p, int digits) {
  return fmt::format("{:.{}g}", p.low, digits) == fmt::format("{:.{}g}", p.high, digits);
}

}  // namespace tacto::analysis
