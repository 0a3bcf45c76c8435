// SPDX-License-Identifier: Apache-2.0
// The numbers of the protocol: types, states, answers and faults. A number is never reused.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace tacto::wire {

/// Below 0x80 from the host, above from the device. hello and welcome begin with the same fields in every
/// version.
enum class MessageType : uint8_t {
  hello = 0x01,
  stream_start = 0x02,
  stream_stop = 0x03,
  limits = 0x04,
  profile_begin = 0x05,
  profile_chunk = 0x06,
  profile_end = 0x07,
  filters = 0x08,
  gain = 0x09,
  sweep = 0x0A,
  arm = 0x0B,
  play = 0x0C,
  stop = 0x0D,
  disarm = 0x0E,
  drive = 0x0F,
  heartbeat = 0x10,
  reset = 0x11,
  profile_levels = 0x12,
  taps = 0x13,
  tracking = 0x14,
  energy = 0x15,
  contact = 0x16,
  change = 0x17,
  hysteresis = 0x18,
  force_limits = 0x19,
  scene_part = 0x1A,
  set = 0x1B,
  move = 0x1C,
  raise = 0x1D,
  welcome = 0x81,
  channel = 0x82,
  note = 0x83,
  answer = 0x84,
  samples = 0x85,
  ticks = 0x86,
  pulse = 0x87,
  fault = 0x88,
  axes = 0x89,
  axis_ticks = 0x8A,
};

/// The state of the drive.
enum class DriveState : uint8_t {
  idle = 0,   ///< no output
  armed = 1,  ///< ticking, drive at zero
  playing = 2,
  fault = 3,  ///< ramping to zero, or at zero; disarm ends it
};

/// The source of the drive.
/// A scene gives forces of the axes instead of a drive.
enum class DriveSource : uint8_t { profile = 0, host = 1, sweep = 2, scene = 3 };

/// The values beyond the ends of a profile.
enum class ProfileEnds : uint8_t { stop = 0, loop = 1, mirror = 2 };

/// The interpolation between the samples of a profile.
enum class Interpolation : uint8_t { nearest = 0, linear = 1, hermite = 2, sinc = 3 };

/// A device's answer to a command.
enum class AnswerCode : uint8_t {
  ok = 0,
  unknown_type = 1,
  bad_payload = 2,    ///< too short, or a count above its maximum
  bad_value = 3,      ///< a value out of range or not a number; detail: the field, from 0
  wrong_state = 4,    ///< not in this state; detail: the DriveState
  too_large = 5,      ///< more than the capacity of the device; detail: the capacity
  check_failed = 6,   ///< the profile differs from the one that was sent; detail: check of the samples
  incomplete = 7,     ///< no profile, or one with missing samples; detail: samples received
  no_limits = 8,      ///< limits have to be sent first
  enable_open = 9,    ///< the hardware enable input is open
  wrong_version = 10  ///< a major version that this device does not support
};

/// Why a device ramped its drive to zero, or why its stream failed.
enum class FaultCode : uint8_t {
  none = 0,
  host_silent = 1,     ///< no frame from the host for watchdog_ms; detail: ticks of silence
  enable_open = 2,     ///< the hardware enable input opened
  encoder_jump = 3,    ///< more counts in a tick than allowed; detail: counts
  drive_underrun = 4,  ///< no drive sample from the host; detail: ticks without one
  not_a_number = 5,    ///< the filtered drive was not finite
  converter = 6,       ///< a converter gave no sample
  ring_full = 7,       ///< the host did not read the stream; detail: records lost so far
};

/// Bits of a tick's flags.
enum TickFlag : uint32_t {
  kTickEnabled = 1,           ///< the enable input is closed
  kTickPlaying = 2,           ///< state is playing
  kTickFault = 4,             ///< state is fault
  kTickAmplitudeLimited = 8,  ///< the drive was limited to drive_v
  kTickSlewLimited = 16,
  kTickLate = 32,           ///< it began more than half a period late
  kTickEnergyLimited = 64,  ///< the drive was reduced to limit its RMS
  kTickGated = 128,         ///< the finger does not touch: the drive falls
  kTickBlind = 256,     ///< the encoder was not read for 10 ms: the drive falls, then the new count is used
  kTickTouching = 512,  ///< the contact gate detects contact
};
/// From this bit on: the number of steering commands in effect since arming, modulo 256.
inline constexpr uint32_t kTickSteeredShift = 24;
/// Whether this command changes a running drive in a tick; that tick counts it.
constexpr bool steers(MessageType type) noexcept {
  return type == MessageType::gain || type == MessageType::play || type == MessageType::stop ||
         type == MessageType::disarm || type == MessageType::change || type == MessageType::set ||
         type == MessageType::move || type == MessageType::raise;
}

inline constexpr size_t kMaxChannels = 16;
inline constexpr size_t kMaxBlockFrames = 32;
inline constexpr size_t kMaxBlockCodes = kMaxChannels * kMaxBlockFrames;
inline constexpr size_t kMaxBlockTicks = 64;
inline constexpr size_t kMaxChunk = 512;  ///< floats of a profile's or drive's chunk
inline constexpr size_t kMaxSections = 16;
inline constexpr size_t kMaxLevels = 16;  ///< of a profile's pyramid
inline constexpr size_t kMaxTaps = 128;   ///< of the finite filter; a multiple of 16
inline constexpr size_t kMaxPlays = 16;   ///< of hysteresis; a multiple of 4
inline constexpr size_t kMaxAxes = 3;
inline constexpr size_t kMaxScenePart = 512;  ///< bytes

}  // namespace tacto::wire
