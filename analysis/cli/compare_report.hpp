// SPDX-License-Identifier: GPL-3.0-or-later
// The report of `compare`.
#pragma once

#include <string>
#include <vector>

#include "analysis/compare/compare.hpp"
#include "analysis/compare/compare_page.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::analysis {

/// The complete report: for --json, for results, and for the terminal if no files are written.
cli::Report compare_report(const ComparedNames& names, const Comparison& comparison);

/// At most 15 lines of at most 120 columns: for the terminal if the files `written` contain the rest.
cli::Report brief_compare_report(const ComparedNames& names, const Comparison& comparison,
                                 const std::vector<std::string>& written);

}  // namespace tacto::analysis
