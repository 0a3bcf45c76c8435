// SPDX-License-Identifier: GPL-3.0-or-later
// Latency from the encoder's edge to the resulting drive, in the device's and in the host's loop.
#pragma once

#include "analysis/trade/rows/trade_row.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::analysis {

// Only latency and memory are reported. Error and cost of a loop are not measured here, so neither loop is
// judged.

/// The device's loop reads and drives in one tick: half a tick of waiting on average, and the tick.
TradeRow device_loop_row(const playback::Prepared& prepared, double tick_ns);

/// The loop of this computer with an emulated device that runs in real time, for half a second: measured,
/// with the wire's round trip; with the real-time scheduler only if the user has the right. If it cannot be
/// measured, the note gives the reason, and the latency is that of the loop's queue alone.
TradeRow host_loop_row(const playback::Prepared& prepared);

}  // namespace tacto::analysis
