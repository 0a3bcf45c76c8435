// SPDX-License-Identifier: GPL-3.0-or-later
// What is played into a transducer to learn what it is.
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

/// One frequency of a stepped sine: whole periods in whole samples, so that harmonics do not leak into each
/// other.
struct SineStep {
  double frequency_hz = 0;
  std::size_t first = 0, settled = 0, end = 0;  ///< samples; measured from `settled` to `end`
};

struct SteppedSine {
  std::vector<float> drive_v;
  std::vector<SineStep> steps;
};

/// Evenly by octaves; each settles for 50 ms and a period, and is measured for 0.2 s and five periods at
/// least. Ends in 50 ms of silence.
SteppedSine stepped_sine(const ExcitationPlan& plan);
/// How long that takes, s, to a sample a step; as if no two steps fell on one.
double stepped_sine_s(const ExcitationPlan& plan);

/// A signal that repeats, and the frequencies that are in it.
struct PeriodicDrive {
  std::vector<float> drive_v;
  std::size_t period = 0, periods = 0;  ///< samples, and how many; the first settles
  std::vector<std::size_t> lines;       ///< multiples of rate / period
};

inline constexpr std::size_t kPeriods = 9;

/// Sines of whole periods in one second, evenly by octaves, phases after Schroeder (1970), scaled to the
/// peak.
PeriodicDrive multisine(const ExcitationPlan& plan);
/// An exponential chirp up in 1 s, over and over; measured at frequencies evenly by octaves.
PeriodicDrive periodic_chirp(const ExcitationPlan& plan);

/// Slow loops of 1 Hz: two at the amplitude (the first wipes out what was before), then one at each of 0.8,
/// 0.6, 0.4 and 0.2 of it, and at 1, 0.7, 0.4 and 0.2 of `small_v` where that is above 0, the largest first.
/// Half cosines from each end to the next, so that no step of speed shakes the tray. Ends in silence.
std::vector<float> slow_loops(double rate_hz, double amplitude_v, double small_v = 0);
inline constexpr double kLoopHz = 1;

}  // namespace tacto::analysis
