// SPDX-License-Identifier: GPL-3.0-or-later
// Excitation signals for the identification of a transducer.
#pragma once

#include <cstddef>
#include <vector>

namespace tacto::analysis {

struct ExcitationPlan {
  double rate_hz = 10e3;
  double amplitude_v = 0.5;  ///< the drive's peak
  double low_hz = 10, high_hz = 1000;
  std::size_t frequencies = 60;
};

/// One frequency of a stepped sine: a whole number of periods in a whole number of samples, so that harmonics
/// do not leak into each other.
struct SineStep {
  double frequency_hz = 0;
  std::size_t first = 0, settled = 0, end = 0;  ///< samples; the measurement is from `settled` to `end`
};

struct SteppedSine {
  std::vector<float> drive_v;
  std::vector<SineStep> steps;
};

/// Frequencies are evenly spaced on a logarithmic axis. Each step settles for 50 ms plus one period, and is
/// measured for at least 0.2 s and five periods. Ends in 50 ms of silence.
SteppedSine stepped_sine(const ExcitationPlan& plan);
/// Its duration, s, within a sample per step; assumes that no two steps have the same frequency.
double stepped_sine_s(const ExcitationPlan& plan);

/// A periodic signal and its frequencies.
struct PeriodicDrive {
  std::vector<float> drive_v;
  std::size_t period = 0, periods = 0;  ///< samples, and their number; the first period is for settling
  std::vector<std::size_t> lines;       ///< multiples of rate / period
};

inline constexpr std::size_t kPeriods = 9;

/// Sines with whole periods in one second, evenly spaced on a logarithmic axis, with Schroeder's phases
/// (1970), scaled to the peak.
PeriodicDrive multisine(const ExcitationPlan& plan);
/// A rising exponential chirp of 1 s, repeated; measured at frequencies evenly spaced on a logarithmic axis.
PeriodicDrive periodic_chirp(const ExcitationPlan& plan);

/// Slow loops of 1 Hz: two at the amplitude (the first removes the history), then one at each of 0.8, 0.6,
/// 0.4 and 0.2 of it, and, if `small_v` is above 0, at 1, 0.7, 0.4 and 0.2 of `small_v`, the largest first.
/// The drive consists of half cosines from end to end, so that no step of the speed excites the tray. Ends in
/// silence.
std::vector<float> slow_loops(double rate_hz, double amplitude_v, double small_v = 0);
inline constexpr double kLoopHz = 1;

}  // namespace tacto::analysis
