// SPDX-License-Identifier: Apache-2.0
// Messages from the device. Fields are in the order of their bytes; core/WIRE.md describes them.
#pragma once

#include "firmware-host/core/wire/frame.hpp"
#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::wire {

/// Bits of Welcome::features.
enum Feature : uint32_t {
  kFeatureSimulated = 1,    ///< the device is simulated
  kFeatureDrive = 2,        ///< it has an output
  kFeatureEnableInput = 4,  ///< it has a hardware enable input
  kFeatureTextures = 8,     ///< it supports levels, taps, tracking, energy limit and contact gate
  kFeatureHysteresis = 16,  ///< it supports hysteresis
  kFeatureForces = 32,      ///< it has axes with forces, and describes them in `axes`
};

/// All fields up to `nonce` are the same in every version.
struct Welcome {
  static constexpr MessageType kType = MessageType::welcome;
  uint8_t major = kProtocolMajor;
  uint8_t minor = kProtocolMinor;
  uint16_t reserved = 0;
  uint32_t nonce = 0;
  char name[32] = {}, serial[32] = {}, firmware[24] = {};
  uint8_t channels = 0;
  uint8_t notes = 0;
  uint16_t most_sections = 0;
  uint32_t features = 0;
  uint32_t clock_hz = 0;  ///< of device_ticks
  uint32_t default_rate_millihertz = 0, least_rate_millihertz = 0, most_rate_millihertz = 0;
  uint32_t ring_records = 0;     ///< frames or ticks that it stores while the host does not read
  uint32_t profile_samples = 0;  ///< the largest number of samples of a profile
  uint32_t drive_queue = 0;      ///< the capacity of its queue of drive samples
  float drive_limit_v = 0, slew_limit_v_per_s = 0;
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.major, self.minor, self.reserved, self.nonce, self.name, self.serial, self.firmware,
          self.channels, self.notes, self.most_sections, self.features, self.clock_hz,
          self.default_rate_millihertz, self.least_rate_millihertz, self.most_rate_millihertz,
          self.ring_records, self.profile_samples, self.drive_queue, self.drive_limit_v,
          self.slew_limit_v_per_s);
  }
};

/// One channel: physical = code x scale + offset, in `unit`. NaN: the range is not known, or the channel is
/// as fast as the stream.
struct Channel {
  static constexpr MessageType kType = MessageType::channel;
  uint8_t index = 0;
  char name[24] = {}, quantity[24] = {}, unit[8] = {}, source[40] = {};
  double scale = 1, offset = 0, range_min = 0, range_max = 0, native_rate_hz = 0;
  char calibrated[12] = {};  ///< ISO date, or empty
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.index, self.name, self.quantity, self.unit, self.source, self.scale, self.offset,
          self.range_min, self.range_max, self.native_rate_hz, self.calibrated);
  }
};

enum class NoteKind : uint8_t { simulated_by = 0, transducer = 1, surface = 2 };

/// A text about the device, for display and files.
struct Note {
  static constexpr MessageType kType = MessageType::note;
  uint8_t index = 0;
  NoteKind kind = NoteKind::simulated_by;
  char text[512] = {};
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.index, self.kind, self.text);
  }
};

/// The answer to a command, in the order of the commands.
struct Answer {
  static constexpr MessageType kType = MessageType::answer;
  MessageType of = MessageType::hello;
  AnswerCode code = AnswerCode::ok;
  uint16_t reserved = 0;
  uint32_t of_sequence = 0;
  uint32_t detail = 0;
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.of, self.code, self.reserved, self.of_sequence, self.detail);
  }
};

/// Frames first_frame ... first_frame + count - 1 of the stream, without gaps between them. A frame that is
/// missing between two messages was lost on the device or on the link.
struct Samples {
  static constexpr MessageType kType = MessageType::samples;
  uint64_t first_frame = 0;
  uint64_t device_ticks = 0;  ///< the device's clock at first_frame
  uint32_t enabled = 0;       ///< bit i: the enable input was closed at frame first_frame + i
  uint8_t channels = 0;
  uint8_t count = 0;
  uint16_t reserved = 0;
  int32_t codes[kMaxBlockCodes];  ///< frame by frame; left-justified, encoder counts not shifted
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.first_frame, self.device_ticks, self.enabled);
    const size_t channels = codec.count(self.channels, kMaxChannels);
    const size_t frames = codec.count(self.count, kMaxBlockFrames);
    codec(self.reserved);
    codec.array(self.codes, channels * frames);
  }
};

/// One tick of the drive.
struct Tick {
  int32_t encoder = 0;
  float drive_v = 0;
  uint32_t flags = 0;
};

/// Sent while armed: every tick, in the same way as samples.
struct Ticks {
  static constexpr MessageType kType = MessageType::ticks;
  uint64_t first_tick = 0;
  uint64_t device_ticks = 0;
  uint8_t count = 0;
  uint8_t reserved[3] = {};
  Tick ticks[kMaxBlockTicks];
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.first_tick, self.device_ticks);
    const size_t n = codec.count(self.count, kMaxBlockTicks);
    codec.array(self.reserved, sizeof self.reserved);
    for (size_t i = 0; i < n; ++i) {
      auto& t = self.ticks[i];
      codec(t.encoder, t.drive_v, t.flags);
    }
  }
};

/// The device's state. Counters wrap at 2^32. Those from late_ticks to slew_limited begin at hello, the last
/// two when the device starts.
struct Pulse {
  static constexpr MessageType kType = MessageType::pulse;
  uint32_t token = 0;
  uint64_t device_ticks = 0;
  DriveState state = DriveState::idle;
  FaultCode fault = FaultCode::none;  ///< the current fault of the drive
  uint8_t streaming = 0;
  uint8_t enabled = 0;
  int32_t encoder = 0;
  float drive_v = 0;
  uint32_t drive_queued = 0;
  uint32_t late_ticks = 0, lost_records = 0, underruns = 0, amplitude_limited = 0, slew_limited = 0;
  uint32_t damaged_frames = 0, missing_frames = 0;  ///< in the stream from the host
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.token, self.device_ticks, self.state, self.fault, self.streaming, self.enabled, self.encoder,
          self.drive_v, self.drive_queued, self.late_ticks, self.lost_records, self.underruns,
          self.amplitude_limited, self.slew_limited, self.damaged_frames, self.missing_frames);
  }
};

/// Sent without a request, once for each event.
struct Fault {
  static constexpr MessageType kType = MessageType::fault;
  FaultCode code = FaultCode::none;
  uint8_t reserved[3] = {};
  uint32_t detail = 0;
  uint64_t device_ticks = 0;
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.code);
    codec.array(self.reserved, sizeof self.reserved);
    codec(self.detail, self.device_ticks);
  }
};

/// What an axis moves along. Only x and y are in the plane of a scene.
enum class AxisAlong : uint8_t { x = 0, y = 1, z = 2 };

struct Axis {
  AxisAlong along = AxisAlong::x;
  uint8_t reserved[3] = {};
  float peak_n = 0, continuous_n = 0;
  float metres_per_count = 0;   ///< in single precision for small cores
  double from_m = 0, to_m = 0;  ///< its travel
};

/// Sent after the welcome of a device with forces: its axes and its own limits.
struct Axes {
  static constexpr MessageType kType = MessageType::axes;
  uint8_t count = 0;
  uint8_t reserved[3] = {};
  float peak_n = 0, continuous_n = 0;  ///< of the vector
  float slew_n_per_s = 0;              ///< of each axis
  uint32_t scene_bytes = 0;            ///< the largest block of a scene
  Axis axes[kMaxAxes];
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    const size_t n = codec.count(self.count, kMaxAxes);
    codec.array(self.reserved, sizeof self.reserved);
    codec(self.peak_n, self.continuous_n, self.slew_n_per_s, self.scene_bytes);
    for (size_t i = 0; i < n; ++i) {
      auto& a = self.axes[i];
      codec(a.along);
      codec.array(a.reserved, sizeof a.reserved);
      codec(a.peak_n, a.continuous_n, a.metres_per_count, a.from_m, a.to_m);
    }
  }
};

/// Counts and forces of one tick.
struct AxisTick {
  int32_t counts[kMaxAxes] = {};
  float force_n[kMaxAxes] = {};
  uint32_t flags = 0;
};

/// Sent instead of `ticks` while a scene is armed. Of each tick: the counts of all axes, their forces, flags.
struct AxisTicks {
  static constexpr MessageType kType = MessageType::axis_ticks;
  uint64_t first_tick = 0;
  uint64_t device_ticks = 0;
  uint8_t count = 0;
  uint8_t axes = 0;
  uint16_t reserved = 0;
  AxisTick ticks[kMaxBlockTicks];
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.first_tick, self.device_ticks);
    const size_t n = codec.count(self.count, kMaxBlockTicks);
    const size_t axes = codec.count(self.axes, kMaxAxes);
    codec(self.reserved);
    for (size_t i = 0; i < n; ++i) {
      auto& t = self.ticks[i];
      codec.array(t.counts, axes);
      codec.array(t.force_n, axes);
      codec(t.flags);
    }
  }
};

}  // namespace tacto::wire
