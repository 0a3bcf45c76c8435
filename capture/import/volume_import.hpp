// SPDX-License-Identifier: GPL-3.0-or-later
// Import of an NRRD file as a volume.
#pragma once

#include <string>

#include "capture/import/import.hpp"
#include "data-schema/exchange/nrrd_file.hpp"

namespace tacto::capture {

struct ImportedVolume {
  schema::NrrdVolume read;
  std::string path;
};

/// Whether the file is a volume by its name.
bool is_volume_request(const ImportRequest& request);

/// Reads it and writes NAME.volume.nc. Errors: usage: options of other files; as schema::read_nrrd(),
/// schema::write_volume().
schema::Result<ImportedVolume> import_volume(const ImportRequest& request);

}  // namespace tacto::capture
