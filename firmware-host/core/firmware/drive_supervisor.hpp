// SPDX-License-Identifier: Apache-2.0
// Decides when the drive may rise and when it has to fall.
#pragma once

#include "firmware-host/core/kernel/shared.hpp"
#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::core {

/// The largest value of release_s + drive_v / slew_v_per_s in the limits. With the two ticks after a fault,
/// the drive is then at zero within 20 ms at rates from 1 kHz.
inline constexpr float kLongestReleaseS = 0.018F, kLongestOnsetS = 10, kLongestFadeS = 10;

/// The state of the drive that the main loop requests.
enum class Aim : uint8_t { off, hold, play };

/// What a tick observed.
struct TickObservation {
  uint32_t encoder_jump = 0;  ///< counts; 0: none
  bool enabled = false;
  bool drive_lacks = false;  ///< no drive sample from the host
  bool blind = false;        ///< no encoder count: not a fault, but the drive falls
};

/// States and transitions (idle: no output; armed: zero; playing; fault: ramping, or at zero):
///   idle -> armed by arm(); armed <-> playing by aim(); armed, playing or fault -> idle by aim(off), once at
///   rest; armed or playing -> fault by a silent host, an open enable input, an encoder jump, drive
///   samples that are missing for the watchdog's time, a drive that is not finite.
/// The main loop calls arm(), aim() and heard(); the tick calls the other functions.
class DriveSupervisor {
 public:
  /// Only in idle.
  void arm(const wire::Limits& limits, uint32_t rate_millihertz) noexcept;
  void aim(Aim aim) noexcept { aim_.store(aim); }
  Aim aim() const noexcept { return aim_.load(); }
  /// An intact frame has arrived from the host.
  void heard() noexcept { heard_.store(heard_.load() + 1); }
  wire::DriveState state() const noexcept { return state_.load(); }
  wire::FaultCode fault() const noexcept { return fault_.load(); }
  uint32_t fault_detail() const noexcept { return detail_; }

  /// (tick) Returns true if the drive may rise. In idle nothing happens.
  bool observe(const TickObservation& sights) noexcept;
  /// (tick) After the kernel: whether the drive is finite, and whether it is at rest.
  void settle(bool sound, bool at_rest) noexcept;

 private:
  void fail(wire::FaultCode code, uint32_t detail) noexcept;
  void watch_host() noexcept;
  void watch_drive(bool lacks) noexcept;

  Shared<wire::DriveState> state_{wire::DriveState::idle};
  Shared<Aim> aim_{Aim::off};
  Shared<uint32_t> heard_;
  Shared<wire::FaultCode> fault_{wire::FaultCode::none};
  uint32_t detail_ = 0;
  uint32_t watchdog_ticks_ = 0;
  uint32_t last_heard_ = 0, silent_ticks_ = 0, lacking_ticks_ = 0;
};

}  // namespace tacto::core
