// SPDX-License-Identifier: GPL-3.0-or-later
// What a device's sensor says of its driven tray while it plays, for the session.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "firmware-host/link/client.hpp"
#include "playback/host-loop/sample_run.hpp"

namespace tacto::playback {

/// The first channel of displacement in m with a scale; none where the device does not report its tray.
std::optional<std::size_t> tray_sensor_channel(const firmware_host::Description& about);

/// Between begin() and end() samples go to the sink. From a device that closes the loop itself they are
/// streamed (begin_stream() to end_stream()) and taken by take(); where this computer closes it, others give
/// them to run(). One thread, the client's.
class TraySamples {
 public:
  explicit TraySamples(firmware_host::Client& client)
      : client_(client), channel_(tray_sensor_channel(client.description())) {}

  /// Whether a command concerns the stream alone. Precondition: a whole frame.
  static bool streams(std::span<const std::uint8_t> frame);
  /// As the device describes it, sampled with its ticks (WIRE.md: one clock).
  std::optional<schema::SessionSensor> sensor(double rate_hz) const;

  void begin(double rate_hz, SampleRun::Sink sink);
  /// Behind arming, so that devices with and without a sensor tick alike. Errors: device.
  schema::Result<void> begin_stream();
  void take();
  /// Takes what is left. Errors: device.
  schema::Result<void> end_stream();
  void end();
  /// Null where there is no sensor, or no session.
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
