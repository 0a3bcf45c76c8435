// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/strokes/judged_rows.hpp"

#include <algorithm>
#include <complex>
#include <numbers>

#include "firmware-host/core/wire/message_types.hpp"
#include "playback/choose/choices.hpp"
#include "playback/model/chain.hpp"
#include "playback/render/reference/exact_target.hpp"

namespace tacto::playback {
namespace {

// Unknown names of a newer version are read as none.
Chain chain_of(const schema::SessionHeader& header) {
  const PrepareOptions played = with_choices({}, header.choices).value_or(PrepareOptions{});
  return {header.transducer, played.reconstruction, played.reconstruction_cutoff_hz, played.hold,
          header.rate_hz};
}

}  // namespace

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
