// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates a frequency response, with its noise, from samples over time.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "analysis/identify/measure/bode_data.hpp"
#include "analysis/identify/measure/device_drive.hpp"
#include "analysis/identify/measure/excitation.hpp"

namespace tacto::analysis {

/// (2 / n) sum x exp(-i w t), w in turns per sample: amplitude of a sine with whole periods in x.
std::complex<double> amplitude_of(std::span<const double> x, double turns_per_sample);

/// exp(-i w t) for successive samples, by a recurrence that is recomputed every 256 samples: exact to 1e-13.
class TurningFactor {
 public:
  explicit TurningFactor(double turns_per_sample);
  std::complex<double> next();

 private:
  double turns_per_sample_;
  std::complex<double> step_, turn_ = 1;
  std::size_t samples_ = 0;
};

/// The samples of a drive for the measurement of one frequency: whole periods, from `first` on. From `begin`
/// to `first` the drive is the same, for settling.
struct MeasuredLine {
  std::size_t begin = 0, first = 0, count = 0;
  double turns_per_sample = 0;
  std::size_t end() const { return first + count; }
};
std::vector<MeasuredLine> lines_of(const SteppedSine& plan, double rate_hz);
std::vector<MeasuredLine> lines_of(const PeriodicDrive& plan);

/// Sums over whole periods of each step: exact for sines at the step's frequency and its harmonics. The noise
/// is the scatter that remains without the mean and the first five harmonics. Precondition: `plan` drove the
/// tray.
BodeData response_of_steps(const DrivenTray& tray, const SteppedSine& plan);

/// Amplitudes of each period without the first: mean over mean, the noise from the scatter of the periods,
/// averaged over nine neighbouring lines. Precondition: `plan` drove the tray.
BodeData response_of_periods(const DrivenTray& tray, const PeriodicDrive& plan);

/// Raises the noise to at least the rounding error, as for an answer without noise.
double noise_no_less(double noise, std::complex<double> response);

/// Mean of each value and up to four neighbours to each side.
std::vector<double> mean_of_neighbours(const std::vector<double>& squares);
inline constexpr int kFewestNeighbours = 5;  ///< including the value itself, at the ends

}  // namespace tacto::analysis
