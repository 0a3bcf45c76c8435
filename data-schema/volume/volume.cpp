// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/volume/volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "data-schema/base/format_version.hpp"
#include "data-schema/base/sha256.hpp"
#include "data-schema/spectrogram/netcdf_file.hpp"

namespace tacto::schema {
namespace {

constexpr const char* kVolumeKind = "volume";
constexpr std::string_view kVolumeEnding = ".volume.nc";
constexpr const char* kGridAxes[] = {"x", "y", "z"};
constexpr const char* kSpacings[] = {"spacing_x_m", "spacing_y_m", "spacing_z_m"};

std::string volume_sum(const Volume& volume) {
  Sha256 sum;
  sum.add({reinterpret_cast<const char*>(volume.stored.data()), std::span(volume.stored).size_bytes()});
  return sum.hexadecimal();
}

// One layer after the other: as doubles all would need four times the memory.
Result<void> write_volume_netcdf(const std::string& path, const std::string& named, const Volume& volume) {
  constexpr std::size_t kBlock = 64;
  NetcdfWriter file(path);
  const auto& [columns, rows, layers] = volume.samples;
  int of[3];
  for (std::size_t i = 0; i < 3; ++i) of[i] = file.dimension(kGridAxes[i], volume.samples[i]);
  int along[3];
  for (std::size_t i = 0; i < 3; ++i) along[i] = file.axis(kGridAxes[i], of[i], "m", "from the middle");
  const int value = file.shorts(
      "value", {{of[2], of[1], of[0]}, {1, std::min(rows, kBlock), std::min(columns, 4 * kBlock)}},
      volume.scale, volume.offset, "value of a voxel");
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<double> place_m(volume.samples[i]);
    for (std::size_t j = 0; j < place_m.size(); ++j)
      place_m[j] =
          (static_cast<double>(j) - static_cast<double>(place_m.size() - 1) / 2) * volume.spacing_m[i];
    file.put(along[i], place_m);
    file.attribute(kSpacings[i], volume.spacing_m[i]);
  }
  std::vector<double> layer(columns * rows);
  for (std::size_t z = 0; z < layers; ++z) {
    std::copy_n(volume.stored.begin() + static_cast<std::ptrdiff_t>(volume.at(0, 0, z)), layer.size(),
                layer.begin());
    file.put(value, {{z, 0, 0}, {1, rows, columns}}, std::span<const double>(layer));
  }
  file.attribute("Conventions", std::string("CF-1.10"));
  file.attribute("kind", std::string(kVolumeKind));
  file.attribute("version", std::string(kFormatVersion));
  file.attribute("sha256", volume_sum(volume));
  for (const auto& [name, text] : {std::pair<const char*, const std::string&>{"notes", volume.notes},
                                   {"source", volume.source},
                                   {"created", volume.created},
                                   {"creator", volume.creator}})
    if (!text.empty()) file.attribute(name, text);
  return file.close(named);
}

Result<void> read_values(NetcdfReader& file, const std::string& path, Volume& volume) {
  volume.stored.reserve(volume.samples[0] * volume.samples[1] * volume.samples[2]);
  for (std::size_t z = 0; z < volume.samples[2]; ++z) {
    const auto layer = file.values("value", {{z, 0, 0}, {1, volume.samples[1], volume.samples[0]}});
    TACTO_TRY(file.status(path));
    for (const double value : layer) {
      if (!(value >= INT16_MIN && value <= INT16_MAX) || value != std::floor(value))
        return fail(ErrorKind::malformed,
                    fmt::format("the stored value {} is no whole number of 16 bits", value), path,
                    "store `value` as 16-bit integers, with scale_factor and add_offset");
      volume.stored.push_back(static_cast<std::int16_t>(value));
    }
  }
  return {};
}

}  // namespace

VolumePoint Volume::half_size_m() const {
  VolumePoint half;
  for (std::size_t i = 0; i < 3; ++i) half[i] = static_cast<double>(samples[i] - 1) * spacing_m[i] / 2;
  return half;
}

bool value_at(const Volume& volume, const VolumePoint& place_m, VolumeValue& found) {
  std::array<std::size_t, 3> first;
  VolumePoint part;
  for (std::size_t i = 0; i < 3; ++i) {
    const double at = (place_m[i] + volume.half_size_m()[i]) / volume.spacing_m[i];
    if (!(at >= 0 && at < static_cast<double>(volume.samples[i] - 1))) return false;
    first[i] = static_cast<std::size_t>(at);
    part[i] = at - std::floor(at);
  }
  found = {};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::array<std::size_t, 3> up = {corner & 1, corner >> 1 & 1, corner >> 2};
    VolumePoint weight, rise;
    for (std::size_t i = 0; i < 3; ++i) {
      weight[i] = up[i] != 0 ? part[i] : 1 - part[i];
      rise[i] = (up[i] != 0 ? 1 : -1) / volume.spacing_m[i];
    }
    const double value =
        volume.value(volume.stored[volume.at(first[0] + up[0], first[1] + up[1], first[2] + up[2])]);
    found.value += value * weight[0] * weight[1] * weight[2];
    for (std::size_t i = 0; i < 3; ++i)
      found.slope_per_m[i] += value * rise[i] * weight[(i + 1) % 3] * weight[(i + 2) % 3];
  }
  return true;
}

// Along each axis its square is convex in a cell: it is largest in a corner.
double steepest_per_m(const Volume& volume, double above) {
  double most = 0;
  const std::size_t step[3] = {1, volume.samples[0], volume.samples[0] * volume.samples[1]};
  const double stored_above = (above - volume.offset) / volume.scale;
  VolumePoint per_m;
  for (std::size_t i = 0; i < 3; ++i) per_m[i] = volume.scale / volume.spacing_m[i];
  for (std::size_t z = 0; z + 1 < volume.samples[2]; ++z)
    for (std::size_t y = 0; y + 1 < volume.samples[1]; ++y)
      for (std::size_t x = 0; x + 1 < volume.samples[0]; ++x) {
        const std::int16_t* const first = volume.stored.data() + volume.at(x, y, z);
        int corner[8], largest = INT16_MIN;
        for (std::size_t i = 0; i < 8; ++i)
          largest = std::max(
              largest, corner[i] = first[(i & 1) * step[0] + (i >> 1 & 1) * step[1] + (i >> 2) * step[2]]);
        if (!(largest > stored_above)) continue;
        for (std::size_t i = 0; i < 8; ++i) {
          double square = 0;
          for (std::size_t axis = 0; axis < 3; ++axis)
            square += std::pow((corner[i] - corner[i ^ 1U << axis]) * per_m[axis], 2);
          most = std::max(most, square);
        }
      }
  return std::sqrt(most);
}

Result<void> check_volume(const Volume& volume, const std::string& where) {
  const auto unsuitable = [&](std::string what, std::string remedy) {
    return fail(ErrorKind::unsuitable, std::move(what), where, std::move(remedy));
  };
  std::size_t values = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t count = volume.samples[i];
    if (count < 2 || count > kMostVoxelsAlong)
      return unsuitable(fmt::format("it has {} values along {}", count, kGridAxes[i]),
                        fmt::format("from 2 to {} are possible", kMostVoxelsAlong));
    values *= count;
  }
  if (values > kMostVoxels)
    return unsuitable(
        fmt::format("it has {} values", values),
        fmt::format("at most {} are possible; crop it, or give it a larger spacing", kMostVoxels));
  for (std::size_t i = 0; i < 3; ++i) {
    const double spacing_m = volume.spacing_m[i],
                 size_m = spacing_m * static_cast<double>(volume.samples[i] - 1);
    if (!(spacing_m >= kLeastVoxel_m && size_m <= kLargestVolume_m))
      return unsuitable(fmt::format("its values are {:.4g} m apart along {}, which makes {:.4g} m", spacing_m,
                                    kGridAxes[i], size_m),
                        fmt::format("from {:g} m apart to {:g} m in all are possible: is the unit right?",
                                    kLeastVoxel_m, kLargestVolume_m));
  }
  if (!(volume.scale > 0 && std::isfinite(volume.scale) && std::isfinite(volume.offset)))
    return unsuitable(fmt::format("its scale is {}, its offset {}", volume.scale, volume.offset),
                      "value = stored x scale + offset, with a scale above 0");
  if (!volume.stored.empty() && volume.stored.size() != values)
    return unsuitable(fmt::format("it has {} values, but {} places", volume.stored.size(), values),
                      "give as many values");
  return {};
}

std::string volume_path(const std::string& name) {
  return name.ends_with(kVolumeEnding) ? name : name + std::string(kVolumeEnding);
}

Result<void> write_volume(const std::string& path, const Volume& volume, Existing existing) {
  TACTO_TRY(check_volume(volume, path));
  PendingFiles files;
  const auto temporary = files.add(path);
  TACTO_TRY(temporary);
  TACTO_TRY(write_volume_netcdf(*temporary, path, volume));
  return files.commit(existing);
}

Result<Volume> read_volume(const std::string& name) {
  const std::string path = volume_path(name);
  constexpr const char* kMaker = "'tactograph import' makes one from an NRRD file";
  if (!is_file(path)) return fail(ErrorKind::not_found, "there is no such volume", path, kMaker);
  NetcdfReader file(path);
  TACTO_TRY(file.status(path));
  if (file.text("kind") != kVolumeKind)
    return fail(ErrorKind::malformed, "is netCDF, but not a volume of tactograph", path, kMaker);
  auto newer = newer_version(file.text("version"), path, path);
  TACTO_TRY(newer);
  Volume volume;
  volume.newer_version = std::move(*newer);
  for (std::size_t i = 0; i < 3; ++i) {
    volume.samples[i] = file.length(kGridAxes[i]);
    volume.spacing_m[i] = file.number(kSpacings[i]);
    if (std::isnan(volume.spacing_m[i]))
      return fail(ErrorKind::malformed,
                  fmt::format("has no spacing of its values: {} is missing", kSpacings[i]), path, kMaker);
  }
  if (const double scale = file.number("scale_factor", "value"); !std::isnan(scale)) volume.scale = scale;
  if (const double offset = file.number("add_offset", "value"); !std::isnan(offset)) volume.offset = offset;
  TACTO_TRY(file.status(path));
  TACTO_TRY(check_volume(volume, path));
  TACTO_TRY(read_values(file, path, volume));
  if (const std::string sum = file.text("sha256"); !sum.empty() && sum != volume_sum(volume))
    return fail(ErrorKind::malformed,
                "its values do not match its checksum (attribute sha256): a number was changed", path,
                "import the volume again; to keep the change, remove the attribute");
  volume.notes = file.text("notes"), volume.source = file.text("source");
  volume.created = file.text("created"), volume.creator = file.text("creator");
  TACTO_TRY(file.status(path));
  return volume;
}

bool is_volume(const std::string& path) {
  return NetcdfReader(path).text("kind") == kVolumeKind;
}

}  // namespace tacto::schema
