// SPDX-License-Identifier: GPL-3.0-or-later
// Recursive filters as a chain of second-order sections, run forwards and backwards so that nothing is
// delayed.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace tacto::spatial {

/// H(z) = (b0 + b1 z^-1 + b2 z^-2) / (1 + a1 z^-1 + a2 z^-2).
struct Section {
  double b0, b1, b2, a1, a2;
  std::complex<double> response(double frequency_hz, double sample_rate_hz) const;
};

/// The chain's complex gain.
std::complex<double> response_of(std::span<const Section> sections, double frequency_hz,
                                 double sample_rate_hz);

/// Samples of odd extension that scipy.signal.sosfiltfilt takes unless told.
std::size_t default_padding(std::span<const Section> sections);

/// The chain at work: transposed direct form II, as many sections at a time as stay in registers.
class SectionChain {
 public:
  explicit SectionChain(std::span<const Section> sections);
  /// As if `value` had been coming in for ever.
  void settle(double value);
  /// In place; the next call goes on where this one ended.
  void run(std::span<double> values);
  /// The same from the last value to the first.
  void run_backwards(std::span<double> values);
  /// Samples after which an input's trace has fallen to `share` of itself, by the slowest pole.
  std::size_t memory(double share) const;

 private:
  struct Delays {
    double z1 = 0, z2 = 0;
  };
  std::vector<Section> sections_;
  std::vector<Delays> delays_;
};

/// Forwards, then backwards: gain |H|^2, no delay. The record is point-mirrored over `padding` samples at
/// each end (fewer where it is shorter), and the sections start in the steady state of the first value, as
/// sosfiltfilt does. Error of order 4 from 15 to 500 Hz at 10 kHz against long double: 1e-12 of the largest
/// value that passes, and of its design 2e-12 (butterworth_test).
std::vector<double> filter_zero_phase(std::span<const Section> sections, std::span<const double> values,
                                      std::size_t padding);

}  // namespace tacto::spatial
