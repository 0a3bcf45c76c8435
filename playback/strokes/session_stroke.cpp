// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/strokes/session_stroke.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "playback/strokes/block_judge.hpp"
#include "playback/strokes/judged_rows.hpp"
#include "playback/strokes/stroke_finder.hpp"

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr std::uint64_t kMostStrokeRows = std::uint64_t{1} << 22;

std::uint64_t rows_around(const schema::SessionHeader& header) {
  return rows_in(JudgedBlocks{}.around_s, header.rate_hz);
}

double way_of(const StrokeSums& stroke) {
  return std::abs(stroke.last.row.position_m - stroke.first.row.position_m);
}

struct Found {
  std::uint64_t strokes = 0, chosen = 0;
  StrokeSums sums;
};

Result<Found> find_stroke(const std::string& name, const SessionOverview& overview, std::uint64_t asked,
                          const std::function<void(double)>& progress) {
  Found found;
  StrokeFinder finder([&](const StrokeSums& sums) {
    const bool taken =
        asked > 0 ? ++found.strokes == asked : ++found.strokes == 1 || way_of(sums) > way_of(found.sums);
    if (taken) found.chosen = found.strokes, found.sums = sums;
  });
  RowMaker maker(overview, 2 * rows_around(overview.header));
  std::uint64_t index = 0;
  const auto read = read_rows(
      maker, name,
      [&](const SessionRow& row) {
        finder.add({index++, row, 0, true, {}, {}, {}});
      },
      progress);
  TACTO_TRY(read);
  finder.end();
  return found;
}

Result<void> check_found(const Found& found, std::uint64_t asked, const std::string& session) {
  if (found.strokes == 0)
    return fail(ErrorKind::unsuitable, "has no stroke of at least 5 mm during playback", session);
  if (found.chosen == 0)
    return fail(ErrorKind::usage, fmt::format("has {} strokes, and no stroke {}", found.strokes, asked),
                session);
  if (found.sums.rows > kMostStrokeRows)
    return fail(ErrorKind::unsuitable,
                fmt::format("its stroke {} has {} ticks without a reversal", found.chosen, found.sums.rows),
                session, fmt::format("choose a stroke of at most {} ticks", kMostStrokeRows));
  return {};
}

// The rows of the stroke with those around it.
Result<std::vector<JudgedRow>> rows_of(const std::string& name, const StrokeSums& sums, SessionStroke& of,
                                       const std::function<void(double)>& progress) {
  const std::uint64_t around = rows_around(of.overview.header);
  const std::uint64_t first = sums.first.index - std::min(sums.first.index, around);
  std::vector<JudgedRow> rows;
  RowMaker maker(of.overview, 2 * around);
  RowFollower follower(of.overview);
  std::uint64_t index = 0;
  const auto read = read_rows(
      maker, name,
      [&](const SessionRow& row) {
        const JudgedRow judged = follower.next(row, maker.turns());
        if (index >= first && index <= sums.last.index + around) rows.push_back(judged);
        ++index;
      },
      progress);
  TACTO_TRY(read);
  of.turns = maker.turns();
  return rows;
}

void keep_stroke(const std::vector<JudgedRow>& rows, std::uint64_t before, std::uint64_t count,
                 SessionStroke& of) {
  const auto predicted_m = predicted_displacement_m(of.overview.header, rows);
  for (std::uint64_t i = before; i < before + count; ++i) {
    of.rows.push_back(rows[i].row);
    of.predicted_m.push_back(predicted_m[i]);
  }
  auto reader = MeasuredReader::open(of.overview);
  if (!reader) return;
  const MeasuredSection measured = reader->in(rows);
  for (std::uint64_t i = before; i < before + count; ++i) {
    const auto at = measured.at(i);
    if (at) of.measured_m.push_back((*at)[kUnshifted]);
  }
  if (of.measured_m.size() < of.rows.size()) of.measured_m.clear();
}

}  // namespace

Result<SessionStroke> read_session_stroke(const std::string& name, std::uint64_t stroke,
                                          const std::function<void(double)>& progress) {
  auto overview = session_overview(name, part_of(progress, 0, 1. / 3));
  TACTO_TRY(overview);
  if (overview->lost_at)
    return fail(ErrorKind::unsuitable, fmt::format("{} ticks are missing", overview->lost), name,
                "use a session without missing ticks");
  const auto found = find_stroke(name, *overview, stroke, part_of(progress, 1. / 3, 2. / 3));
  TACTO_TRY(found);
  TACTO_TRY(check_found(*found, stroke, name));
  SessionStroke of{
      std::move(*overview), {}, found->chosen, found->strokes, found->sums.first.index, {}, {}, {}};
  const auto rows = rows_of(name, found->sums, of, part_of(progress, 2. / 3, 1));
  TACTO_TRY(rows);
  const auto before = std::min(of.first_row, rows_around(of.overview.header));
  keep_stroke(*rows, before, found->sums.rows, of);
  return of;
}

}  // namespace tacto::playback
