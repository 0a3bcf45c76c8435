// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/describe.hpp"

namespace tacto::schema {

cli::Report report_of(FileKind kind, const std::string& path, const std::string& simulated) {
  cli::Report report;
  report.add("file", path).add("kind", kind_name(kind));
  add_text(report, "simulated", simulated);
  return report;
}

void add_text(cli::Report& report, const char* key, const std::string& text) {
  if (!text.empty()) report.add(key, text);
}

}  // namespace tacto::schema
