// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>

#include "data-schema/height/height_map.hpp"

namespace tacto::schema {
namespace {

using StlCorner = std::array<float, 3>;

constexpr double kMillimetresPerMetre = 1000;  // STL has no unit; programs read millimetres

// Triangles counter-clockwise from outside, with their normals.
class StlTriangles {
 public:
  explicit StlTriangles(std::ostream& to) : to_(to) {}

  void add(const StlCorner& a, const StlCorner& b, const StlCorner& c) {
    const double u[] = {double{b[0]} - a[0], double{b[1]} - a[1], double{b[2]} - a[2]},
                 v[] = {double{c[0]} - a[0], double{c[1]} - a[1], double{c[2]} - a[2]};
    const double n[] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]},
                 size = std::hypot(n[0], n[1], n[2]);
    float record[12];
    for (std::size_t i = 0; i < 3; ++i) record[i] = static_cast<float>(n[i] / size);
    std::copy(a.begin(), a.end(), record + 3);
    std::copy(b.begin(), b.end(), record + 6);
    std::copy(c.begin(), c.end(), record + 9);
    to_.write(reinterpret_cast<const char*>(record), sizeof record);
    to_.write("\0", 2);  // attribute
  }

 private:
  std::ostream& to_;
};

std::uint64_t edges_around(const HeightMap& map) {
  return 2 * (std::uint64_t{map.columns} + map.rows - 2);
}

// Above two triangles a cell; of each edge of the border two on its side, and one to the middle below.
std::uint64_t triangles_of(const HeightMap& map) {
  return 2 * (std::uint64_t{map.columns} - 1) * (map.rows - 1) + 3 * edges_around(map);
}

void write_triangles(const HeightMap& map, double base_m, StlTriangles& triangles) {
  const auto along = [&](double samples) {
    return static_cast<float>(kMillimetresPerMetre * map.pitch_m * samples);
  };
  const auto base = static_cast<float>(kMillimetresPerMetre * base_m);
  const auto above = [&](std::size_t x, std::size_t y) -> StlCorner {
    return {along(static_cast<double>(x)), along(static_cast<double>(y)),
            static_cast<float>(kMillimetresPerMetre * double{map.height_m[y * map.columns + x]})};
  };
  const std::size_t last_x = map.columns - 1, last_y = map.rows - 1;
  const StlCorner middle = {along(0.5 * static_cast<double>(last_x)),
                            along(0.5 * static_cast<double>(last_y)), base};
  for (std::size_t y = 0; y < last_y; ++y)
    for (std::size_t x = 0; x < last_x; ++x) {
      triangles.add(above(x, y), above(x + 1, y), above(x + 1, y + 1));
      triangles.add(above(x, y), above(x + 1, y + 1), above(x, y + 1));
    }
  const auto side = [&](std::size_t from_x, std::size_t from_y, std::size_t to_x, std::size_t to_y) {
    const StlCorner from = above(from_x, from_y), to = above(to_x, to_y),
                    below_from = {from[0], from[1], base}, below_to = {to[0], to[1], base};
    triangles.add(below_from, below_to, to);
    triangles.add(below_from, to, from);
    triangles.add(below_to, below_from, middle);
  };
  for (std::size_t x = 0; x < last_x; ++x) side(x, 0, x + 1, 0), side(x + 1, last_y, x, last_y);
  for (std::size_t y = 0; y < last_y; ++y) side(last_x, y, last_x, y + 1), side(0, y + 1, 0, y);
}

}  // namespace

Result<void> write_height_stl(const std::string& path, const HeightMap& map, double base_m,
                              Existing existing) {
  constexpr std::uint64_t kMostTriangles = UINT64_C(1) << 31;
  if (map.columns < 2 || map.rows < 2 || triangles_of(map) > kMostTriangles)
    return fail(ErrorKind::unsuitable,
                fmt::format("{} x {} heights are no solid of at most {} triangles", map.columns, map.rows,
                            kMostTriangles),
                path, "give at least 2 columns and 2 rows, or write a height map");
  if (const float lowest_m = std::ranges::min(map.height_m); !(double{lowest_m} > base_m))
    return fail(ErrorKind::unsuitable,
                fmt::format("its lowest height {:g} m is not above the base at {:g} m", lowest_m, base_m),
                path);
  PendingFiles files;
  const auto temporary = files.add(path);
  TACTO_TRY(temporary);
  std::ofstream out(*temporary, std::ios::binary | std::ios::trunc);
  std::string head =
      fmt::format("tactograph height map, millimetres, {} x {} heights", map.columns, map.rows);
  head.resize(80);
  const auto count = static_cast<std::uint32_t>(triangles_of(map));
  out.write(head.data(), static_cast<std::streamsize>(head.size()));
  out.write(reinterpret_cast<const char*>(&count), sizeof count);
  StlTriangles triangles(out);
  write_triangles(map, base_m, triangles);
  out.close();
  if (!out)
    return fail(ErrorKind::cannot_write, "the file cannot be written completely", path,
                "is there room on the disk?");
  return files.commit(existing);
}

}  // namespace tacto::schema
