// SPDX-License-Identifier: GPL-3.0-or-later
// The one-mode model in the form of a response: a gain over three poles.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/identify/fit/response_model.hpp"
#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

/// Gain, resonance, damping and pole by linear least squares of H D = N, where D is a cubic in i f and N the
/// gain (for a sensor times f), reweighted with the previous D: Sanathanan, Koerner 1963. It needs no start,
/// so it has no false minimum. Returns nothing if a pole is unstable, as noise or an outlier can cause.
/// Precondition: check_bode(data).
std::optional<std::vector<double>> poles_of_data(const BodeData& data);

/// An overdamped mode and the pole are three real poles, and no response determines which of them is the
/// electrical pole. Returns the other two parameter sets of the same response, the lower pole first; values
/// behind the pole do not change. Empty if the mode is not overdamped.
std::vector<std::vector<double>> other_splits(Direction direction, std::span<const double> values);

}  // namespace tacto::analysis
