// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/tick_stream.hpp"

#include <algorithm>
#include <cmath>

#include "data-schema/session/ticks_base64.hpp"

namespace tacto::playback {
namespace {

using schema::ControlFields;
using schema::SessionTick;
using Ticks = std::span<const SessionTick>;

constexpr double kCellHz = 2000;           // above it: two ticks for each cell of 0.5 ms
constexpr std::size_t kMostInALine = 360;  // with three axes 11.6 KB; in base64 below the longest line
constexpr std::size_t kMostKept = 20000;   // a second at 20 kHz: the daemon was held up for longer

// What a picture shows: the drive, or the force of a force device (squared).
double height(const SessionTick& tick) {
  if (tick.axes == 0) return double{tick.drive_v};
  double square = 0;
  for (std::size_t i = 0; i < tick.axes; ++i) square += double{tick.force_n[i]} * double{tick.force_n[i]};
  return square;
}

// The flags without the upper bits, which count commands.
constexpr std::uint32_t kFlags = 0xFFFF;

// The least and the greatest tick of a cell, in their order. Both get the flags of all its ticks, so that
// none is overlooked.
void add_cell(std::vector<SessionTick>& reduced, Ticks cell) {
  const auto [least, greatest] = std::minmax_element(
      cell.begin(), cell.end(), [](const auto& a, const auto& b) { return height(a) < height(b); });
  std::uint32_t flags = 0;
  for (const SessionTick& tick : cell) flags |= tick.flags & kFlags;
  const auto add = [&](const SessionTick& tick) {
    reduced.push_back(tick);
    reduced.back().flags |= flags;
  };
  add(*std::min(least, greatest));
  if (least != greatest) add(*std::max(least, greatest));
}

std::vector<SessionTick> reduced_to_cells(Ticks run, std::uint64_t per_cell) {
  std::vector<SessionTick> reduced;
  for (std::size_t from = 0; from < run.size();) {
    const std::uint64_t cell = run[from].tick / per_cell;
    std::size_t end = from + 1;
    while (end < run.size() && run[end].tick / per_cell == cell) ++end;
    add_cell(reduced, run.subspan(from, end - from));
    from = end;
  }
  return reduced;
}

void add_events(std::vector<ControlFields>& events, Ticks run, std::uint64_t per_cell) {
  const bool reduces = per_cell > 2;  // otherwise two of each cell are all
  const std::vector<SessionTick> reduced =
      reduces ? reduced_to_cells(run, per_cell) : std::vector<SessionTick>();
  for (Ticks rest = reduces ? Ticks(reduced) : run; !rest.empty();) {
    const Ticks part = rest.first(std::min(rest.size(), kMostInALine));
    rest = rest.subspan(part.size());
    ControlFields fields{{"block", std::int64_t{part.front().axes > 0 ? 8 : 1}},
                         {"ticks", schema::ticks_base64(part)}};
    if (reduces) fields.emplace_back("cell_ticks", static_cast<std::int64_t>(per_cell));
    events.push_back(std::move(fields));
  }
}

}  // namespace

void TickStream::turn(bool on) {
  if (on == on_) return;
  on_ = on;
  ticks_.clear();
}

void TickStream::take(const SessionTick& tick) {
  if (on_ && ticks_.size() < kMostKept) ticks_.push_back(tick);
}

std::vector<ControlFields> TickStream::take_events(double rate_hz, bool last) {
  const auto per_cell = static_cast<std::uint64_t>(std::max(1.0, std::floor(rate_hz / kCellHz + 1e-9)));
  std::size_t end = ticks_.size();
  // The ticks of a cell that is not complete; with one tick for each cell there are none.
  while (!last && end > 0 && (ticks_[end - 1].tick + 1) % per_cell != 0) --end;
  std::vector<ControlFields> events;
  for (std::size_t from = 0; from < end;) {
    std::size_t next = from + 1;
    while (next < end && ticks_[next].tick == ticks_[next - 1].tick + 1) ++next;
    add_events(events, Ticks(ticks_).subspan(from, next - from), per_cell);
    from = next;
  }
  ticks_.erase(ticks_.begin(), ticks_.begin() + static_cast<std::ptrdiff_t>(end));
  return events;
}

}  // namespace tacto::playback
