// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers that are the same on every machine.
#pragma once

#include <cstdint>
#include <random>

namespace tacto::firmware_host {

/// A seeded stream of random numbers; streams of one seed are independent of each other. The standard defines
/// the bits of std::mt19937_64, but not those of the distributions, and the last bit of libm's logarithm
/// depends on the processor. So both transforms here use exact arithmetic only.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream);

  /// Uniform in [0, 1), 53 bits.
  double uniform();
  /// Mean 0, variance 1: the sum of twelve uniform numbers of 16 bits (Irwin-Hall). Magnitude at most 6;
  /// kurtosis 2.9.
  double normal();

 private:
  std::mt19937_64 generator_;
};

}  // namespace tacto::firmware_host
