// SPDX-License-Identifier: GPL-3.0-or-later
// From samples over time to a frequency response with its noise.
#pragma once

#include <complex>
#include <vector>

#include "analysis/identify/bode_data.hpp"
#include "analysis/identify/device_drive.hpp"
#include "analysis/identify/excitation.hpp"

namespace tacto::analysis {

/// Sums over whole periods of each step: exact for sines that lie on the step's own lines. The noise is the
/// scatter of what is neither the mean nor one of the first five harmonics. Precondition: the tray was driven
/// by `plan`.
BodeData response_of_steps(const DrivenTray& tray, const SteppedSine& plan);

/// Each period by itself, the first left out: mean over mean, the noise from the periods' scatter, averaged
/// over nine neighbouring lines. Precondition: the tray was driven by `plan`.
BodeData response_of_periods(const DrivenTray& tray, const PeriodicDrive& plan);

/// Noise of no power (an answer without any) still has the rounding of doubles.
double noise_no_less(double noise, std::complex<double> response);

/// Of each value and up to four on either side.
std::vector<double> mean_of_neighbours(const std::vector<double>& squares);
inline constexpr int kFewestNeighbours = 5;  ///< with the value itself, at the ends

}  // namespace tacto::analysis
