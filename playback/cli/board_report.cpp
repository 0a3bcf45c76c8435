// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/cli/board_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace tacto::playback {

using boards::Board;

CLI::Option* declare_board(CLI::App& app, std::string& board) {
  std::vector<std::string> names;
  for (const Board& each : boards::kBoards) names.emplace_back(each.name);
  return app
      .add_option(
          "--board", board,
          fmt::format("Compare with a microcontroller board that has our firmware ({}): the room for "
                      "samples or the scene, and the cycles of a tick, estimated from instruction counts",
                      fmt::join(names, ", ")))
      ->check(CLI::IsMember(names));
}

void add_board_cost(cli::Report& report, const Board& board, const BoardCost& cost, double rate_hz) {
  report.add("board", board.name).add("board_clock_hz", 1.0 * board.clock_hz);
  report.add("board_tick_cycles", cost.tick_cycles)
      .add("board_tick_of_period_percent", 100 * cost.tick_cycles * rate_hz / board.clock_hz)
      .add("largest_rate_hz", cost.largest_rate_hz);
  report.add("board_tick_by",
             fmt::format("estimated from instruction counts in QEMU, {} cycles each; not measured on a chip",
                         boards::kCyclesPerInstruction));
}

std::optional<schema::Error> rate_fault(const Board& board, const BoardCost& cost, double rate_hz) {
  const auto fault = [&](std::string what, std::string remedy) {
    return schema::Error{schema::ErrorKind::unsuitable, std::move(what), board.name, std::move(remedy)};
  };
  if (rate_hz < board.least_rate_hz)
    return fault(
        fmt::format("the board ticks at {} Hz or more, not at {:g} Hz", board.least_rate_hz, rate_hz),
        fmt::format("choose --rate {}Hz", board.least_rate_hz));
  if (rate_hz <= cost.largest_rate_hz) return std::nullopt;
  const double largest_hz = cost.largest_rate_hz;
  if (largest_hz < board.least_rate_hz)
    return fault(
        fmt::format("{:.0f} cycles of a tick, and the sending, do not fit into a period at its least "
                    "rate, {} Hz (estimated)",
                    cost.tick_cycles, board.least_rate_hz),
        "a scene of fewer layers costs less");
  return fault(fmt::format("the board ticks at up to {:g} Hz here, not at {:g} Hz{}", largest_hz, rate_hz,
                           largest_hz < board.most_rate_hz ? " (estimated)" : ""),
               fmt::format("choose --rate {:g}Hz", largest_hz));
}

}  // namespace tacto::playback
