// SPDX-License-Identifier: GPL-3.0-or-later
// An import thought through before it is made: what is wrong with the request is said before long data are
// read.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "capture/import/import.hpp"
#include "capture/table/channel_spec.hpp"
#include "capture/table/source.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::capture {

struct ImportPlan {
  Source source;
  std::vector<ChannelSpec> channels;
  std::optional<ScaledColumn> time;  ///< the column that gives the clock
};

/// Opens the source and checks the request against it and against the place of the output.
/// Errors: as import_file(), but those of the data themselves.
schema::Result<ImportPlan> plan_import(const ImportRequest& request);

/// The columns that the plan needs, each once, growing.
std::vector<std::size_t> columns_of(const ImportPlan& plan);

}  // namespace tacto::capture
