// SPDX-License-Identifier: GPL-3.0-or-later
// Links the peaks of neighbouring rows to ridges.
#pragma once

#include <vector>

#include "spatial/features/formant_points.hpp"

namespace tacto::spatial {

using Ridge = std::vector<RidgePoint>;

/// Input: rows in order. A point continues the ridge whose last frequency is nearest, nearest pairs first, at
/// most `tolerance_per_m` away. A ridge without a point for more than `bridge_rows` rows ends.
class RidgeTracker {
 public:
  RidgeTracker(double tolerance_per_m, std::size_t bridge_rows);
  void add_row(std::size_t row, const std::vector<RidgePoint>& points);
  /// Ends all ridges and returns them.
  std::vector<Ridge> finish();

 private:
  void end_stale(std::size_t row);

  double tolerance_per_m_;
  std::size_t bridge_rows_;
  std::vector<Ridge> open_, ended_;
};

}  // namespace tacto::spatial
