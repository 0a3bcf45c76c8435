// SPDX-License-Identifier: GPL-3.0-or-later
// The one-mode model as what it is in a response: a gain over three poles.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/identify/fit/response_model.hpp"
#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

/// Gain, resonance, damping and pole by linear least squares of H D = N, D a cubic in i f, N the gain (a
/// sensor's: times f), weighted anew with the D before: Sanathanan, Koerner 1963. No start is asked for, so
/// that there is no false minimum. None where a pole lies on the unstable side, as noise or an outlier can
/// make it. Precondition: check_bode(data).
std::optional<std::vector<double>> poles_of_data(const BodeData& data);

/// An overdamped mode and the pole are three real poles, and no response tells which of them is the pole: the
/// other two ways to write the same response, the lower pole first. Values in the parameters' order, those
/// behind the pole kept. Empty where the mode is not overdamped.
std::vector<std::vector<double>> other_splits(Direction direction, std::span<const double> values);

}  // namespace tacto::analysis
