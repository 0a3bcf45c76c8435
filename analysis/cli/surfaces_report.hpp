// SPDX-License-Identifier: GPL-3.0-or-later
// The report of `compare` on surfaces.
#pragma once

#include "analysis/compare/surfaces.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::analysis {

/// The complete report: for --json and for results.
cli::Report surfaces_report(const SurfaceComparison& comparison);

/// The main figures, for the terminal.
cli::Report brief_surfaces_report(const SurfaceComparison& comparison);

}  // namespace tacto::analysis
