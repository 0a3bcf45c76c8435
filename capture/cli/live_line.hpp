// SPDX-License-Identifier: GPL-3.0-or-later
// A recording under way as one line of a terminal.
#pragma once

#include <string>

#include "capture/record/live_view.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// "12.3 s  CLIP net_force   48 mm/s ok  load 0.90 N LESS  3 strokes  0 lost  normal_force [###-----]
/// net_force [########]  12.4 GB left": what clips, speed and load against their target bands with what to do
/// about them, levels as parts of their converters' ranges ("peaks 37/100 %" where bars have no room: 80
/// columns). Without colours, for every terminal; at most one line of `columns` characters.
std::string live_line(const LiveView& view, const schema::RecordingHeader& header, std::size_t columns);

}  // namespace tacto::capture
