// SPDX-License-Identifier: GPL-3.0-or-later
// The entries of a report, for its printers.
#pragma once

#include "data-schema/report/report.hpp"

namespace tacto::cli {

struct ReportPrinter {
  using Value = Report::Value;
  static const auto& entries(const Report& report) { return report.entries_; }
};

}  // namespace tacto::cli
