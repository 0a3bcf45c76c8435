// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/volume_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "firmware-host/core/scene/volume.hpp"

namespace tacto::playback {

using schema::Piece;
using schema::Result;
using schema::Volume;

namespace {

constexpr double kMostDepthOfStep_m = 0.1;  // of a block

// Of 2^-32.
std::int64_t in_samples(double samples) {
  return static_cast<std::int64_t>(std::round(samples * 0x1p32));
}

// The first value, at 0, of the place whose middle is `rest_m` from whole counts.
core::VolumeAxis axis_of(std::size_t samples, double spacing_m, double step_m, double rest_m) {
  const std::int64_t origin = in_samples(static_cast<double>(samples - 1) / 2 - rest_m / spacing_m),
                     per_count = in_samples(step_m / spacing_m);
  return {static_cast<std::int32_t>(origin >> 32),    static_cast<std::uint32_t>(origin),
          static_cast<std::int32_t>(per_count >> 32), static_cast<std::uint32_t>(per_count),
          static_cast<float>(1 / spacing_m),          static_cast<std::uint32_t>(samples)};
}

// As core::largest_of_blocks(): a block reads the first values of the next one, too.
std::vector<std::int16_t> largest_in_blocks(const Volume& volume) {
  const auto [columns, rows, layers] = volume.samples;
  constexpr std::size_t kSide = core::kVolumeBlock;
  std::vector<std::int16_t> all;
  for (std::size_t z = 0; z + 1 < layers; z += kSide)
    for (std::size_t y = 0; y + 1 < rows; y += kSide)
      for (std::size_t x = 0; x + 1 < columns; x += kSide) {
        std::int16_t largest = INT16_MIN;
        for (std::size_t k = z; k < std::min(layers, z + kSide + 1); ++k)
          for (std::size_t j = y; j < std::min(rows, y + kSide + 1); ++j) {
            const std::int16_t* const row = &volume.stored[volume.at(0, j, k)];
            largest = std::max(largest, *std::max_element(row + x, row + std::min(columns, x + kSide + 1)));
          }
        all.push_back(largest);
      }
  return all;
}

double stored_iso(const Piece& piece, const Volume& volume) {
  return (piece.iso - volume.offset) / volume.scale;
}

}  // namespace

Result<void> read_piece_volume(Piece& piece, const std::string& scene, const std::string& where,
                               std::size_t tool_points,
                               std::map<std::string, std::shared_ptr<const Volume>>& volumes) {
  if (piece.shape != schema::PieceShape::volume) return {};
  auto& volume = volumes[piece.volume];
  if (!volume) {
    auto read = schema::read_volume(schema::texture_in_scene(scene, piece.volume));
    TACTO_TRY(read);
    volume = std::make_shared<const Volume>(std::move(*read));
  }
  const auto [least, most] = std::ranges::minmax(volume->stored);
  const auto unsuitable = [&](const char* member, std::string what, std::string remedy) {
    return schema::fail(schema::ErrorKind::unsuitable, std::move(what), fmt::format("{}/{}", where, member),
                        std::move(remedy));
  };
  if (!(stored_iso(piece, *volume) >= least && stored_iso(piece, *volume) < most))
    return unsuitable(
        "iso",
        fmt::format("the volume {} is {} at a value of {:g}", piece.volume,
                    stored_iso(piece, *volume) < least ? "solid everywhere" : "empty", piece.iso),
        fmt::format("choose a value from {:g} to {:g}", volume->value(least), volume->value(most)));
  if (volume->scale > kMostDepthOfStep_m * piece.value_per_m)
    return unsuitable("value_per_m",
                      fmt::format("a step of the stored values, {:g}, is {:g} m deep", volume->scale,
                                  volume->scale / piece.value_per_m),
                      fmt::format("give at least {:g}", volume->scale / kMostDepthOfStep_m));
  piece.steepness = std::pow(steepest_per_m(*volume, piece.iso) / piece.value_per_m, 2) *
                    static_cast<double>(std::max<std::size_t>(1, tool_points));
  return {};
}

std::vector<std::uint32_t> volume_table(const Piece& piece, const Volume& volume,
                                        const core::PieceTable& placed, const PlaneSteps& steps,
                                        const std::vector<std::array<double, 3>>& tool_m) {
  core::VolumeTable table;
  table.piece = placed;
  table.piece.form[core::kPieceDirection + 2] = 1;
  table.piece.form[core::kPieceSize] = static_cast<float>(std::ranges::max(volume.half_size_m()));
  const double step_m[3] = {steps.x_m, steps.y_m, steps.z_m};
  for (std::size_t i = 0; i < 3; ++i)
    table.along[i] = axis_of(volume.samples[i], volume.spacing_m[i], step_m[i], double{placed.rest_m[i]});
  table.iso = static_cast<float>(stored_iso(piece, volume));
  table.m_per_value = static_cast<float>(volume.scale / piece.value_per_m);
  table.points = static_cast<std::uint32_t>(tool_m.size());
  std::vector<core::ToolPoint> points(tool_m.size());
  for (std::size_t n = 0; n < points.size(); ++n)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t samples = in_samples(tool_m[n][i] / volume.spacing_m[i]);
      points[n].whole[i] = static_cast<std::int32_t>(samples >> 32);
      points[n].part[i] = static_cast<std::uint32_t>(samples);
    }
  const std::size_t point_bytes = points.size() * sizeof(core::ToolPoint);
  const std::size_t block_words = core::block_words_of(table);
  std::vector<std::uint32_t> words((sizeof table + point_bytes) / sizeof(std::uint32_t) +
                                   core::value_words_of(table) + block_words);
  auto* const at = reinterpret_cast<std::byte*>(words.data());
  std::memcpy(at, &table, sizeof table);
  std::copy_n(reinterpret_cast<const std::byte*>(points.data()), point_bytes, at + sizeof table);
  std::memcpy(at + sizeof table + point_bytes, volume.stored.data(), 2 * volume.stored.size());
  if (block_words > 0) {
    const std::vector<std::int16_t> largest = largest_in_blocks(volume);
    std::memcpy(words.data() + words.size() - block_words, largest.data(), 2 * largest.size());
  }
  return words;
}

double carve_per_tick(const Piece& piece, const Volume& volume, double rate_hz) {
  return std::round(piece.carve->value_per_s / volume.scale / rate_hz * 0x1p16);
}

Result<void> set_carving(const Piece& piece, const Volume& volume, double rate_hz, const std::string& where,
                         std::vector<std::uint32_t>& words) {
  if (!piece.carve) return {};
  constexpr double kMost = 65535 * 0x1p16;
  const double per_tick = carve_per_tick(piece, volume, rate_hz);
  if (!(per_tick >= 1 && per_tick <= kMost))
    return schema::fail(
        schema::ErrorKind::unsuitable,
        fmt::format("{:g} a second are {:g} steps of the stored values in a tick of {:g} Hz",
                    piece.carve->value_per_s, piece.carve->value_per_s / volume.scale / rate_hz, rate_hz),
        where + "/carve/value_per_s",
        fmt::format("give {:.3g} to {:.3g}", volume.scale * rate_hz / 0x1p16,
                    65535 * volume.scale * rate_hz));
  core::VolumeTable table;
  std::memcpy(static_cast<void*>(&table), words.data(), sizeof table);
  table.carve_n = static_cast<float>(piece.carve->force_n);
  table.carve_per_tick = static_cast<std::uint32_t>(per_tick);
  table.carve_to = std::ranges::min(volume.stored);
  std::memcpy(words.data(), &table, sizeof table);
  return {};
}

bool solid_at_border(const Piece& piece, const Volume& volume) {
  const auto [columns, rows, layers] = volume.samples;
  const double above = stored_iso(piece, volume);
  for (std::size_t z = 0; z < layers; ++z)
    for (std::size_t y = 0; y < rows; ++y) {
      const bool inner = z > 0 && z + 1 < layers && y > 0 && y + 1 < rows;
      for (std::size_t x = 0; x < columns; x += inner ? columns - 1 : 1)
        if (volume.stored[volume.at(x, y, z)] > above) return true;
    }
  return false;
}

std::string remedy_for_volumes(const PreparedScene& scene, std::size_t room) {
  std::size_t values = 0;
  for (const Piece& piece : scene.pieces)
    if (!piece.volume.empty()) values += scene.reliefs.volumes.at(piece.volume)->stored.size();
  const std::size_t bytes = sizeof(std::int16_t) * values * (scene.view().tables_change ? 2 : 1);
  const std::size_t others = scene.room_bytes() - bytes;
  if (others >= room) return "leave pieces out";
  return fmt::format("crop its volumes, or give them a larger spacing: of {} values {:.0f} fit", values,
                     std::floor(static_cast<double>(room - others) / static_cast<double>(bytes) *
                                static_cast<double>(values)));
}

}  // namespace tacto::playback
