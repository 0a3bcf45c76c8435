// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of stylus instruments: settings before the table, printed positions, stated roughness.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/table/source.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::capture {

/// The lines before the header of a table, in UTF-8, without blanks around them and without empty ones.
/// Errors: not_found.
schema::Result<std::vector<std::string>> preamble_of(const Source& source);

/// The unit of the last digit with which numbers were printed, 10^-k: the largest of which all are multiples.
class PrintedDigit {
 public:
  void add(double number);
  double value() const;

 private:
  int decimals_ = 0;
};

/// The even grid x = origin + i pitch whose largest deviation from the positions is the smallest (minimax).
/// Positions of an even grid that were rounded to a digit deviate from it by half of that digit at most, and
/// no other positions do. `x` has at least two.
struct NearestGrid {
  double origin = 0, pitch = 0, deviation = 0;
};
NearestGrid nearest_grid(std::span<const double> x);

/// A roughness that a file states before its table, as "Ra,56.1,nm" or "Rq (um) = 0,312", and that of the
/// heights: Ra is the mean, Rq the root mean square of the distances from their least-squares line (ISO
/// 4287), without a roughness filter.
struct StatedRoughness {
  std::string name;
  double stated_m = 0, computed_m = 0;
  bool agrees = false;  ///< within half of the last stated digit and kRoughnessTolerance
};

/// Instruments take the line as mean or as least squares, and the limits of the evaluation from cursors that
/// are between points.
inline constexpr double kRoughnessTolerance = 0.01;

/// Values without a unit of length are not compared.
std::vector<StatedRoughness> compare_roughness(std::span<const std::string> preamble,
                                               std::span<const double> height_m);

}  // namespace tacto::capture
