// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/draw/shown_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tacto::spatial {
namespace {

// A middle part of the values, without `tail` of them on each side. If all values span more than `max_ratio`
// times its width, the axis shows it with a margin of `beside` widths on each side.
struct Middle {
  double tail, max_ratio, beside;
};
constexpr Middle kWithoutOutliers{0.005, 3, 0.25}, kWithoutOnsets{0.1, 5, 1};
constexpr double kRestRatio = 20;

double quantile(std::vector<double>& values, double part) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

struct Span {
  double low = 0, high = 0;
  double width() const { return high - low; }
};

Span middle_of(std::vector<double>& values, const Middle& middle) {
  return {quantile(values, middle.tail), quantile(values, 1 - middle.tail)};
}

Span shown_of(std::vector<double>& values, const Span& all) {
  const auto part = [&](const Span& span, const Middle& middle) -> Span {
    const double room = middle.beside * span.width();
    return {std::max(all.low, span.low - room), std::min(all.high, span.high + room)};
  };
  const Span most = middle_of(values, kWithoutOutliers), body = middle_of(values, kWithoutOnsets);
  if (most.width() > 0 && all.width() > kWithoutOutliers.max_ratio * most.width())
    return part(most, kWithoutOutliers);
  const bool rests = most.width() > kRestRatio * body.width();
  return !rests && all.width() > kWithoutOnsets.max_ratio * body.width() ? part(body, kWithoutOnsets) : all;
}

}  // namespace

ShownRange shown_range(std::span<const double> values) {
  std::vector<double> finite;
  std::ranges::copy_if(values, std::back_inserter(finite), [](double value) { return std::isfinite(value); });
  ShownRange range;
  range.values = finite.size();
  if (finite.empty()) return range;
  const auto [least, most] = std::ranges::minmax(finite);
  const Span shown = shown_of(finite, {least, most});
  range.low = shown.low;
  range.high = shown.high;
  for (const double value : finite) {
    if (value >= range.low && value <= range.high) continue;
    ++range.beyond;
    if (std::abs(value) > std::abs(range.furthest)) range.furthest = value;
  }
  return range;
}

std::string out_of_range_text(const ShownRange& range, const std::string& unit) {
  const double percent = 100 * static_cast<double>(range.beyond) / static_cast<double>(range.values);
  // Without an exponent: 8000 mN.
  const std::string furthest = std::abs(range.furthest) < 1000 ? fmt::format("{:.3g}", range.furthest)
                                                               : fmt::format("{:.0f}", range.furthest);
  return fmt::format("{:.2g} % of the values are beyond the axis, up to {} {}", percent, furthest, unit);
}

}  // namespace tacto::spatial
