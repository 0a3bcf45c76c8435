// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/features/ridge_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tacto::spatial {
namespace {

struct Pair {
  double distance_per_m;
  std::size_t ridge, point;
};

std::vector<Pair> near_pairs(const std::vector<Ridge>& ridges, const std::vector<RidgePoint>& points,
                             double tolerance_per_m) {
  std::vector<Pair> pairs;
  for (std::size_t r = 0; r < ridges.size(); ++r)
    for (std::size_t p = 0; p < points.size(); ++p) {
      const double distance = std::abs(ridges[r].back().frequency_per_m - points[p].frequency_per_m);
      if (distance <= tolerance_per_m) pairs.push_back({distance, r, p});
    }
  std::ranges::sort(pairs, {}, &Pair::distance_per_m);
  return pairs;
}

}  // namespace

RidgeTracker::RidgeTracker(double tolerance_per_m, std::size_t bridge_rows)
    : tolerance_per_m_(tolerance_per_m), bridge_rows_(bridge_rows) {}

void RidgeTracker::end_stale(std::size_t row) {
  const auto stale = [&](const Ridge& ridge) { return row - ridge.back().row > bridge_rows_ + 1; };
  const auto first_stale =
      std::stable_partition(open_.begin(), open_.end(), [&](const Ridge& r) { return !stale(r); });
  std::move(first_stale, open_.end(), std::back_inserter(ended_));
  open_.erase(first_stale, open_.end());
}

void RidgeTracker::add_row(std::size_t row, const std::vector<RidgePoint>& points) {
  end_stale(row);
  std::vector<bool> ridge_used(open_.size(), false);
  std::vector<bool> point_used(points.size(), false);
  for (const Pair& pair : near_pairs(open_, points, tolerance_per_m_)) {
    if (ridge_used[pair.ridge] || point_used[pair.point]) continue;
    ridge_used[pair.ridge] = point_used[pair.point] = true;
    open_[pair.ridge].push_back(points[pair.point]);
  }
  for (std::size_t p = 0; p < points.size(); ++p)
    if (!point_used[p]) open_.push_back({points[p]});
}

std::vector<Ridge> RidgeTracker::finish() {
  std::move(open_.begin(), open_.end(), std::back_inserter(ended_));
  open_.clear();
  return std::move(ended_);
}

}  // namespace tacto::spatial
