// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/firmware/drive_supervisor.hpp"

namespace tacto::core {

using wire::DriveState;
using wire::FaultCode;

void DriveSupervisor::arm(const wire::Limits& limits, uint32_t rate_millihertz) noexcept {
  watchdog_ticks_ = static_cast<uint32_t>(1e-6F * limits.watchdog_ms * static_cast<float>(rate_millihertz));
  last_heard_ = heard_.load();
  silent_ticks_ = lacking_ticks_ = 0;
  fault_.store(FaultCode::none);
  aim_.store(Aim::hold);
  state_.store(DriveState::armed);
}

// Only the first fault is reported; its consequences are not.
void DriveSupervisor::fail(FaultCode code, uint32_t detail) noexcept {
  if (state_.load() == DriveState::fault) return;
  detail_ = detail;
  fault_.store(code);
  state_.store(DriveState::fault);
}

void DriveSupervisor::watch_host() noexcept {
  const uint32_t heard = heard_.load();
  silent_ticks_ = heard == last_heard_ ? silent_ticks_ + 1 : 0;
  last_heard_ = heard;
  if (silent_ticks_ > watchdog_ticks_) fail(FaultCode::host_silent, silent_ticks_);
}

void DriveSupervisor::watch_drive(bool lacks) noexcept {
  lacking_ticks_ = lacks ? lacking_ticks_ + 1 : 0;
  if (lacking_ticks_ > watchdog_ticks_) fail(FaultCode::drive_underrun, lacking_ticks_);
}

bool DriveSupervisor::observe(const TickObservation& sights) noexcept {
  if (state_.load() == DriveState::idle) return false;
  watch_host();
  if (!sights.enabled) fail(FaultCode::enable_open, 0);
  if (sights.encoder_jump > 0) fail(FaultCode::encoder_jump, sights.encoder_jump);
  const bool target = aim_.load() == Aim::play;
  watch_drive(sights.drive_lacks && target);
  if (state_.load() == DriveState::fault) return false;
  state_.store(target ? DriveState::playing : DriveState::armed);
  return target && !sights.drive_lacks && !sights.blind;
}

void DriveSupervisor::settle(bool sound, bool at_rest) noexcept {
  if (state_.load() == DriveState::idle) return;
  if (!sound) fail(FaultCode::not_a_number, 0);
  if (at_rest && aim_.load() == Aim::off) state_.store(DriveState::idle);
}

}  // namespace tacto::core
