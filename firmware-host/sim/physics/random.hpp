// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers that are the same on every machine.
#pragma once

#include <cstdint>
#include <random>

namespace tacto::firmware_host {

/// A seeded stream of random numbers; streams of one seed are independent of each other. std::mt19937_64 is
/// defined to the bit by the standard, its distributions are not; and libm's logarithm differs in the last
/// bit between processors. So both transforms here use exact arithmetic only.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream);

  /// Even in [0, 1), 53 bits.
  double uniform();
  /// Mean 0, variance 1: the sum of twelve even numbers of 16 bits (Irwin-Hall). Never beyond 6;
  /// kurtosis 2.9.
  double normal();

 private:
  std::mt19937_64 generator_;
};

}  // namespace tacto::firmware_host
