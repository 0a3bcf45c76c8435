// SPDX-License-Identifier: GPL-3.0-or-later
// The picture of a hysteresis: the largest loop, and the fitted operator's loop.
#pragma once

#include "analysis/identify/fit/hysteresis_loop.hpp"
#include "spatial/picture/line_plot.hpp"

namespace tacto::analysis {

/// Displacement over drive, without the linear model's lag. `found` is the resulting transducer.
spatial::LineFigure loop_figure(const LoopFit& fit, const schema::Transducer& found);

}  // namespace tacto::analysis
