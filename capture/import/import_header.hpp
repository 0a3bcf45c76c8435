// SPDX-License-Identifier: GPL-3.0-or-later
// The header of an imported recording.
#pragma once

#include <string>
#include <vector>

#include "capture/import/import_plan.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// The part that is known before the data are read. With a time column, the rate is not set yet.
schema::RecordingHeader import_header(const ImportRequest& request, const ImportPlan& plan);

/// One line, or none if there are no gaps.
std::vector<std::string> gap_warnings(const std::vector<schema::Gap>& gaps);

}  // namespace tacto::capture
