// SPDX-License-Identifier: GPL-3.0-or-later
// What `compare` prints.
#pragma once

#include <string>
#include <vector>

#include "analysis/compare/compare.hpp"
#include "analysis/compare/compare_page.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::analysis {

/// All of it: for --json, for results, and for people where nothing is written.
cli::Report compare_report(const ComparedNames& names, const Comparison& comparison);

/// At most 15 lines of at most 120 columns: for people where the rest is in the files `written`.
cli::Report brief_compare_report(const ComparedNames& names, const Comparison& comparison,
                                 const std::vector<std::string>& written);

}  // namespace tacto::analysis
