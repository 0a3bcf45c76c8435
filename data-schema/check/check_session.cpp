// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "data-schema/check/check_parts.hpp"
#include "data-schema/session/session_reader.hpp"

namespace tacto::schema {

Result<Checked> check_session(const std::string& path) {
  auto reader = SessionReader::open(path);
  TACTO_TRY(reader);
  Checked checked{{}, reader->header().newer_version};
  const SessionTotals totals = session_totals(*reader);
  if (totals.ending == SessionEnding::damaged)
    checked.findings.push_back(
        {fmt::format("{}, byte {}", path, reader->sound_bytes()), "is not a block with a correct checksum"});
  if (totals.end && totals.end->ticks != totals.ticks)
    checked.findings.push_back({path, fmt::format("its last block gives {} ticks, but there are {}",
                                                  totals.end->ticks, totals.ticks)});
  if (totals.samples > 0 && !reader->header().sensor)
    checked.findings.push_back(
        {path, "contains measured samples, but its header does not describe the sensor"});
  if (!totals.samples_grow)
    checked.findings.push_back({path, "its measured samples are not in the order of their frames"});
  return checked;
}

}  // namespace tacto::schema
