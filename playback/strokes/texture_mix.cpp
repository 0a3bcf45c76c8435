// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/strokes/texture_mix.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tacto::playback {
namespace {

constexpr double kGainS = 0.01;  // core::TickInput::gain

// The replacement of each set: itself, or the last known set before it; none before the first known one.
std::vector<std::ptrdiff_t> replacements(const std::vector<bool>& known) {
  std::vector<std::ptrdiff_t> all;
  std::ptrdiff_t last = -1;
  for (std::size_t set = 0; set < known.size(); ++set)
    all.push_back(last = known[set] ? static_cast<std::ptrdiff_t>(set) : last);
  return all;
}

class MixWriter {
 public:
  explicit MixWriter(const std::vector<bool>& known) : known_(known), replacement_(replacements(known)) {
    mix_.sets.resize(known.size());
  }
  void add_row(const MixRow& row) {
    const bool fades = row.leaving_part > 0;
    if (fades) add(row.leaving, row.leaving_part);
    add(row.playing, 1 - row.leaving_part);
    mix_.unknown.push_back(!known_[row.playing] || (fades && !known_[row.leaving]));
  }
  TextureMix take() { return std::move(mix_); }

 private:
  void add(std::size_t of, float part) {
    if (replacement_[of] < 0) return;
    MixedSet& set = mix_.sets[static_cast<std::size_t>(replacement_[of])];
    const std::size_t row = mix_.unknown.size();
    if (set.part.empty()) set.first = row;
    if (set.first + set.part.size() > row)
      set.part.back() += part;
    else
      set.part.push_back(part);
  }
  const std::vector<bool>& known_;
  std::vector<std::ptrdiff_t> replacement_;
  TextureMix mix_;
};

}  // namespace

MixRow MixFollower::next(const SessionRow& row, std::span<const TextureChange> turns) {
  if (std::exchange(begun_, true) && !row.put_in) fade_ = std::max(0.0F, fade_ - step_);
  while (playing_ < row.turns) {
    const double fade_ticks = turns[playing_].fade_ticks;
    if (fade_ <= 0.5F) leaving_ = playing_;
    ++playing_;
    fade_ = 1;
    step_ = fade_ticks > 1 ? 1 / static_cast<float>(fade_ticks) : 1;
  }
  return {playing_, leaving_, fade_ > 0 ? fade_ * fade_ * (3 - 2 * fade_) : 0};
}

GainFollower::GainFollower(double rate_hz) : ticks_(std::max(1.0, std::floor(kGainS * rate_hz))) {}

double GainFollower::next(const SessionRow& row) {
  if (!std::exchange(begun_, true)) gain_ = aim_ = row.gain;
  if (row.gain != aim_) aim_ = row.gain, left_ = ticks_, step_ = (aim_ - gain_) / ticks_;
  if (left_ > 0 && !row.put_in) gain_ = --left_ > 0 ? gain_ + step_ : aim_;
  return gain_;
}

TextureMix texture_mix(std::span<const MixRow> rows, const std::vector<bool>& known) {
  MixWriter mix(known);
  for (const MixRow& row : rows) mix.add_row(row);
  return mix.take();
}

}  // namespace tacto::playback
