// SPDX-License-Identifier: Apache-2.0
// Plays the texture under the finger: position and speed, the level of detail for the speed, and a change of
// texture.
#pragma once

#include "firmware-host/core/kernel/finger_tracker.hpp"
#include "firmware-host/core/kernel/profile.hpp"

namespace tacto::core {

/// A texture and the tracking of the finger on it.
struct TextureSetup {
  Profile profile;
  TrackerSetup tracker;
  /// 1 / the speed (counts per tick) up to which the first level is within the band; half octaves of speed
  /// are counted from there. 0: the first level is used at every speed.
  float per_full_detail = 0;
};

inline float per_full_detail(float counts_per_tick) noexcept {
  return counts_per_tick > 0 ? 1 / counts_per_tick : 0;
}

/// target = gain x texture(position). A gain changes linearly to its new value within `gain_ticks` and is
/// then exactly that value; another texture is faded in with the weight w = u^2 (3 - 2 u). Safe in the tick.
class TexturePlayer {
 public:
  void set(const TextureSetup& texture, float gain_ticks) noexcept;
  /// Resets the tracker, the gain and a fading texture.
  void begin(float gain_ticks) noexcept;
  void change(const TextureSetup& texture, float fade_ticks) noexcept;
  /// Resets the speed, because the finger is at another position.
  void reset_finger_speed() noexcept { tracker_.set(playing().tracker); }
  bool changing() const noexcept { return fade_ > 0; }
  float target(int32_t count, float gain) noexcept;
  FingerPlace place() const noexcept { return place_; }

 private:
  float read(const TextureSetup& texture) const noexcept;
  [[gnu::noinline]] float faded(float value) noexcept;  // rare, so not inlined into the usual tick
  float follow(float gain) noexcept;

  TextureSetup& playing() noexcept { return textures_[which_]; }
  const TextureSetup& leaving() const noexcept { return textures_[1 - which_]; }

  TextureSetup textures_[2];  // the playing one and the fading one: a change copies one, not both
  uint8_t which_ = 0;
  FingerTracker tracker_;
  FingerPlace place_;
  float gain_ = 0, gain_aim_ = 0, gain_step_ = 0;
  float fade_ = 0, fade_step_ = 0;  // weight of the fading texture, 1 to 0
  uint32_t gain_left_ = 0, gain_ticks_ = 1;
  bool gained_ = false;
};

}  // namespace tacto::core
