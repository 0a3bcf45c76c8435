// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/kernel/texture_player.hpp"

namespace tacto::core {

void TexturePlayer::begin(float gain_ticks) noexcept {
  gain_ticks_ = gain_ticks > 1 ? static_cast<uint32_t>(gain_ticks) : 1;
  gain_left_ = 0;
  gained_ = false;
  fade_ = 0;
  tracker_.set(playing().tracker);
  place_ = {};
}

void TexturePlayer::set(const TextureSetup& texture, float gain_ticks) noexcept {
  playing() = texture;
  begin(gain_ticks);
}

// A second change during a first one starts from the texture with the greater weight.
void TexturePlayer::change(const TextureSetup& texture, float fade_ticks) noexcept {
  if (fade_ <= 0.5F) which_ ^= 1U;
  playing() = texture;
  fade_ = 1;
  fade_step_ = fade_ticks > 1 ? 1 / fade_ticks : 1;
}

float TexturePlayer::read(const TextureSetup& texture) const noexcept {
  const float speed = place_.counts_per_tick < 0 ? -place_.counts_per_tick : place_.counts_per_tick;
  const float per_full = texture.per_full_detail;
  return texture.profile.at(place_.count, place_.offset, detail_at(speed * per_full));
}

float TexturePlayer::follow(float gain) noexcept {
  if (!gained_) gain_ = gain_aim_ = gain;
  gained_ = true;
  if (gain != gain_aim_) {
    gain_aim_ = gain;
    gain_left_ = gain_ticks_;
    gain_step_ = (gain - gain_) / static_cast<float>(gain_ticks_);
  }
  if (gain_left_ > 0) gain_ = --gain_left_ > 0 ? gain_ + gain_step_ : gain_aim_;
  return gain_;
}

float TexturePlayer::faded(float value) noexcept {
  const float weight = fade_ * fade_ * (3 - 2 * fade_);
  fade_ -= fade_step_;
  return value + weight * (read(leaving()) - value);
}

// Inlined completely, so that independent instructions can start early.
[[gnu::flatten]] float TexturePlayer::target(int32_t count, float gain) noexcept {
  place_ = tracker_.track(count);
  float value = read(playing());
  if (fade_ > 0) value = faded(value);
  return follow(gain) * value;
}

}  // namespace tacto::core
