// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/strokes/judged_rows.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "firmware-host/core/kernel/tick_kernel.hpp"
#include "firmware-host/core/wire/message_types.hpp"
#include "playback/choose/choices.hpp"
#include "playback/model/chain.hpp"
#include "playback/render/reference/exact_target.hpp"

namespace tacto::playback {
namespace {

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

// Unknown names of a newer version are read as none.
Chain chain_of(const schema::SessionHeader& header) {
  const PrepareOptions played = with_choices({}, header.choices).value_or(PrepareOptions{});
  return {header.transducer, played.reconstruction, played.reconstruction_cutoff_hz, played.hold,
          header.rate_hz};
}

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

GainFollower::GainFollower(double rate_hz)
    : ticks_(std::max(1.0, std::floor(double{core::kGainS * static_cast<float>(rate_hz)}))) {}

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

// In the first row of a playback the envelope has made one step: 0.7 % if it lasts 20 ms, at 1 kHz.
bool begins_at_rest(std::span<const JudgedRow> rows) {
  return rows.front().envelope < 0.01;
}

bool ends_at_rest(std::span<const JudgedRow> rows) {
  return rows.back().envelope == 0;
}

RowFollower::RowFollower(const SessionOverview& overview) : gain_(overview.header.rate_hz) {
  const schema::SessionHeader& header = overview.header;
  const schema::Transducer& t = header.transducer;
  if (t.hysteresis) bender_.emplace(*t.hysteresis, schema::actuator_pole_hz(t), header.rate_hz);
  const auto rate_hz = static_cast<float>(header.rate_hz);
  envelope_.set(overview.onset_s * rate_hz, overview.release_s * rate_hz);
}

// As in the kernel, the envelope rises while it plays and counts come. A filled row is not a tick.
JudgedRow RowFollower::next(const SessionRow& row, std::span<const TextureChange> turns) {
  constexpr std::uint32_t kSeen = wire::kTickPlaying | wire::kTickBlind;
  if (!row.put_in) weight_ = envelope_.step((row.flags & kSeen) == wire::kTickPlaying);
  return {row, mix_.next(row, turns), gain_.next(row), double{weight_},
          bender_ ? (*bender_)(row.drive_v) : row.drive_v};
}

double drive_delay_s(const schema::SessionHeader& header) {
  const double low_hz = header.low_hz;
  const double phase = std::arg(chain_response(chain_of(header), low_hz));
  return header.loop_delay_s - phase / (2 * std::numbers::pi * low_hz);
}

std::vector<double> predicted_displacement_m(const schema::SessionHeader& header,
                                             std::span<const JudgedRow> rows, std::size_t between) {
  const spatial::Band band{header.low_hz, header.high_hz};
  const double duration_s = static_cast<double>(rows.size() - 1) / header.rate_hz;
  const ReadingGrid grid = reading_grid(duration_s, header.rate_hz, band, 0);
  const Chain chain = chain_of(header);
  std::vector<double> drive_v(rows.size());
  std::ranges::transform(rows, drive_v.begin(), &JudgedRow::linear_drive_v);
  auto drive = spectrum_of(drive_v, header.rate_hz, grid.period);
  keep_band(drive, band);
  // The drive reaches the device later than its tick by the delay of the loop.
  const auto displacement = through(drive, [&](double f) {
    return chain_response(chain, f) * std::polar(1.0, -2 * std::numbers::pi * f * header.loop_delay_s);
  });
  return signal_of(displacement, between);
}

}  // namespace tacto::playback
