// SPDX-License-Identifier: GPL-3.0-or-later
// From the encoder's edge to the drive that it makes, in either loop.
#pragma once

#include "analysis/trade/rows/trade_row.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::analysis {

// Only latency and memory are told: what either loop errs and costs on a machine of its own is not measured
// here, so neither is judged.

/// The device's loop reads and drives in one tick: half a tick's wait and the tick.
TradeRow device_loop_row(const playback::Prepared& prepared, double tick_ns);

/// This computer's loop, on an emulated device that keeps time, for half a second: measured, with the wire's
/// round trip; not under the real-time scheduler unless the user may have it. Where it can't be measured
/// the note says why, and the latency is what the loop's queue alone takes.
TradeRow host_loop_row(const playback::Prepared& prepared);

}  // namespace tacto::analysis
