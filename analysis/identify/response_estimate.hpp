// SPDX-License-Identifier: GPL-3.0-or-later
// From samples over time to a frequency response with its noise.
#pragma once

#include <span>

#include "analysis/identify/bode_data.hpp"
#include "analysis/identify/device_drive.hpp"
#include "analysis/identify/excitation.hpp"
#include "data-schema/error.hpp"

namespace tacto::analysis {

/// Sums over whole periods of each step: exact for sines that lie on the step's own lines. The noise is the
/// scatter of what is neither the mean nor one of the first five harmonics. Precondition: the tray was driven
/// by `plan`.
BodeData response_of_steps(const DrivenTray& tray, const SteppedSine& plan);

/// Each period by itself, the first left out: mean over mean, the noise from the periods' scatter, averaged
/// over nine neighbouring lines. Precondition: the tray was driven by `plan`.
BodeData response_of_periods(const DrivenTray& tray, const PeriodicDrive& plan);

/// Of two recorded signals of any kind: Welch's cross-spectrum over the input's spectrum, Hann windows of an
/// eighth of the recording (1 s at most) with half overlap, at up to 80 frequencies; the noise by coherence
/// (Bendat and Piersol 2010, eq. 9.89). Frequencies where the coherence is below 0.5 are left out. A response
/// narrower than four times 1 / window is smeared by the window. Errors: unsuitable: too short, or no
/// coherence anywhere.
schema::Result<BodeData> response_of_record(std::span<const double> input, std::span<const double> output,
                                            double rate_hz, double low_hz, double high_hz,
                                            const std::string& source);

}  // namespace tacto::analysis
