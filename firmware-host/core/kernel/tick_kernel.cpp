// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/kernel/tick_kernel.hpp"

#include "firmware-host/core/kernel/finite.hpp"

namespace tacto::core {
namespace {
constexpr float kGateS = 0.02F;
}  // namespace

void TickKernel::set(const KernelSetup& setup) noexcept {
  rate_hz_ = setup.rate_hz;
  player_.set(setup.texture, kGainS * rate_hz_);
  fir_.set(setup.taps, setup.tap_count);
  plays_.clear();
  if (setup.hysteresis != nullptr) plays_.set(*setup.hysteresis);
  plays_.rest();
  sections_.set(setup.sections, setup.section_count);
  envelope_.set(setup.limits.onset_s * rate_hz_, setup.limits.release_s * rate_hz_);
  limiter_.set(setup.limits.drive_v, setup.limits.slew_v_per_s / rate_hz_);
  energy_.set(setup.energy_rms_v, setup.energy_window_s * rate_hz_);
  gate_.set(setup.gate_on_n, setup.gate_off_n, kGateS * rate_hz_);
}

TickOutput TickKernel::tick(const TickInput& input) noexcept {
  return drive(player_.target(input.count, input.gain), input.raise, input.normal_force_n);
}

[[gnu::flatten]] TickOutput TickKernel::drive(float target, bool raise, float normal_force_n) noexcept {
  TickOutput output;
  const float filtered = sections_.filter(plays_.follow(fir_.filter(target)));
  output.sound = is_finite(filtered);
  if (!output.sound) {
    fir_.rest();
    plays_.rest();
    sections_.rest();
  }
  const float touch = gate_.step(normal_force_n);
  if (touch < 1) output.flags |= wire::kTickGated;
  if (gate_.touching()) output.flags |= wire::kTickTouching;
  const float weight = envelope_.step(raise && output.sound) * touch;
  output.unlimited_v = output.sound ? filtered * weight : 0;
  output.drive_v = limiter_.limit(energy_.limit(output.unlimited_v, output.flags), output.flags);
  return output;
}

}  // namespace tacto::core
