// SPDX-License-Identifier: GPL-3.0-or-later
// What a report holds, for those who print it. Internal to this folder.
#pragma once

#include "data-schema/report/report.hpp"

namespace tacto::cli {

struct ReportPrinter {
  using Value = Report::Value;
  static const auto& entries(const Report& report) { return report.entries_; }
};

}  // namespace tacto::cli
