// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/session/session_columns.hpp"

#include <fmt/format.h>

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr std::uint64_t kMostColumnTicks = std::uint64_t{1} << 24;

void add_row(SessionColumns& columns, const SessionRow& row) {
  columns.tick.push_back(row.tick);
  columns.position_m.push_back(row.position_m);
  columns.drive_v.push_back(row.drive_v);
}

}  // namespace

Result<SessionColumns> read_session_columns(const std::string& name) {
  const auto overview = session_overview(name);
  TACTO_TRY(overview);
  if (overview->ticks > kMostColumnTicks)
    return fail(ErrorKind::unsuitable, fmt::format("has more than {} ticks", kMostColumnTicks),
                overview->path, "`tactograph session` judges and exports sessions of any length");
  SessionColumns columns;
  columns.header = overview->header;
  columns.lost_at = overview->lost_at;
  columns.lost = overview->lost;
  RowMaker maker(*overview);
  const auto read = read_rows(maker, name, [&](const SessionRow& row) { add_row(columns, row); });
  TACTO_TRY(read);
  return columns;
}

}  // namespace tacto::playback
