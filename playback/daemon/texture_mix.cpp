// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/texture_mix.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::playback {
namespace {

constexpr double kGainS = 0.01;  // core::TickInput::gain

// Sets in the place of core::TexturePlayer's textures; single precision, as there.
class SetFade {
 public:
  void change(std::size_t set, double fade_ticks) {
    if (fade_ <= 0.5F) leaving_ = playing_;
    playing_ = set;
    fade_ = 1;
    step_ = fade_ticks > 1 ? 1 / static_cast<float>(fade_ticks) : 1;
  }
  void tick() { fade_ = std::max(0.0F, fade_ - step_); }
  bool fades() const { return fade_ > 0; }
  float leaving_part() const { return fade_ * fade_ * (3 - 2 * fade_); }
  std::size_t playing() const { return playing_; }
  std::size_t leaving() const { return leaving_; }

 private:
  std::size_t playing_ = 0, leaving_ = 0;
  float fade_ = 0, step_ = 0;
};

// What stands in for each set: itself, or the last known one before it; none before the first known.
std::vector<std::ptrdiff_t> stand_ins(const std::vector<bool>& known) {
  std::vector<std::ptrdiff_t> all;
  std::ptrdiff_t last = -1;
  for (std::size_t set = 0; set < known.size(); ++set)
    all.push_back(last = known[set] ? static_cast<std::ptrdiff_t>(set) : last);
  return all;
}

class MixWriter {
 public:
  explicit MixWriter(const std::vector<bool>& known) : known_(known), stands_in_(stand_ins(known)) {
    mix_.sets.resize(known.size());
  }
  void add_row(const SetFade& fade) {
    const float leaving = fade.fades() ? fade.leaving_part() : 0;
    if (fade.fades()) add(fade.leaving(), leaving);
    add(fade.playing(), 1 - leaving);
    mix_.unknown.push_back(!known_[fade.playing()] || (fade.fades() && !known_[fade.leaving()]));
  }
  TextureMix take() { return std::move(mix_); }

 private:
  void add(std::size_t of, float part) {
    if (stands_in_[of] < 0) return;
    MixedSet& set = mix_.sets[static_cast<std::size_t>(stands_in_[of])];
    const std::size_t row = mix_.unknown.size();
    if (set.part.empty()) set.first = row;
    if (set.first + set.part.size() > row)
      set.part.back() += part;
    else
      set.part.push_back(part);
  }
  const std::vector<bool>& known_;
  std::vector<std::ptrdiff_t> stands_in_;
  TextureMix mix_;
};

bool is_tick(const SessionColumns& columns, std::size_t row) {
  return row == 0 || columns.tick[row] != columns.tick[row - 1];
}

}  // namespace

TextureMix texture_mix(const SessionColumns& columns, const std::vector<bool>& known) {
  MixWriter mix(known);
  SetFade fade;
  std::size_t next = 0;
  for (std::size_t row = 0; row < columns.tick.size(); ++row) {
    if (row > 0 && is_tick(columns, row)) fade.tick();
    for (; next < columns.turns.size() && columns.turns[next].row == row; ++next)
      fade.change(next + 1, columns.turns[next].fade_ticks);
    mix.add_row(fade);
  }
  return mix.take();
}

std::vector<double> followed_gain(const SessionColumns& columns) {
  const double ticks = std::max(1.0, std::floor(kGainS * columns.header.rate_hz));
  std::vector<double> gains;
  gains.reserve(columns.gain.size());
  double gain = columns.gain.front(), aim = gain, step = 0, left = 0;
  for (std::size_t row = 0; row < columns.gain.size(); ++row) {
    if (columns.gain[row] != aim) aim = columns.gain[row], left = ticks, step = (aim - gain) / ticks;
    if (left > 0 && is_tick(columns, row)) gain = --left > 0 ? gain + step : aim;
    gains.push_back(gain);
  }
  return gains;
}

}  // namespace tacto::playback
