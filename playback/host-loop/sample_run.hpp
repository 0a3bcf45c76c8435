// SPDX-License-Identifier: GPL-3.0-or-later
// Collects the samples of the tray's sensor in blocks for a session.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include "data-schema/session/session.hpp"

namespace tacto::playback {

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

}  // namespace tacto::playback
