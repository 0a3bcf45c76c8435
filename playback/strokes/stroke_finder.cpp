// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/strokes/stroke_finder.hpp"

#include <algorithm>
#include <cmath>

#include "data-schema/base/stroke_rule.hpp"
#include "firmware-host/core/wire/message_types.hpp"
#include "playback/session/session_limits.hpp"

namespace tacto::playback {
namespace {

constexpr double kTurnM = 0.2e-3;  // a shorter way back is not a turn

double square(double value) {
  return value * value;
}

double way_m(const StrokeRow& from, const StrokeRow& to) {
  return to.row.position_m - from.row.position_m;
}

}  // namespace

void ShiftedSums::add(const ShiftedRow& row, double target_m) {
  displacement_m2 += square(double{row[kUnshifted]});
  for (std::size_t i = 0; i < kShifts; ++i) difference_m2[i] += square(double{row[i]} - target_m);
}

void ShiftedSums::add(const ShiftedSums& later) {
  displacement_m2 += later.displacement_m2;
  for (std::size_t i = 0; i < kShifts; ++i) difference_m2[i] += later.difference_m2[i];
}

void StrokeSums::add(const StrokeRow& r) {
  if (rows++ == 0) first = r;
  last = r;
  target_m2 += square(r.target_m);
  predicted.add(r.predicted, r.target_m);
  if (r.measured) measured.add(*r.measured, r.target_m);
  measured_known = measured_known && r.measured;
  const std::uint32_t flags = r.row.flags;
  limited_ticks += (flags & (wire::kTickAmplitudeLimited | wire::kTickSlewLimited)) != 0;
  energy_limited_ticks += (flags & wire::kTickEnergyLimited) != 0;
  gated_ticks += (flags & wire::kTickGated) != 0;
  known = known && r.known;
  unlimited_known = unlimited_known && r.unlimited_v;
  if (r.unlimited_v && !r.row.put_in)
    limits.add(limited_tick(static_cast<float>(r.row.drive_v), *r.unlimited_v, flags));
}

void StrokeSums::add(const StrokeSums& later) {
  if (later.rows == 0) return;
  rows += later.rows;
  last = later.last;
  target_m2 += later.target_m2;
  predicted.add(later.predicted);
  measured.add(later.measured);
  limited_ticks += later.limited_ticks, energy_limited_ticks += later.energy_limited_ticks;
  gated_ticks += later.gated_ticks;
  known = known && later.known, unlimited_known = unlimited_known && later.unlimited_known;
  measured_known = measured_known && later.measured_known;
  limits.add(later.limits);
}

void StrokeFinder::start_at(const StrokeRow& row) {
  so_far_ = since_ = {};
  so_far_.add(row);
  direction_ = 0;
}

// The farthest row is the last of one stroke and the first of the next.
void StrokeFinder::turn() {
  const StrokeRow farthest = so_far_.last;
  const StrokeSums since = since_;
  const int back = -direction_;
  end();
  start_at(farthest);
  so_far_.add(since);
  direction_ = back;
}

void StrokeFinder::add(const StrokeRow& row) {
  if ((row.row.flags & wire::kTickBlind) != 0) {
    end();
    begun_ = false;
    return;
  }
  const bool playing = (row.row.flags & wire::kTickPlaying) != 0;
  if (!std::exchange(begun_, true) || !playing) {
    end();
    return start_at(row);
  }
  ++played_;
  since_.add(row);
  const double started = way_m(so_far_.first, row), ahead = way_m(so_far_.last, row);
  if (direction_ == 0 && std::abs(started) > kTurnM) direction_ = started > 0 ? 1 : -1;
  if (direction_ == 0) return;
  if (direction_ * ahead >= 0) {
    so_far_.add(since_);
    since_ = {};
  } else if (-direction_ * ahead > kTurnM) {
    turn();
  }
}

void StrokeFinder::end() {
  if (direction_ == 0) return;
  const double length_m = std::abs(way_m(so_far_.first, so_far_.last));
  longest_way_m_ = std::max(longest_way_m_, length_m);
  if (length_m >= schema::kShortestStroke_m) found_(so_far_);
  direction_ = 0;
}

}  // namespace tacto::playback
