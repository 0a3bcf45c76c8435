// SPDX-License-Identifier: GPL-3.0-or-later
// The trade of a scene as a report, a table, pictures, and one HTML page.
#pragma once

#include <string>
#include <vector>

#include "analysis/trade/scene/scene_trade.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::analysis {

/// What was chosen or, without a request, the best choice of each knob; then all rows.
cli::Report scene_trade_report(const SceneTrade& trade);

std::vector<schema::ResultFigure> scene_trade_figures(const SceneTrade& trade);

/// Error against cost, one picture for each unit of cost, a curve for each knob and a mark for its knee.
std::vector<schema::ResultPicture> scene_trade_pictures(const SceneTrade& trade);

inline constexpr const char* kSceneTradeCsvHead = "choice_of,choice,error_n,";
std::string scene_trade_csv(const SceneTrade& trade);

/// Errors: those of drawing.
schema::Result<std::string> scene_trade_page(const SceneTrade& trade);

}  // namespace tacto::analysis
