// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/offset_drift.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tacto::capture {
namespace {

constexpr std::size_t kFewestOffsets = 4;
constexpr std::size_t kMostPoints = 1000;  // half a million slopes
constexpr double kShortestDrift_s = 10;
constexpr double kNormal95 = 1.959963984540054;  // the normal quantile of 97.5 %

struct OffsetPoint {
  double host_s, device_ahead_s;
};

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

// Relative to the first pair: the hours since the computer was started would cost precision.
std::vector<OffsetPoint> points_of(std::span<const schema::ClockPair> pairs) {
  const std::size_t block = (pairs.size() + kMostPoints - 1) / kMostPoints;
  std::vector<OffsetPoint> points;
  for (std::size_t first = 0; first < pairs.size(); first += block) {
    std::vector<double> host_s, ahead_s;
    for (const schema::ClockPair& pair : pairs.subspan(first, std::min(block, pairs.size() - first))) {
      host_s.push_back(pair.host_s - pairs[0].host_s);
      ahead_s.push_back(pair.device_s - pairs[0].device_s - host_s.back());
    }
    points.push_back({median_of(host_s), median_of(ahead_s)});
  }
  return points;
}

std::vector<double> sorted_slopes(const std::vector<OffsetPoint>& points) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = i + 1; k < points.size(); ++k)
      if (const double step_s = points[k].host_s - points[i].host_s; step_s > 0)
        slopes.push_back((points[k].device_ahead_s - points[i].device_ahead_s) / step_s);
  std::ranges::sort(slopes);
  return slopes;
}

double median_distance(const std::vector<OffsetPoint>& points, double slope) {
  std::vector<double> left;
  for (const OffsetPoint& point : points) left.push_back(point.device_ahead_s - slope * point.host_s);
  const double middle = median_of(left);
  for (double& each : left) each = std::abs(each - middle);
  return median_of(left);
}

}  // namespace

std::optional<OffsetDrift> offset_drift(std::span<const schema::ClockPair> pairs) {
  if (pairs.size() < kFewestOffsets || pairs.back().host_s - pairs.front().host_s < kShortestDrift_s)
    return std::nullopt;
  const auto points = points_of(pairs);
  const auto slopes = sorted_slopes(points);
  const auto n = static_cast<double>(points.size()), count = static_cast<double>(slopes.size());
  const double half_width = kNormal95 * std::sqrt(n * (n - 1) * (2 * n + 5) / 18);
  const auto below = static_cast<std::ptrdiff_t>(std::floor((count - half_width) / 2));
  if (below < 0) return std::nullopt;
  const double slope = median_of(slopes);
  return OffsetDrift{1e6 * slope, 1e6 * slopes[static_cast<std::size_t>(below)],
                     1e6 * slopes[slopes.size() - 1 - static_cast<std::size_t>(below)],
                     median_distance(points, slope)};
}

}  // namespace tacto::capture
