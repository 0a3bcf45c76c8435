// SPDX-License-Identifier: GPL-3.0-or-later
// A measured trade as pictures, as a table, and as one page that needs nothing beside it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/trade/rows/trade_row.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/results/results.hpp"
#include "spatial/picture/line_plot.hpp"

namespace tacto::analysis {

struct TradeHalf {
  std::string name;  ///< "offline", "real time"
  std::vector<TradeRow> rows;
};

struct Trade {
  std::string texture, machine, simulated;
  std::vector<TradeHalf> halves;
};

/// Error against cost of one half: a mark for each choice of the six knobs that have most of them, and the
/// front that none beats. Of the unit of cost that most choices have: one axis has one unit. Rows whose cost
/// was not measured, and those that err by nothing or by all, are left out.
spatial::LineFigure pareto_figure(const TradeHalf& half, const Trade& trade);

/// The same of each knob that has two such rows or more, small enough for a telephone's screen.
std::vector<spatial::LineFigure> knob_figures(const TradeHalf& half, const Trade& trade);

/// The fronts as curves, one picture for each unit of cost, for NAME.results.json.
std::vector<schema::ResultPicture> trade_pictures(const Trade& trade);
std::vector<schema::ResultFigure> trade_figures(const Trade& trade);

/// half,knob,choice,error,cost_ns,per,memory_bytes,latency_s,on_front,knee,beaten_by,note,simulated,
/// worst_speed_mps, and error_at_...mmps for each of kTradeSpeeds_mps; empty where no such finger goes.
std::string trade_csv(const Trade& trade);
inline constexpr const char* kTradeCsvHead = "half,knob,choice,error,";

/// The answers, then a picture of each knob, then all rows folded. Errors: of drawing.
schema::Result<std::string> trade_page(const Trade& trade);

}  // namespace tacto::analysis
