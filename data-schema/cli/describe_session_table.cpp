// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/describe.hpp"
#include "data-schema/session/session_netcdf.hpp"

namespace tacto::schema {

Result<cli::Report> describe_session_table(const std::string& path) {
  const auto table = read_session_table(path);
  TACTO_TRY(table);
  cli::Report report = report_of(FileKind::session_table, path, table->simulated);
  add_text(report, "created", table->created);
  add_text(report, "creator", table->creator);
  add_text(report, "device", table->device);
  add_text(report, "transducer", table->transducer);
  report.add("rate_hz", table->rate_hz).add("ticks", table->times).add("duration_s", table->duration_s);
  report.add("textures", table->textures);
  if (!table->changes.empty()) report.add("changes", table->changes);
  return report;
}

}  // namespace tacto::schema
