// SPDX-License-Identifier: GPL-3.0-or-later
// The page, the table and the figures of `design`.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/design/design.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::analysis {

/// What is true of the whole scene; among it by how much the simulated limit of layers with a virtual damper
/// is below the computed one.
cli::Report design_head(const Design& design);

std::vector<schema::ResultFigure> design_figures(const Design& design);

inline constexpr const char* kDesignCsvHead = "patch,layer,type,stiffness_n_per_m,";

/// Keys and SI values of a row; NaN or infinity: nothing.
using DesignRow = std::vector<std::pair<std::string, std::variant<double, std::size_t, std::string>>>;

/// The tables of the verb and of the page, without empty columns.
struct DesignTables {
  std::vector<cli::Report> layers, needs, remedies;
};
DesignTables design_tables(const Design& design);

/// One line per layer. Precondition: there is a layer.
std::string design_csv(const Design& design);

/// The self-contained HTML page. `pictures`: of z_width(), or none. Errors: those of drawing.
schema::Result<std::string> design_page(const Design& design, const std::string& scene,
                                        const std::vector<schema::ResultPicture>& pictures);

}  // namespace tacto::analysis
