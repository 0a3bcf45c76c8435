// SPDX-License-Identifier: GPL-3.0-or-later
// A force that is known at every time, for comparison with the sensor's output.
#pragma once

#include <vector>

namespace tacto::firmware_host {

enum class ForceShape { sine, multisine, chirp, release };

struct ForcePlan {
  ForceShape shape = ForceShape::multisine;
  double amplitude_n = 0.02;  ///< peak of a sine or chirp, and of each tone of a multisine
  double low_hz = 15;         ///< of Wiertlewski 2011's band; a sine's frequency
  double high_hz = 500;
  int tones = 16;      ///< of a multisine
  double sweep_s = 1;  ///< of a chirp: from low to high, then back, and so on; of a release: time of the cut
};

/// sin(2 pi turns), to 1e-15, with the same bits on every machine (unlike libm).
double sine_of_turns(double turns);

/// Newtons along +x:
///   sine       a sin(2 pi low t)
///   multisine  sum over k = 0 ... n - 1 of a sin(2 pi f_k t + pi k^2 / n), f_k = low (high / low)^(k / (n -
///              1)), to the microhertz (phases after Schroeder 1970: a low crest factor)
///   chirp      a sin(2 pi phi(t)), phi' linear from low to high in sweep_s, and back
///   release    a weight on a thread: rises to a by a raised cosine over the first three quarters of sweep_s,
///              and is cut at sweep_s.
class KnownForce {
 public:
  /// 0 < low <= high, at least one tone, sweep_s above 0.
  explicit KnownForce(const ForcePlan& plan);
  double at(double time_s) const;

 private:
  struct Tone {
    double frequency_hz, phase_turns;
  };
  double chirp_turns(double time_s) const;
  double pull_n(double time_s) const;

  ForcePlan plan_;
  std::vector<Tone> tones_;
};

}  // namespace tacto::firmware_host
