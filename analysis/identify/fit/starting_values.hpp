// SPDX-License-Identifier: GPL-3.0-or-later
// Where a fit begins: found in the data, not guessed.
#pragma once

#include <span>
#include <vector>

#include "analysis/identify/fit/response_model.hpp"
#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

/// Values in the parameters' order, and the part of the data's weight that they leave.
struct Start {
  std::vector<double> values;
  double left = 1;  ///< sum |H - model|^2 / sigma^2 over sum |H|^2 / sigma^2
};

/// The best of a grid: 24 resonances evenly by octaves over the band and half an octave around, six damping
/// ratios from 0.005 to 2, seven poles from a quarter of the band's low end to eight times its high end; the
/// gain by linear least squares, above 0. At most 24 of the frequencies are looked at. Precondition:
/// check_bode(data).
Start starting_values(const ResponseModel& model, const BodeData& data);

/// Where a fit of one mode begins: the best of that grid; the base's own parameters, the gain by linear least
/// squares; and poles_of_data(), where they are stable. The first two alone end in false minima, for which a
/// sound table was refused; the third does not, but one value that is off spoils it. A finger's load has the
/// first alone. Precondition: check_bode(data), no second mode.
std::vector<std::vector<double>> one_mode_starts(const ResponseModel& model, const BodeData& data);

/// The same for the second mode, the rest given: 24 frequencies by two damping ratios by four distances of
/// the anti-resonance (10 % and 30 % below and above). The best of each kind: above or below the mode that is
/// given, the anti-resonance above or below its own mode; and, where |H| f has two peaks, the modes there.
/// Precondition: choice().second_mode.
std::vector<Start> second_mode_starts(const ResponseModel& model, const BodeData& data,
                                      std::span<const double> one_mode);

}  // namespace tacto::analysis
