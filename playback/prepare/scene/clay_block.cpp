// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/clay_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware-host/core/scene/clay.hpp"

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr int kExactBits = 24;  // of a whole number in single precision

}  // namespace

Result<Relief> clay_relief(schema::Piece& piece, const schema::HeightMap& map, double rate_hz,
                           const std::string& where) {
  schema::Clay& clay = *piece.clay;
  if (map.columns < 2 || map.rows < 2)
    return fail(ErrorKind::unsuitable,
                fmt::format("clay of {} x {} heights has no cell to press", map.columns, map.rows),
                where + "/relief/file", "give a map of at least 2 columns and 2 rows");
  const schema::HeightFigures figures = schema::figures_of(map);
  const double least_m = figures.lowest_m - clay.thickness_m, most_m = figures.highest_m + clay.thickness_m;
  const double unit_m =
      std::exp2(std::ceil(std::log2(std::max(std::abs(least_m), std::abs(most_m)))) - kExactBits);
  const double sinks_m = clay.sink_m_per_s / rate_hz, half_units = std::round(sinks_m / 2 / unit_m);
  clay.half_m = half_units * unit_m;
  clay.least_m = std::ceil(least_m / unit_m) * unit_m;
  clay.most_m = std::floor(most_m / unit_m) * unit_m;
  if (half_units < 1 || 2 * clay.half_m > clay.thickness_m)
    return fail(ErrorKind::unsuitable,
                fmt::format("{:g} m a second are {:.3g} m in a tick of {:g} Hz: {}", clay.sink_m_per_s,
                            sinks_m, rate_hz,
                            half_units < 1
                                ? fmt::format("less than {:.3g} m, twice the unit of its heights", 2 * unit_m)
                                : fmt::format("more than the thickness, {:g} m", clay.thickness_m)),
                where + "/clay/sink_m_per_s",
                fmt::format("give {:.3g} to {:.3g}", 2 * unit_m * rate_hz, clay.thickness_m * rate_hz));
  Relief relief = surface_relief(map);
  for (std::size_t i = 0; i < map.height_m.size(); ++i)
    relief.levels.front().coefficients[i] =
        static_cast<float>(std::round(double{map.height_m[i]} / unit_m) * unit_m);
  return relief;
}

Result<void> check_clay(const schema::Piece& piece, const schema::Device& device, const std::string& where) {
  if (!piece.clay || piece.clay->force_n < device.peak_force_n) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("clay that gives way above {:g} N: the device '{}' gives at most {:g} N",
                          piece.clay->force_n, device.name, device.peak_force_n),
              where + "/clay/force_n", "choose a smaller force");
}

void set_clay(const schema::Clay& clay, std::vector<std::uint32_t>& words) {
  auto& table = *reinterpret_cast<core::ReliefPieceTable*>(words.data());
  table.clay = {static_cast<float>(clay.force_n), static_cast<float>(clay.half_m),
                static_cast<float>(clay.least_m), static_cast<float>(clay.most_m), clay.kept ? 1U : 0U};
  const core::ReliefLevelTable& level = core::levels_of(core::relief_of(table))[0];
  float bend_per_m = 0;
  for (std::uint32_t row = 0; row < level.rows; row += 2)
    for (std::uint32_t column = 0; column < level.columns; column += 2)
      bend_per_m = std::max(bend_per_m, core::clay_bend_per_m(table, static_cast<std::int32_t>(column),
                                                              static_cast<std::int32_t>(row), 0));
  table.bend_per_m = bend_per_m;
}

std::string remedy_for_reliefs(const PreparedScene& scene, std::size_t room) {
  std::size_t heights = 0;
  for (const schema::Piece& piece : scene.pieces)
    if (is_raised(piece)) heights += scene.reliefs.of(*piece.relief).levels.front().coefficients.size();
  const std::size_t bytes = sizeof(float) * heights * (scene.view().tables_change ? 2 : 1),
                    others = scene.room_bytes() - bytes;
  if (others >= room) return "leave pieces out, or make their textures shorter";
  return fmt::format("crop its reliefs, or give them a larger pitch: of {} heights {:.0f} fit", heights,
                     std::floor(static_cast<double>(room - others) / static_cast<double>(bytes) *
                                static_cast<double>(heights)));
}

}  // namespace tacto::playback
