// SPDX-License-Identifier: GPL-3.0-or-later
// Finds starting values of a fit in the data.
#pragma once

#include <span>
#include <vector>

#include "analysis/identify/fit/response_model.hpp"
#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

/// Values in the order of the parameters, and the share of the data's weight in their residual.
struct Start {
  std::vector<double> values;
  double left = 1;  ///< sum |H - model|^2 / sigma^2 over sum |H|^2 / sigma^2
};

/// The best of a grid: 24 resonances evenly spaced on a logarithmic axis over the band and half an octave
/// around, six damping ratios from 0.005 to 2, seven poles from a quarter of the band's low end to eight
/// times its high end; the gain by linear least squares, above 0. Uses at most 24 of the frequencies.
/// Precondition: check_bode(data).
Start starting_values(const ResponseModel& model, const BodeData& data);

/// Starting points of a fit of one mode: the best of that grid; the base's own parameters, with the gain by
/// linear least squares; and poles_of_data(), if they are stable. The first two alone end in false minima, so
/// that good tables were refused; the third does not, but one outlier spoils it. A finger's load uses only
/// the first. Precondition: check_bode(data), no second mode.
std::vector<std::vector<double>> one_mode_starts(const ResponseModel& model, const BodeData& data);

/// Starting points of a model that extends a fitted one by one of kExtensions; the other parameters have the
/// fitted values. A second mode: 24 frequencies by two damping ratios by four distances of the anti-resonance
/// (10 % and 30 % below and above); the best of each kind: above or below the first mode, anti-resonance
/// above or below its own mode; and, if |H| f has two peaks, modes at the peaks. A delay (steps of an eighth
/// of a period of the highest frequency), a filter's cutoff or a lag: the best three of a grid; without a
/// second mode also with poles_of_data() of the response without them. Precondition: model.choice() is
/// known.choice() and `added`; `values` are those of `known`.
std::vector<Start> extended_starts(const ResponseModel& model, const BodeData& data, const Extension& added,
                                   const ResponseModel& known, std::span<const double> values);

}  // namespace tacto::analysis
