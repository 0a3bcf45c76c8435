// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/height/height_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/base/format_version.hpp"
#include "data-schema/spectrogram/netcdf_file.hpp"

namespace tacto::schema {
namespace {

constexpr const char* kHeightMapKind = "height_map";
constexpr std::string_view kHeightEnding = ".height.nc";
constexpr std::size_t kHeightBlock = 256;  // rows and columns of a block in the file

double mean_square_step(const HeightMap& map, std::size_t stride, std::size_t columns, std::size_t rows) {
  if (columns * rows == 0) return 0;
  double sum = 0;
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const float* const at = map.height_m.data() + j * map.columns + i;
      const double step = double{at[stride]} - double{*at};
      sum += step * step;
    }
  return sum / static_cast<double>(columns * rows);
}

void put_axis(NetcdfWriter& file, int variable, std::size_t count, double pitch_m) {
  std::vector<double> places(count);
  for (std::size_t i = 0; i < count; ++i) places[i] = static_cast<double>(i) * pitch_m;
  file.put(variable, places);
}

// `path` is a temporary name of what will be `named`.
Result<void> write_netcdf(const std::string& path, const std::string& named, const HeightMap& map) {
  NetcdfWriter file(path);
  const int y = file.dimension("y", map.rows), x = file.dimension("x", map.columns);
  const int y_axis = file.axis("y", y, "m", "place along y"),
            x_axis = file.axis("x", x, "m", "place along x");
  const int height =
      file.cells("height", {{y, x}, {std::min(map.rows, kHeightBlock), std::min(map.columns, kHeightBlock)}},
                 true, "m", "height");
  put_axis(file, y_axis, map.rows, map.pitch_m);
  put_axis(file, x_axis, map.columns, map.pitch_m);
  for (std::size_t row = 0; row < map.rows; row += kHeightBlock) {
    const std::size_t count = std::min(kHeightBlock, map.rows - row);
    file.put(height, {{row, 0}, {count, map.columns}},
             std::span(map.height_m).subspan(row * map.columns, count * map.columns));
  }
  file.attribute("Conventions", std::string("CF-1.10"));
  file.attribute("kind", std::string(kHeightMapKind));
  file.attribute("version", std::string(kFormatVersion));
  file.attribute("pitch_m", map.pitch_m);
  const std::pair<const char*, const std::string&> texts[] = {{"surface", map.surface},
                                                              {"notes", map.notes},
                                                              {"source", map.source},
                                                              {"created", map.created},
                                                              {"creator", map.creator}};
  for (const auto& [name, text] : texts)
    if (!text.empty()) file.attribute(name, text);
  return file.close(named);
}

// Errors, at `where`: unsuitable: no heights, more than kMostHeights, a height that is not a number or
// beyond 1 m (with its column and row), a pitch outside 10 nm to 10 m.
Result<void> check_height_map(const HeightMap& map, const std::string& where) {
  if (!(map.pitch_m >= kLeastHeightPitch_m && map.pitch_m <= kLargestHeightPitch_m))
    return fail(ErrorKind::unsuitable, fmt::format("its pitch is {:g} m", map.pitch_m), where,
                "a height map needs the distance between its heights, from 10 nm to 10 m");
  if (map.height_m.empty() || map.height_m.size() > kMostHeights ||
      map.height_m.size() != map.columns * map.rows)
    return fail(ErrorKind::unsuitable, fmt::format("it has {} x {} heights", map.columns, map.rows), where,
                fmt::format("a height map has from 1 to {} heights; cut or resample it", kMostHeights));
  const auto wrong = std::ranges::find_if(
      map.height_m, [](float height) { return !(std::abs(height) <= static_cast<float>(kLargestHeight_m)); });
  if (wrong == map.height_m.end()) return {};
  const auto at = static_cast<std::size_t>(wrong - map.height_m.begin());
  return fail(
      ErrorKind::unsuitable,
      fmt::format("the height in column {}, row {} is {} m", at % map.columns, at / map.columns, *wrong),
      where, "heights are numbers within 1 m; fill in what the instrument did not measure");
}

}  // namespace

HeightFigures figures_of(const HeightMap& map) {
  const auto [low, high] = std::ranges::minmax(map.height_m);
  const double square = mean_square_step(map, 1, map.columns - 1, map.rows) +
                        mean_square_step(map, map.columns, map.columns, map.rows - 1);
  return {double{low}, double{high}, std::sqrt(square) / map.pitch_m};
}

std::string height_map_path(const std::string& name) {
  return name.ends_with(kHeightEnding) ? name : name + std::string(kHeightEnding);
}

Result<void> write_height_map(const std::string& path, const HeightMap& map, Existing existing) {
  TACTO_TRY(check_height_map(map, path));
  PendingFiles files;
  const auto temporary = files.add(path);
  TACTO_TRY(temporary);
  TACTO_TRY(write_netcdf(*temporary, path, map));
  return files.commit(existing);
}

Result<HeightMap> read_height_map(const std::string& name) {
  const std::string path = height_map_path(name);
  if (!is_file(path))
    return fail(ErrorKind::not_found, "there is no such height map", path,
                "'tactograph import' makes one from a 16-bit PNG or a profile");
  NetcdfReader file(path);
  TACTO_TRY(file.status(path));
  if (file.text("kind") != kHeightMapKind)
    return fail(ErrorKind::malformed, "is netCDF, but not a height map of tactograph", path,
                "'tactograph import' makes one from a 16-bit PNG or a profile");
  auto newer = newer_version(file.text("version"), path, path);
  TACTO_TRY(newer);
  HeightMap map;
  map.newer_version = std::move(*newer);
  map.columns = file.length("x"), map.rows = file.length("y");
  map.pitch_m = file.number("pitch_m");
  if (map.columns > 0 && map.rows > 0 && map.columns <= kMostHeights / map.rows)
    map.height_m = file.cells("height", {{0, 0}, {map.rows, map.columns}});
  map.surface = file.text("surface"), map.notes = file.text("notes"), map.source = file.text("source");
  map.created = file.text("created"), map.creator = file.text("creator");
  TACTO_TRY(file.status(path));
  if (file.has("height") && file.units("height") != "m")
    return fail(ErrorKind::malformed, fmt::format("its heights are in '{}', not in m", file.units("height")),
                path);
  TACTO_TRY(check_height_map(map, path));
  return map;
}

bool is_height_map(const std::string& path) {
  return NetcdfReader(path).text("kind") == kHeightMapKind;
}

}  // namespace tacto::schema
