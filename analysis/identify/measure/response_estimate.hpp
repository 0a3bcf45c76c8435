// SPDX-License-Identifier: GPL-3.0-or-later
// From samples over time to a frequency response with its noise.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "analysis/identify/measure/bode_data.hpp"
#include "analysis/identify/measure/device_drive.hpp"
#include "analysis/identify/measure/excitation.hpp"

namespace tacto::analysis {

/// (2 / n) sum x exp(-i w t), w in turns a sample: the amplitude of a sine that x holds whole periods of.
std::complex<double> amplitude_of(std::span<const double> x, double turns_per_sample);

/// The samples of a drive that one frequency is measured on: whole periods, from `first` on; before it, from
/// `begin` on, the drive is the same and settles.
struct MeasuredLine {
  std::size_t begin = 0, first = 0, count = 0;
  double turns_per_sample = 0;
  std::size_t end() const { return first + count; }
};
std::vector<MeasuredLine> lines_of(const SteppedSine& plan, double rate_hz);
std::vector<MeasuredLine> lines_of(const PeriodicDrive& plan);

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
