// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a signal's values that an axis shows, so that a single spike does not compress the rest.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tacto::spatial {

struct ShownRange {
  double low = 0, high = 0;
  std::size_t beyond = 0, values = 0;  ///< number of values beyond it, and of all
  double furthest = 0;                 ///< the value beyond it that is furthest from zero
};

/// All finite values, unless a few of them would compress the rest:
/// - brief outliers: if all values span more than three times the middle 99 %, the axis shows that part and a
///   quarter of its width on each side;
/// - onsets: if all values span more than five times the middle 80 %, the axis shows that part and its width
///   on each side. Not if the middle 80 % is 20 times narrower than the middle 99 %, which means a signal
///   that mostly rests.
/// The spans relative to these parts are 1.9 and 3.9 for a million values of Gaussian noise, at most 1.6 and
/// 4.7 for emulated textures, and 5.3 to 11 (the second) for recordings with onsets. So noise and textures
/// are shown completely.
ShownRange shown_range(std::span<const double> values);

/// "0.4 % beyond the axis, to 812 mN": the text in a picture that does not show all values.
std::string out_of_range_text(const ShownRange& range, const std::string& unit);

}  // namespace tacto::spatial
