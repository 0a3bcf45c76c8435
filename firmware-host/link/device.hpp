// SPDX-License-Identifier: GPL-3.0-or-later
// The device for the host: its capabilities and its stream of frames. Real and emulated ones have the same
// interface.
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

/// The properties that a device reports when it is opened.
struct Capabilities {
  std::string uri;  ///< as requested; on USB the one that distinguishes it from others
  std::string name;
  std::string serial;
  std::string firmware;   ///< its version
  std::string simulated;  ///< what simulates the samples; empty for a real device
  /// What simulates the device itself. When it is driven, the finger and the surface of its samples are not
  /// there.
  std::string simulated_device;
  std::string clock;  ///< the time base: "device"
  double sample_rate_hz = 0;
  /// One per sample of each frame, in order. Physical = code x scale + offset, in `unit`. The transducer's
  /// own channel, `tangential_force`, is in volts at its output: its newtons depend on the model of the
  /// transducer, which is not part of the device.
  std::vector<schema::Channel> channels;
  std::optional<schema::Transducer> transducer;
  std::string transducer_file;        ///< for read_transducer(), of a device that speaks the wire
  std::string surface;                ///< the surface on the tray, if the device reports it
  std::vector<std::string> warnings;  ///< of the device; each recording stores them, too
};

/// Counters of a stream since start().
struct StreamCounts {
  std::uint64_t frames = 0;
  std::uint64_t lost_frames = 0;
  /// Messages from the device that were damaged, and that are missing (including the damaged ones).
  std::uint64_t damaged_messages = 0, missing_messages = 0;
  std::uint64_t clipped = 0;  ///< samples at either end of a converter's range, in all channels
};

/// The sampling time of a frame by the device's clock, and the arrival time of its message by the host's
/// steady clock.
struct ClockPair {
  std::uint64_t device_sequence = 0;  ///< the frame's number, lost frames included
  double device_s = 0, host_s = 0;
};

/// A fault of the device; words_of() gives its message.
struct DeviceFault {
  std::uint64_t frame = 0;  ///< number of frames returned before it was reported
  wire::FaultCode code = wire::FaultCode::none;
  std::uint32_t detail = 0;
};

/// The events of a stream.
struct StreamEvents {
  std::vector<schema::Gap> gaps;  ///< `frame` counts the frames returned since start()
  std::vector<ClockPair> clock_pairs;
  std::vector<DeviceFault> faults;
};

class Client;

/// An open device. Not safe to share between threads.
class Device {
 public:
  virtual ~Device() = default;

  virtual const Capabilities& capabilities() const = 0;
  /// Starts the stream. Errors: device.
  virtual schema::Result<void> start() = 0;
  /// Fills whole frames, at most as many as fit; a sample is a converter code left-justified in 32 bits, or
  /// the plain count of an encoder. Returns the number of frames; 0 if the stream has ended. It stops at a
  /// gap: the returned frames never contain a gap, and take_events() has the gap before the frames after it
  /// are returned. Errors: device: not started, gone, or failed, after all earlier frames.
  virtual schema::Result<std::size_t> read(std::span<std::int32_t> interleaved) = 0;
  /// Stops the stream. Errors: device.
  virtual schema::Result<void> stop() = 0;
  virtual StreamCounts counts() const = 0;
  /// Whether frames arrive in real time, and are lost if they are not read.
  virtual bool is_real_time() const { return true; }
  /// The events since the last call, or start().
  virtual StreamEvents take_events() { return {}; }
  /// The time of one request and its answer, by the wall clock; not while streaming. Errors: device: no
  /// answer; unsuitable: there is no device, as in a replay.
  virtual schema::Result<double> round_trip_s() {
    return schema::fail(schema::ErrorKind::unsuitable, "does not answer requests", capabilities().uri);
  }
  /// The client of the connection, for drive. Null if there is no device to control.
  virtual Client* conversation() { return nullptr; }
};

}  // namespace tacto::firmware_host
