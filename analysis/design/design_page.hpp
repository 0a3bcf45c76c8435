// SPDX-License-Identifier: GPL-3.0-or-later
// The page, the table and the figures of `design`.
#pragma once

#include <string>
#include <vector>

#include "analysis/design/design.hpp"

namespace tacto::analysis {

/// The answer in one sentence.
std::string design_verdict(const Design& design);

std::vector<schema::ResultFigure> design_figures(const Design& design);

inline constexpr const char* kDesignCsvHead = "patch,layer,type,stiffness_n_per_m,";

/// One line per layer, in SI units; a limit that was not asked for is empty.
std::string design_csv(const Design& design);

/// The self-contained HTML page. `pictures`: of z_width(), or none. Errors: those of drawing.
schema::Result<std::string> design_page(const Design& design, const std::string& scene,
                                        const std::vector<schema::ResultPicture>& pictures);

}  // namespace tacto::analysis
