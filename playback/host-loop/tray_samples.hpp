// SPDX-License-Identifier: GPL-3.0-or-later
// What the sensor of the driven tray measures during a playback, for the session; and the normal force.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "data-schema/session/session.hpp"
#include "firmware-host/link/client.hpp"
#include "playback/prepare/upload.hpp"

namespace tacto::playback {

// Collects the samples of the tray's sensor in blocks for a session.

/// Frames with consecutive numbers and, within half a period, consecutive times form one block. Not safe in
/// the tick: it allocates.
class SampleRun {
 public:
  using Sink = std::function<void(schema::SessionSamples)>;
  SampleRun(double rate_hz, Sink sink) : period_ns_(1e9 / rate_hz), sink_(std::move(sink)) {}

  void add(std::uint64_t frame, std::int64_t time_ns, std::int32_t code) {
    if (!follows(frame, time_ns) || run_.codes.size() >= kMost) flush();
    if (run_.codes.empty()) run_.first_frame = frame, run_.time_ns = time_ns;
    run_.codes.push_back(code);
  }
  /// Sends the block to the sink.
  void flush() {
    if (!run_.codes.empty()) sink_(std::exchange(run_, {}));
  }

 private:
  static constexpr std::size_t kMost = 1024;
  bool follows(std::uint64_t frame, std::int64_t time_ns) const {
    const auto count = static_cast<double>(run_.codes.size());
    return frame == run_.first_frame + run_.codes.size() &&
           std::abs(static_cast<double>(time_ns - run_.time_ns) - count * period_ns_) < period_ns_ / 2;
  }
  double period_ns_;
  Sink sink_;
  schema::SessionSamples run_;
};

/// The first channel of displacement in m that has a scale; none if the device does not measure its tray.
std::optional<std::size_t> tray_sensor_channel(const firmware_host::Description& about);

/// Samples go to the sink between begin() and end(). A device that closes the loop itself streams them
/// (begin_stream() to end_stream()), and take() reads them; if this computer closes the loop, SensorTrack
/// adds them to run(). For one thread, that of the client.
class TraySamples {
 public:
  /// With `follow_force` the stream is also read for normal_force_n().
  explicit TraySamples(firmware_host::Client& client, bool follow_force = false)
      : client_(client),
        channel_(tray_sensor_channel(client.description())),
        force_(follow_force ? force_channel(client) : nullptr) {}

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
  /// The normal force, a mean over the last kForceMeanS or so (first-order low-pass); none: no sample of it
  /// in the last kForceAgeS before `now_s` of the device's clock.
  std::optional<double> normal_force_n(double now_s) const {
    return now_s - force_s_ < kForceAgeS ? force_n_ : std::nullopt;
  }
  /// Null if there is no sensor or no session.
  SampleRun* run() { return run_ ? &*run_ : nullptr; }

 private:
  static constexpr double kForceMeanS = 0.1, kForceAgeS = 0.25;
  void take_force(std::int32_t code, double time_s);

  firmware_host::Client& client_;
  std::optional<std::size_t> channel_;
  const wire::Channel* force_;  // null: not followed
  std::optional<double> force_n_;
  double force_s_ = 0;  // the device's clock at its last sample
  std::optional<SampleRun> run_;
  bool streams_ = false;
  double rate_hz_ = 0;
  std::uint64_t next_frame_ = 0;
  std::vector<std::int32_t> codes_;
};

}  // namespace tacto::playback
