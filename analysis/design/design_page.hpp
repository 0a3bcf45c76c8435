// SPDX-License-Identifier: GPL-3.0-or-later
// The page, the table and the figures of `design`.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "analysis/design/design.hpp"

namespace tacto::analysis {

/// The answer in one sentence.
std::string design_verdict(const Design& design);

std::vector<schema::ResultFigure> design_figures(const Design& design);

inline constexpr const char* kDesignCsvHead = "patch,layer,type,stiffness_n_per_m,";

/// What a row of a layer's table has, as key and SI value; NaN or infinity: nothing.
struct LayerField {
  std::string key;
  std::variant<double, std::string> value;
};
std::vector<LayerField> layer_fields(const JudgedLayer& layer, const DesignRequest& request);

/// One line per layer. Precondition: there is a layer.
std::string design_csv(const Design& design);

/// The self-contained HTML page. `pictures`: of z_width(), or none. Errors: those of drawing.
schema::Result<std::string> design_page(const Design& design, const std::string& scene,
                                        const std::vector<schema::ResultPicture>& pictures);

}  // namespace tacto::analysis
