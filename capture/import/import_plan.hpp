// SPDX-License-Identifier: GPL-3.0-or-later
// The plan of an import: errors in the request are reported before long data are read.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "capture/import/import.hpp"
#include "capture/table/channel_spec.hpp"
#include "capture/table/source.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::capture {

struct ImportPlan {
  Source source;
  std::vector<ChannelSpec> channels;
  std::optional<ScaledColumn> time;  ///< the time column
};

/// Opens the source and checks the request against it and against the output path. Errors: as import_file(),
/// except those in the data.
schema::Result<ImportPlan> plan_import(const ImportRequest& request);

/// Errors: unsuitable, for a rate that no recording can have.
schema::Result<void> check_rate_of_times(double rate_hz, const std::string& file);

/// Options for import as an example that can be typed: "--time-column 't_s' --channel
/// 'tangential_force=f*1N'".
std::string example_options(const Source& source);

/// The first column with a unit of time, if there is one.
std::optional<std::size_t> time_column_of(const Source& source);

/// The columns that the plan needs, without duplicates, in ascending order.
std::vector<std::size_t> columns_of(const ImportPlan& plan);

}  // namespace tacto::capture
