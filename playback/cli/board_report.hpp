// SPDX-License-Identifier: GPL-3.0-or-later
// What `explain --board` says of a board.
#pragma once

#include <optional>
#include <string>

#include "data-schema/command/verb.hpp"
#include "data-schema/report/report.hpp"
#include "playback/choose/board_cost.hpp"

namespace tacto::playback {

/// --board; `board` must outlive the parser.
CLI::Option* declare_board(CLI::App& app, std::string& board);

/// Adds clock, cycles of the dearest tick, its part of the period, and the largest rate.
void add_board_cost(cli::Report& report, const boards::Board& board, const BoardCost& cost, double rate_hz);

/// Why the board can't tick at this rate; none if it can.
std::optional<schema::Error> rate_fault(const boards::Board& board, const BoardCost& cost, double rate_hz);

}  // namespace tacto::playback
