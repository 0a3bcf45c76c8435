// SPDX-License-Identifier: GPL-3.0-or-later
// The report of `compare`.
#pragma once

#include <string>
#include <vector>

#include "analysis/compare/compare.hpp"
#include "analysis/compare/compare_page.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::analysis {

/// The whole report, the verdict first.
cli::Report compare_report(const ComparedNames& names, const Comparison& comparison);

}  // namespace tacto::analysis
