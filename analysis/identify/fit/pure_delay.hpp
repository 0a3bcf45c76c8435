// SPDX-License-Identifier: GPL-3.0-or-later
// A measurement that comes late: a delay turns the phase in proportion to frequency, and leaves the
// amplitude.
#pragma once

#include <functional>

#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

struct PureDelay {
  double delay_s = 0;  ///< of the response behind the model
  double left = 0;     ///< what `left_by` says once it is taken out
};

/// The delay within two periods of the highest frequency, either way, without which `left_by` (what a fit of
/// such data leaves) is least: tried at each eighth of a period, then by golden section to a thousandth.
PureDelay best_delay(const BodeData& data, const std::function<double(const BodeData&)>& left_by);

}  // namespace tacto::analysis
