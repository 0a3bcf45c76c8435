// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/random.hpp"

namespace tacto::firmware_host {
namespace {

// 2^64 over the golden ratio, so that the states of neighbouring streams and seeds differ widely.
constexpr std::uint64_t kStreamStep = 0x9E3779B97F4A7C15U;

int sum_of_halves(std::uint64_t word) {
  int sum = 0;
  for (int i = 0; i < 4; ++i, word >>= 16) sum += static_cast<int>(word & 0xFFFFU);
  return sum;
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream) : generator_(seed + kStreamStep * (stream + 1)) {}

double Random::uniform() {
  return static_cast<double>(generator_() >> 11) * 0x1p-53;
}

double Random::normal() {
  constexpr int kMeanOfSum = 12 * 65535 / 2;
  int sum = -kMeanOfSum;
  for (int i = 0; i < 3; ++i) sum += sum_of_halves(generator_());
  return static_cast<double>(sum) * 0x1p-16;
}

}  // namespace tacto::firmware_host
