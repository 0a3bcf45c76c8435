// SPDX-License-Identifier: GPL-3.0-or-later
// A measured trade as pictures, as a table, and as one HTML page that needs no other files.
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
/// Pareto front. One axis has one unit, so the picture uses the unit of cost that most choices have. Rows
/// without a measured cost, and those with an error of 0 or 1, are left out.
spatial::LineFigure pareto_figure(const TradeHalf& half, const Trade& trade);

/// The same for each knob with at least two such rows, small enough for a telephone's screen.
std::vector<spatial::LineFigure> knob_figures(const TradeHalf& half, const Trade& trade);

/// The fronts as curves, one picture for each unit of cost, for NAME.results.json.
std::vector<schema::ResultPicture> trade_pictures(const Trade& trade);
std::vector<schema::ResultFigure> trade_figures(const Trade& trade);

/// half,knob,choice,error,cost_ns,per,memory_bytes,latency_s,on_front,knee,beaten_by,note,simulated,
/// worst_speed_mps, and error_at_...mmps for each of kTradeSpeeds_mps; empty if no such finger was measured.
std::string trade_csv(const Trade& trade);
inline constexpr const char* kTradeCsvHead = "half,knob,choice,error,";

/// The answers, then a picture of each knob, then all rows folded. Errors: those of drawing.
schema::Result<std::string> trade_page(const Trade& trade);

}  // namespace tacto::analysis
