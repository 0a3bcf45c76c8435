// SPDX-License-Identifier: GPL-3.0-or-later
// The report of `tactograph spatial` about a recording, its strokes and textures.
#pragma once

#include <string>
#include <vector>

#include "data-schema/report/report.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/job/stroke_job.hpp"
#include "spatial/strokes/touch_record.hpp"

namespace tacto::spatial {

/// The position's quantum and noise, wraps of its counter, and the force below which the finger is up.
void add_position(cli::Report& report, const TouchRecord& record);

/// A stroke: positions, speed, normal force, finger up or down.
cli::Report stroke_row(const TouchRecord& record, const StrokeJob& job);

/// The jumps of the position.
std::vector<cli::Report> jump_rows(const TouchRecord& record);

/// The common values of all textures of a recording; `texture` is one of them.
cli::Report head_of(const TouchRecord& record, const schema::Texture& texture);

cli::Report texture_row(const TouchRecord& record, const StrokeJob& job, const schema::Texture& texture);

/// The mean of several strokes, and the shift of each.
cli::Report average_row(const std::string& stem, const schema::Texture& texture);

}  // namespace tacto::spatial
