// SPDX-License-Identifier: GPL-3.0-or-later
// A budget: the largest error with which the cheapest measured choice is taken.
#pragma once

#include <optional>

namespace tacto::schema {

/// fast: an error of at most 1 %; balanced: 0.1 %; exact: the smallest error, at any cost.
enum class Quality { fast, balanced, exact };

struct Budget {
  std::optional<Quality> quality;
  std::optional<double> max_error;  ///< RMS of the error, re the RMS of the exact result; before the quality

  bool asked() const { return quality || max_error; }
  bool most_exact() const { return !max_error && quality == Quality::exact; }
  /// The largest error; infinite if the most exact choice was asked for, or nothing.
  double most_error() const {
    constexpr double kFast = 1e-2, kBalanced = 1e-3, kNone = 1e300;
    if (max_error) return *max_error;
    if (!quality || *quality == Quality::exact) return kNone;
    return *quality == Quality::fast ? kFast : kBalanced;
  }
};

}  // namespace tacto::schema
