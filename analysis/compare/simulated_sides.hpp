// SPDX-License-Identifier: GPL-3.0-or-later
// Which side of a comparison is simulated.
#pragma once

#include <string>

namespace tacto::analysis {

/// By what A and B are simulated; empty: measured.
struct SimulatedSides {
  std::string a, b;

  bool any() const { return !a.empty() || !b.empty(); }
  bool only_one() const { return a.empty() != b.empty(); }
  /// "by ...", "A by ...; B by ..." or "B by ...; A was measured"; empty if both were measured.
  std::string words() const;
  /// A warning if one side was measured and the other is simulated, else empty.
  std::string warning() const;
  /// The box of a page; empty if both sides were measured.
  std::string box() const;
};

}  // namespace tacto::analysis
