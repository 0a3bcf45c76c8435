// SPDX-License-Identifier: GPL-3.0-or-later
// How exact a result has to be: what the cheapest measured choice is chosen by.
#pragma once

#include <optional>

namespace tacto::schema {

/// fast: 1 % off at most; balanced: 0.1 %; exact: whatever errs least, at any cost.
enum class Quality { fast, balanced, exact };

struct Budget {
  std::optional<Quality> quality;
  std::optional<double> max_error;  ///< RMS of what is off, re the RMS of what is meant; before the quality

  bool asked() const { return quality || max_error; }
  bool most_exact() const { return !max_error && quality == Quality::exact; }
  /// What may be off; infinite where the most exact is meant, or nothing was asked.
  double most_error() const {
    constexpr double kFast = 1e-2, kBalanced = 1e-3, kNone = 1e300;
    if (max_error) return *max_error;
    if (!quality || *quality == Quality::exact) return kNone;
    return *quality == Quality::fast ? kFast : kBalanced;
  }
};

}  // namespace tacto::schema
