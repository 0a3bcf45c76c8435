// SPDX-License-Identifier: GPL-3.0-or-later
// The device as the host sees it: what it can do, and its stream of frames. Real and emulated ones are chosen
// alike.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::firmware_host {

/// What a device says of itself when it is opened.
struct Capabilities {
  std::string uri;  ///< as it was asked for; on USB the one that tells it from others
  std::string name;
  std::string serial;
  std::string firmware;   ///< its version
  std::string simulated;  ///< by what; empty for a real device
  std::string clock;      ///< what gives the time: "device"
  double sample_rate_hz = 0;
  /// One a sample of each frame, in order. Physical = code x scale + offset, in `unit`. The transducer's own
  /// channel, `tangential_force`, is in volts at its output: how many newtons that is depends on the
  /// transducer's model, and the device does not know it.
  std::vector<schema::Channel> channels;
  std::optional<schema::Transducer> transducer;
  std::string surface;  ///< what lies on the tray, where the device knows it
};

/// What has happened in a stream since start().
struct StreamCounts {
  std::uint64_t frames = 0;
  std::uint64_t lost_frames = 0;
  /// Of what the device sent: messages that came damaged, and that never came (the damaged ones among them).
  std::uint64_t damaged_messages = 0, missing_messages = 0;
  std::uint64_t clipped = 0;  ///< samples at either end of a converter's range, over all channels
};

/// When a frame was taken by the device's clock, and when its message was here by the host's steady clock.
struct ClockPair {
  std::uint64_t device_sequence = 0;  ///< the frame's number, lost ones counted
  double device_s = 0, host_s = 0;
};

/// Something went wrong on the device; words_of() says it to people.
struct DeviceFault {
  std::uint64_t frame = 0;  ///< frames given before it was known
  wire::FaultCode code = wire::FaultCode::none;
  std::uint32_t detail = 0;
};

/// What a stream brought beside its frames.
struct StreamEvents {
  std::vector<schema::Gap> gaps;  ///< `frame` counts the frames given since start()
  std::vector<ClockPair> clock_pairs;
  std::vector<DeviceFault> faults;
};

class Client;

/// A device that is open. Not safe to share between threads.
class Device {
 public:
  virtual ~Device() = default;

  virtual const Capabilities& capabilities() const = 0;
  /// Begins the stream. Errors: device.
  virtual schema::Result<void> start() = 0;
  /// Fills whole frames, at most as many as fit; a sample is a converter code left-justified in 32 bits, of
  /// an encoder its plain count. Gives the number of frames; 0 where the stream has ended. It stops short at
  /// a gap: missing frames are never within what it gives, and take_events() has them before the frames that
  /// follow are given. Errors: device: not started, gone, or failed, after all frames that came before.
  virtual schema::Result<std::size_t> read(std::span<std::int32_t> interleaved) = 0;
  /// Ends the stream. Errors: device.
  virtual schema::Result<void> stop() = 0;
  virtual StreamCounts counts() const = 0;
  /// Whether frames come by the clock on the wall, and are lost where nobody takes them.
  virtual bool keeps_time() const { return true; }
  /// What has happened since the last call, or start().
  virtual StreamEvents take_events() { return {}; }
  /// One question and its answer, by the clock on the wall; not while streaming. Errors: device: no answer;
  /// unsuitable: nobody is there to answer, as in a replay.
  virtual schema::Result<double> round_trip_s() {
    return schema::fail(schema::ErrorKind::unsuitable, "answers no questions", capabilities().uri);
  }
  /// The conversation itself, for what is no stream: drive. Null where nobody is there to answer.
  virtual Client* conversation() { return nullptr; }
};

}  // namespace tacto::firmware_host
