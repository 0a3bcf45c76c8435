// SPDX-License-Identifier: GPL-3.0-or-later
// A volume: values on an even grid in space, as of a CT scan, as NAME.volume.nc.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::schema {

/// Limits of what is stored: 256 MB of values.
inline constexpr std::size_t kMostVoxels = std::size_t{1} << 27, kMostVoxelsAlong = 4096;
inline constexpr double kLeastVoxel_m = 1e-7, kLargestVolume_m = 10;

using VolumePoint = std::array<double, 3>;

/// x, y and z are the axes of the grid. Its middle is half way between the first and the last value.
struct Volume {
  std::array<std::size_t, 3> samples = {};  ///< along x, y and z
  VolumePoint spacing_m = {};               ///< between values
  std::vector<std::int16_t> stored;         ///< along x first, then y, then z
  double scale = 1, offset = 0;             ///< value = stored x scale + offset
  std::string source, notes;                ///< source: the imported file and its SHA-256
  std::string created, creator;
  std::string newer_version = {};  ///< set by the reader if the file's minor version is newer than ours

  std::size_t at(std::size_t x, std::size_t y, std::size_t z) const {
    return (z * samples[1] + y) * samples[0] + x;
  }
  double value(std::int16_t each) const { return each * scale + offset; }
  /// From the middle to the outermost values.
  VolumePoint half_size_m() const;
};

/// Of the trilinear interpolant of the values.
struct VolumeValue {
  double value = 0;
  VolumePoint slope_per_m = {};  ///< its exact gradient
};

/// At a place from the middle: the sum of the eight values around it, by their weights. Beyond the outermost
/// values false.
bool value_at(const Volume& volume, const VolumePoint& place_m, VolumeValue& found);

/// The largest gradient of the interpolant, in all cells with a value above `above`.
double steepest_per_m(const Volume& volume, double above);

/// Errors, at `where`: unsuitable: fewer than 2 or too many values, another number of them than its samples,
/// a spacing or size out of range, a scale that is not above 0.
Result<void> check_volume(const Volume& volume, const std::string& where);

/// NAME.volume.nc of a stem or file name.
std::string volume_path(const std::string& name);

/// netCDF-4: variable `value` (16 bits, with scale_factor and add_offset) over `z`, `y` and `x` (m, from the
/// middle), spacing_x_m, spacing_y_m, spacing_z_m, the texts as attributes, and `sha256`, of the bytes of
/// `value`, little-endian. Errors: as check_volume, PendingFiles.
Result<void> write_volume(const std::string& path, const Volume& volume, Existing existing);

/// By stem or NAME.volume.nc. Errors: not_found; malformed: not netCDF, of another kind, without spacings or
/// values, a value that is no whole number of 16 bits, or of another sha256 than it states; as check_volume;
/// unsupported_version.
Result<Volume> read_volume(const std::string& name);

/// Whether it is netCDF of that kind.
bool is_volume(const std::string& path);

}  // namespace tacto::schema
