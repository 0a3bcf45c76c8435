// SPDX-License-Identifier: GPL-3.0-or-later
// What a recording says of the file it was imported from.
#pragma once

#include <string>
#include <vector>

#include "capture/import/import_plan.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// All that is known before the data are read. Of a plan with a time column the rate is not set.
schema::RecordingHeader import_header(const ImportRequest& request, const ImportPlan& plan);

/// One line, or none where there are no gaps.
std::vector<std::string> gap_warnings(const std::vector<schema::Gap>& gaps);

}  // namespace tacto::capture
