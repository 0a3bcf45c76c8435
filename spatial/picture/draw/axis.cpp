// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/draw/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tacto::spatial {
namespace {

// The smallest of 1, 2, 5 times a power of ten that is at least span / target.
double step_of(double span, int target) {
  const double raw = span / target;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

// With a typographic minus sign (U+2212), and an exponent if there would be too many digits.
std::string label_of(double value, double largest, double step) {
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  const int digits = 1 + static_cast<int>(std::ceil(std::log10(largest / step)));
  const bool plain = largest < 1e6 && decimals <= 5;
  std::string text = plain ? fmt::format("{:.{}f}", value, decimals) : fmt::format("{:.{}g}", value, digits);
  if (text.starts_with('-')) text.replace(0, 1, "\u2212");
  return text;
}

std::vector<Tick> linear_ticks(const Axis& axis, int target) {
  const double step = step_of(axis.high - axis.low, target);
  const double slack = 1e-9 * step;
  const double largest = std::max({std::abs(axis.low), std::abs(axis.high), step});
  std::vector<Tick> ticks;
  for (double n = std::ceil((axis.low - slack) / step); n * step <= axis.high + slack; ++n) {
    const double value = n == 0 ? 0 : n * step;  // avoids "-0"
    ticks.push_back({value, label_of(value, largest, step)});
  }
  return ticks;
}

bool labelled(int digit, double decades) {
  if (digit == 1) return true;
  return decades < 3.2 && (digit == 2 || digit == 5);
}

std::vector<Tick> logarithmic_ticks(const Axis& axis, int target) {
  const double decades = std::log10(axis.high / axis.low);
  if (decades < 0.5) return linear_ticks(axis, target);
  std::vector<Tick> ticks;
  for (double exponent = std::floor(std::log10(axis.low)); exponent <= std::log10(axis.high); ++exponent)
    for (int digit = 1; digit < 10; ++digit) {
      const double value = digit * std::pow(10.0, exponent);
      if (value < axis.low * (1 - 1e-9) || value > axis.high * (1 + 1e-9)) continue;
      ticks.push_back({value, labelled(digit, decades) ? fmt::format("{:.6g}", value) : ""});
    }
  return ticks;
}

}  // namespace

double Axis::place(double v) const {
  const double part =
      scale == AxisScale::linear ? (v - low) / (high - low) : std::log(v / low) / std::log(high / low);
  return at_low + part * (at_high - at_low);
}

double Axis::value(double at) const {
  const double part = (at - at_low) / (at_high - at_low);
  return scale == AxisScale::linear ? low + part * (high - low) : low * std::pow(high / low, part);
}

std::vector<Tick> ticks_of(const Axis& axis, int target) {
  return axis.scale == AxisScale::linear ? linear_ticks(axis, target) : logarithmic_ticks(axis, target);
}

Axis roomy_axis(double low, double high) {
  constexpr double kRoom = 0.04;
  const double least = 1e-9 * std::max(std::abs(low), std::abs(high));
  double room = kRoom * (high - low);
  if (!(high - low > least)) room = low == 0 ? 1 : 0.5 * std::abs(low);
  return {AxisScale::linear, low - room, high + room, 0, 1};
}

}  // namespace tacto::spatial
