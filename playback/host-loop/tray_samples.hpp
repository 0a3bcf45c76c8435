// SPDX-License-Identifier: GPL-3.0-or-later
// What the sensor of the driven tray measures during a playback, for the session.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "firmware-host/link/client.hpp"
#include "playback/host-loop/sample_run.hpp"

namespace tacto::playback {

/// The first channel of displacement in m that has a scale; none if the device does not measure its tray.
std::optional<std::size_t> tray_sensor_channel(const firmware_host::Description& about);

/// Samples go to the sink between begin() and end(). A device that closes the loop itself streams them
/// (begin_stream() to end_stream()), and take() reads them; if this computer closes the loop, SensorTrack
/// adds them to run(). For one thread, that of the client.
class TraySamples {
 public:
  explicit TraySamples(firmware_host::Client& client)
      : client_(client), channel_(tray_sensor_channel(client.description())) {}

  /// Whether a command belongs to the stream only. Precondition: a whole frame.
  static bool streams(std::span<const std::uint8_t> frame);
  /// The sensor as the device describes it, sampled with the ticks (WIRE.md: one clock).
  std::optional<schema::SessionSensor> sensor(double rate_hz) const;

  void begin(double rate_hz, SampleRun::Sink sink);
  /// Call after arming, so that devices with and without a sensor have the same ticks. Errors: device.
  schema::Result<void> begin_stream();
  void take();
  /// Reads the remaining samples. Errors: device.
  schema::Result<void> end_stream();
  void end();
  /// Null if there is no sensor or no session.
  SampleRun* run() { return run_ ? &*run_ : nullptr; }

 private:
  firmware_host::Client& client_;
  std::optional<std::size_t> channel_;
  std::optional<SampleRun> run_;
  bool streams_ = false;
  double rate_hz_ = 0;
  std::uint64_t next_frame_ = 0;
  std::vector<std::int32_t> codes_;
};

}  // namespace tacto::playback
