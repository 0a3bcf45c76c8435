// SPDX-License-Identifier: GPL-3.0-or-later
// Import of a height map: a greyscale PNG, a surface, or a height profile.
#pragma once

#include <functional>
#include <string>

#include "capture/import/import.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/height/height_map.hpp"

namespace tacto::capture {

/// Whether the request is for a height map: its file is a PNG, or the name of its output ends in .height.nc.
bool is_height_map_request(const ImportRequest& request);

struct ImportedHeightMap {
  schema::HeightMap map;
  std::string path;  ///< NAME.height.nc
};

/// A PNG needs request.pitch_m and request.full_height_m; its lowest row of pixels is at y = 0, so that the
/// map lies in the plane as the picture on the screen. An X3P file becomes a map of all its points, its first
/// row at y = 0, unless a row or column is chosen. A profile (read_height_profile()) becomes a map of one
/// row. Errors: usage (a PNG without pitch or height, options that do not agree, an existing file); as
/// read_height_png, read_height_profile, write_height_map.
schema::Result<ImportedHeightMap> import_height_map(const ImportRequest& request,
                                                    const std::function<void(double)>& progress);

}  // namespace tacto::capture
