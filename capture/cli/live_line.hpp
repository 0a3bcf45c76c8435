// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a running recording as one line of a terminal.
#pragma once

#include <string>

#include "capture/record/live_view.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// "12.3 s  CLIP net_force   48 mm/s ok  load 0.90 N LESS  3 strokes  0 lost  normal_force [###-----]
/// net_force [########]  12.4 GB left": the clipped channels; speed and load compared with their target
/// bands, with the correction; levels as fractions of the converter's range ("peaks 37/100 %" if there is no
/// room for bars: 80 columns). Without colours, for every terminal; at most one line of `columns` characters.
std::string live_line(const LiveView& view, const schema::RecordingHeader& header, std::size_t columns);

}  // namespace tacto::capture
