// SPDX-License-Identifier: GPL-3.0-or-later
// A finger that follows a given position.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <utility>

#include "firmware-host/sim/device/frame_source.hpp"

namespace tacto::firmware_host {

/// The encoder follows a script: frame i is at (i + 1) x period, without the frames in which the script is
/// held at its beginning. Only the channels of position and normal force, the second and third of the
/// emulated device, have values; the others are zero.
class ScriptedRun final : public FrameSource {
 public:
  /// `held` must outlive this object; null: never held.
  ScriptedRun(std::function<double(double)> position_m, std::function<std::int32_t(double)> force_code,
              double period_s, double quantum_m, const std::atomic<bool>* held = nullptr)
      : position_m_(std::move(position_m)),
        force_code_(std::move(force_code)),
        period_s_(period_s),
        quantum_m_(quantum_m),
        held_(held),
        count_(count_at(0)) {}

  bool next(std::span<std::int32_t> frame) override {
    if (held_ == nullptr || !held_->load()) ++frames_;
    count_ = count_at(frames_);
    std::ranges::fill(frame, 0);
    if (frame.size() > 1) frame[1] = count_;
    if (frame.size() > 2) frame[2] = force_code_(static_cast<double>(frames_) * period_s_);
    return true;
  }
  std::int32_t encoder_count() const override { return count_; }

 private:
  // A 32-bit counter wraps at 2^31.
  std::int32_t count_at(std::uint64_t frame) const {
    const double count = std::floor(position_m_(static_cast<double>(frame) * period_s_) / quantum_m_);
    return static_cast<std::int32_t>(static_cast<std::int64_t>(count));
  }

  std::function<double(double)> position_m_;
  std::function<std::int32_t(double)> force_code_;
  double period_s_, quantum_m_;
  const std::atomic<bool>* held_;
  std::uint64_t frames_ = 0;
  std::int32_t count_;
};

}  // namespace tacto::firmware_host
