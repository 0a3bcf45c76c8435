// SPDX-License-Identifier: GPL-3.0-or-later
// A height map: heights of a surface on an even grid in a plane, as NAME.height.nc.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::schema {

/// Limits of what is stored: 1 GB of heights; no relief is deeper, and no grid finer.
inline constexpr std::size_t kMostHeights = std::size_t{1} << 28;
inline constexpr double kLargestHeight_m = 1, kLeastHeightPitch_m = 1e-8, kLargestHeightPitch_m = 10;

/// Row by row, from the smallest y on; in a row x increases. A profile is a map of one row: its heights are
/// the same at every y.
struct HeightMap {
  std::size_t columns = 0, rows = 0;
  double pitch_m = 0;  ///< from height to height, along x and y
  std::vector<float> height_m;
  std::string surface, notes, source;  ///< source: the imported file and its SHA-256
  std::string created, creator;
  std::string newer_version = {};  ///< set by the reader if the file's minor version is newer than ours
};

struct HeightFigures {
  double lowest_m = 0, highest_m = 0;
  double rms_slope = 0;  ///< of the differences of neighbours along x and y: sqrt(mean dx^2 + mean dy^2)
};

/// Precondition: a map as check_height_map() accepts it.
HeightFigures figures_of(const HeightMap& map);

/// NAME.height.nc of a stem or file name.
std::string height_map_path(const std::string& name);

/// netCDF-4: variable `height` (m, single precision) over `y` and `x` (m, from the first height), pitch_m and
/// the texts as attributes. Errors: as check_height_map, PendingFiles.
Result<void> write_height_map(const std::string& path, const HeightMap& map, Existing existing);

/// A solid with the heights above and a flat face at `base_m` below, as binary STL in millimetres: closed,
/// each edge of two triangles, (0, 0) is the first height. Errors: unsuitable: fewer than 2 columns or rows,
/// a height at `base_m` or below it, more than 2^31 triangles; PendingFiles.
Result<void> write_height_stl(const std::string& path, const HeightMap& map, double base_m,
                              Existing existing);

/// By stem or NAME.height.nc. Errors: not_found; malformed: not netCDF, or of another kind, without a pitch
/// or without heights; as check_height_map; unsupported_version.
Result<HeightMap> read_height_map(const std::string& name);

/// Whether it is netCDF of that kind.
bool is_height_map(const std::string& path);

}  // namespace tacto::schema
