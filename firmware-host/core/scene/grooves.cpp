// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/grooves.hpp"

#include "firmware-host/core/scene/turn.hpp"

namespace tacto::core {
namespace {

constexpr float kTurn = 6.2831853F;

uint32_t held_harmonics(const Grooves& grooves, float periods_per_tick) noexcept {
  uint32_t held = grooves.harmonics;
  while (held > 0 && static_cast<float>(held) * periods_per_tick >= kZeroPerTick) --held;
  return held;
}

}  // namespace

GrooveSample groove_at(const Grooves& grooves, uint32_t phase, float periods_per_tick) noexcept {
  const SineCosine turn = sine_cosine(phase);
  const float twice = 2 * turn.cosine;
  // Clenshaw: one pair of states for the cosines' sum, one for the sines' of its derivative.
  float c1 = 0, c2 = 0, s1 = 0, s2 = 0;
  for (uint32_t n = held_harmonics(grooves, periods_per_tick); n > 0; --n) {
    const auto order = static_cast<float>(n);
    const float amplitude = grooves.amplitude[n - 1] * held_by_rate(order * periods_per_tick);
    const float c = amplitude + twice * c1 - c2, s = order * amplitude + twice * s1 - s2;
    c2 = c1;
    c1 = c;
    s2 = s1;
    s1 = s;
  }
  return {c1 * turn.cosine - c2, -kTurn * s1 * turn.sine};
}

}  // namespace tacto::core
