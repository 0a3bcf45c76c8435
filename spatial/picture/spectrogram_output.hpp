// SPDX-License-Identifier: GPL-3.0-or-later
// The format in which a spectrogram is written, by each path's extension: .png, .svg, .nc, .csv.
#pragma once

#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::spatial {

enum class OutputForm { picture, netcdf, table };

/// Precondition: check_outputs() accepted the path.
OutputForm form_of(const std::string& path);

/// Checks before any work is done that each path has a known extension, is named once, is free or is a
/// spectrogram that may be replaced, and is writable. Errors: usage; cannot_write.
schema::Result<void> check_outputs(std::span<const std::string> paths, schema::Existing existing);

}  // namespace tacto::spatial
