// SPDX-License-Identifier: Apache-2.0
// Messages from the host. Fields are in the order of their bytes; core/WIRE.md describes them.
#pragma once

#include "firmware-host/core/wire/frame.hpp"
#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::wire {

/// A message without fields.
template <MessageType kOf>
struct Bare {
  static constexpr MessageType kType = kOf;
  template <class Codec, class Self>
  static void fields(Codec&, Self&) noexcept {}
};

/// Ends every activity, and requests welcome, channels and notes.
struct Hello {
  static constexpr MessageType kType = MessageType::hello;
  uint8_t major = kProtocolMajor;
  uint8_t minor = kProtocolMinor;
  uint16_t reserved = 0;
  uint32_t nonce = 0;  ///< returned in welcome, to distinguish it from an older one
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.major, self.minor, self.reserved, self.nonce);
  }
};

struct StreamStart {
  static constexpr MessageType kType = MessageType::stream_start;
  uint32_t rate_millihertz = 0;
  uint8_t block_frames = 0;  ///< frames of a samples message, 1 to kMaxBlockFrames
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.rate_millihertz, self.block_frames);
  }
};

using StreamStop = Bare<MessageType::stream_stop>;

/// Required before arming; at most the device's own limits.
struct Limits {
  static constexpr MessageType kType = MessageType::limits;
  float drive_v = 0;
  float slew_v_per_s = 0;
  float onset_s = 0;
  float release_s = 0;  ///< release_s + drive_v / slew_v_per_s is at most kLongestReleaseS
  uint16_t watchdog_ms = 0;
  uint16_t counts_per_tick = 0;  ///< more is an encoder jump
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.drive_v, self.slew_v_per_s, self.onset_s, self.release_s, self.watchdog_ms,
          self.counts_per_tick);
  }
};

/// The texture as target signal (before gain and filters) at equal distances along the encoder.
struct ProfileBegin {
  static constexpr MessageType kType = MessageType::profile_begin;
  uint32_t samples = 0;
  int32_t origin_count = 0;            ///< encoder count at the sample at_origin
  int64_t at_origin_q32 = 0;           ///< sample at origin_count, times 2^32
  uint64_t samples_per_count_q32 = 0;  ///< encoder step over pitch, times 2^32
  ProfileEnds ends = ProfileEnds::stop;
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.samples, self.origin_count, self.at_origin_q32, self.samples_per_count_q32, self.ends);
  }
};

struct ProfileChunk {
  static constexpr MessageType kType = MessageType::profile_chunk;
  uint32_t first = 0;
  uint16_t count = 0;
  float values[kMaxChunk];
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.first);
    const size_t n = codec.count(self.count, kMaxChunk);
    codec.array(self.values, n);
  }
};

struct ProfileEnd {
  static constexpr MessageType kType = MessageType::profile_end;
  uint32_t check = 0;  ///< CRC-32C of all samples' bytes
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.check);
  }
};

/// H(z) = (b0 + b1 z^-1 + b2 z^-2) / (1 + a1 z^-1 + a2 z^-2).
struct Section {
  float b0 = 1, b1 = 0, b2 = 0, a1 = 0, a2 = 0;
};

struct Filters {
  static constexpr MessageType kType = MessageType::filters;
  uint8_t count = 0;
  Section sections[kMaxSections];
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    const size_t n = codec.count(self.count, kMaxSections);
    for (size_t i = 0; i < n; ++i) {
      auto& s = self.sections[i];
      codec(s.b0, s.b1, s.b2, s.a1, s.a2);
    }
  }
};

/// Factor on the profile; may change while playing.
struct Gain {
  static constexpr MessageType kType = MessageType::gain;
  float gain = 0;
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.gain);
  }
};

/// A sine whose frequency grows exponentially, for identification.
struct Sweep {
  static constexpr MessageType kType = MessageType::sweep;
  float amplitude_v = 0;
  uint32_t from_millihertz = 0, to_millihertz = 0;
  uint32_t growth_q32 = 0;  ///< of the frequency per tick, times 2^32: 2^32 ((to / from)^(1 / ticks) - 1)
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.amplitude_v, self.from_millihertz, self.to_millihertz, self.growth_q32);
  }
};

struct Arm {
  static constexpr MessageType kType = MessageType::arm;
  DriveSource source = DriveSource::profile;
  uint32_t rate_millihertz = 0;
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.source, self.rate_millihertz);
  }
};

using Play = Bare<MessageType::play>;
using Stop = Bare<MessageType::stop>;
using Disarm = Bare<MessageType::disarm>;

/// The drive of the next ticks, if the host closes the loop. Not answered.
struct Drive {
  static constexpr MessageType kType = MessageType::drive;
  uint16_t count = 0;
  float drive_v[kMaxChunk];
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    const size_t n = codec.count(self.count, kMaxChunk);
    codec.array(self.drive_v, n);
  }
};

/// Answered by a pulse. Every intact frame resets the watchdog; a heartbeat is sent if there is no other
/// frame.
struct Heartbeat {
  static constexpr MessageType kType = MessageType::heartbeat;
  uint32_t token = 0;
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.token);
  }
};

using Reset = Bare<MessageType::reset>;

/// The samples of the profile are levels of decreasing detail, one after the other.
struct ProfileLevels {
  static constexpr MessageType kType = MessageType::profile_levels;
  uint8_t levels = 1;
  Interpolation interpolation = Interpolation::hermite;
  uint16_t reserved = 0;
  uint32_t first_samples = 0;  ///< of the first level
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.levels, self.interpolation, self.reserved, self.first_samples);
  }
};

/// A finite impulse response filter between profile and filters.
struct Taps {
  static constexpr MessageType kType = MessageType::taps;
  uint16_t count = 0;
  float taps[kMaxTaps];
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    const size_t n = codec.count(self.count, kMaxTaps);
    codec.array(self.taps, n);
  }
};

struct HysteresisPlay {
  float threshold = 0, weight = 0;
};

/// Play operators between taps and filters; they invert the bender's hysteresis.
struct Hysteresis {
  static constexpr MessageType kType = MessageType::hysteresis;
  uint8_t count = 0;
  uint8_t reserved[3] = {};
  float straight = 1;  ///< gain of the path without a threshold
  HysteresisPlay play_operators[kMaxPlays];
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    const size_t n = codec.count(self.count, kMaxPlays);
    codec.array(self.reserved, sizeof self.reserved);
    codec(self.straight);
    for (size_t i = 0; i < n; ++i) codec(self.play_operators[i].threshold, self.play_operators[i].weight);
  }
};

/// How the finger's position is estimated between counts, and predicted.
struct Tracking {
  static constexpr MessageType kType = MessageType::tracking;
  uint8_t between_counts = 0;
  uint8_t reserved[3] = {};
  float look_ahead_ticks = 0, smoothing_ticks = 0;
  float full_detail_counts_per_tick = 0;  ///< speed above which the second level is blended in
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.between_counts);
    codec.array(self.reserved, sizeof self.reserved);
    codec(self.look_ahead_ticks, self.smoothing_ticks, self.full_detail_counts_per_tick);
  }
};

/// Limit of the drive's RMS over time; 0 V: no limit.
struct Energy {
  static constexpr MessageType kType = MessageType::energy;
  float rms_v = 0, window_s = 0;
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.rms_v, self.window_s);
  }
};

/// Drive only while the finger presses; 0 N: always.
struct Contact {
  static constexpr MessageType kType = MessageType::contact;
  uint8_t channel = 0;  ///< index of the channel with the normal force
  uint8_t reserved[3] = {};
  float on_n = 0, off_n = 0;
  float newtons_per_code = 0, offset_n = 0;  ///< of that channel, in single precision for small cores
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.channel);
    codec.array(self.reserved, sizeof self.reserved);
    codec(self.on_n, self.off_n, self.newtons_per_code, self.offset_n);
  }
};

/// The profile that was uploaded during playback replaces the one that plays.
struct Change {
  static constexpr MessageType kType = MessageType::change;
  float fade_s = 0;  ///< 0 to 10
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.fade_s);
  }
};

/// Required before a scene is armed; at most the device's own limits.
struct ForceLimits {
  static constexpr MessageType kType = MessageType::force_limits;
  float axis_peak_n[kMaxAxes] = {}, axis_continuous_n[kMaxAxes] = {};
  float peak_n = 0, continuous_n = 0;  ///< of the vector
  float slew_n_per_s = 0;              ///< of each axis
  float onset_s = 0;
  float release_s = 0;  ///< release_s + peak_n / slew_n_per_s is at most kLongestReleaseS
  uint16_t watchdog_ms = 0;
  uint16_t reserved = 0;
  uint32_t counts_per_tick = 0;  ///< of an axis; more is an encoder jump
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec.array(self.axis_peak_n, kMaxAxes);
    codec.array(self.axis_continuous_n, kMaxAxes);
    codec(self.peak_n, self.continuous_n, self.slew_n_per_s, self.onset_s, self.release_s, self.watchdog_ms,
          self.reserved, self.counts_per_tick);
  }
};

/// A part of a scene's block. The last part completes it.
struct ScenePart {
  static constexpr MessageType kType = MessageType::scene_part;
  uint32_t bytes = 0;  ///< of the whole block
  uint32_t first = 0;  ///< place of this part
  uint16_t count = 0;
  uint8_t data[kMaxScenePart];
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.bytes, self.first);
    const size_t n = codec.count(self.count, kMaxScenePart);
    codec.array(self.data, n);
  }
};

/// Changes a number of a layer, linearly over a time.
struct Set {
  static constexpr MessageType kType = MessageType::set;
  uint16_t layer = 0;   ///< in the order of the block
  uint16_t number = 0;  ///< in the order of the layer's numbers
  float value = 0;
  float ramp_s = 0;  ///< 0 to 10
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.layer, self.number, self.value, self.ramp_s);
  }
};

/// Moves a patch, linearly over a time.
struct Move {
  static constexpr MessageType kType = MessageType::move;
  uint16_t patch = 0;  ///< in the order of the block
  uint16_t reserved = 0;
  int32_t x_counts = 0, y_counts = 0;  ///< from its place in the block
  float ramp_s = 0;                    ///< 0 to 10
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.patch, self.reserved, self.x_counts, self.y_counts, self.ramp_s);
  }
};

/// A patch becomes the topmost one.
struct Raise {
  static constexpr MessageType kType = MessageType::raise;
  uint16_t patch = 0;  ///< in the order of the block
  template <class Codec, class Self>
  static void fields(Codec& codec, Self& self) noexcept {
    codec(self.patch);
  }
};

}  // namespace tacto::wire
