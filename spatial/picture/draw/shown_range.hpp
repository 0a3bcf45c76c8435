// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a signal's values that an axis shows, so that one spike does not squash all the rest.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tacto::spatial {

struct ShownRange {
  double low = 0, high = 0;
  std::size_t beyond = 0, values = 0;  ///< how many values lie beyond it, of how many
  double furthest = 0;                 ///< the one of these that is furthest from zero
};

/// All finite values, except where few of them would squash the rest:
/// - brief outliers: where all reach over more than three times the span of the middle 99 %, that span and a
/// quarter
///   of it on either side;
/// - onsets: where all reach over more than five times the span of the middle 80 %, that span once more on
/// either
///   side. Not where the middle 80 % is 20 times narrower than the middle 99 %: that is a signal that mostly
///   rests.
/// A million values of Gaussian noise reach over 1.9 and 3.9 times these spans, emulated textures over at
/// most 1.6 and 4.7, recordings with onsets over 5.3 to 11 times the second: noise and textures are shown
/// whole.
ShownRange shown_range(std::span<const double> values);

/// "0.4 % beyond the axis, to 812 mN": what the picture says where it does not show all.
std::string beyond_words(const ShownRange& range, const std::string& unit);

}  // namespace tacto::spatial
