// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/prepared_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <utility>

#include "data-schema/height/height_map.hpp"
#include "data-schema/scene/force_grid.hpp"
#include "data-schema/texture/texture.hpp"
#include "playback/model/texture_lookup.hpp"
#include "playback/prepare/relief/groove_series.hpp"
#include "playback/prepare/relief/noise_octaves.hpp"
#include "playback/prepare/scene/body_motion.hpp"
#include "playback/prepare/scene/clay_block.hpp"
#include "playback/prepare/scene/field_section.hpp"
#include "playback/prepare/scene/field_stiffness.hpp"
#include "playback/prepare/scene/piece_block.hpp"
#include "playback/prepare/scene/stable_scene.hpp"
#include "playback/prepare/scene/volume_block.hpp"
#include "playback/prepare/texture_check.hpp"
#include "playback/stability/free_limit.hpp"
#include "playback/stability/hand_limit.hpp"

namespace tacto::playback {

using core::SceneLayerKind;
using schema::ErrorKind;
using schema::fail;
using schema::ForceLayer;
using schema::Result;

namespace {

using Words = std::vector<std::uint32_t>;

struct KindInBlock {
  SceneLayerKind kind;
  std::vector<std::string_view> members;  // the numbers of the block, in its order
};

template <class T>
void append(Words& words, const T* parts, std::size_t count) {
  static_assert(sizeof(T) % sizeof(std::uint32_t) == 0);
  const std::size_t before = words.size();
  words.resize(before + count * sizeof(T) / sizeof(std::uint32_t));
  if (count > 0) std::memcpy(words.data() + before, parts, count * sizeof(T));
}

template <class T>
void append(Words& words, const std::vector<T>& parts) {
  append(words, parts.data(), parts.size());
}

// whole + part 2^-32 + rest 2^-64: the kernel adds such steps count by count without rounding.
struct Fixed {
  std::int32_t whole;
  std::uint32_t part, rest;  // of 2^-32, of 2^-64
};

Fixed fixed(double value) {
  const double parts = value * 0x1p32, below = std::floor(parts);
  const auto both = static_cast<std::int64_t>(below);
  return {static_cast<std::int32_t>(both >> 32), static_cast<std::uint32_t>(both),
          static_cast<std::uint32_t>(std::min((parts - below) * 0x1p32, 0x1p32 - 1))};
}

core::SceneStride stride_of(double periods_per_count) {
  const auto [whole, part, rest] = fixed(periods_per_count);
  return {whole, part, rest};
}

// A place on a surface in periods: `at_centre` at the centre of the patch; it grows along `angle_deg` from
// the axis x of the plane.
core::SceneRow row_of(const schema::Patch& patch, double angle_deg, double period_m, const PlaneSteps& steps,
                      double at_centre = 0) {
  const double angle_rad = angle_deg * std::numbers::pi / 180;
  const double x_per_m = std::cos(angle_rad) / period_m, y_per_m = std::sin(angle_rad) / period_m;
  const Fixed at_zero = fixed(at_centre - (patch.x_m * x_per_m + patch.y_m * y_per_m));
  return {at_zero.whole, at_zero.part, {stride_of(steps.x_m * x_per_m), stride_of(steps.y_m * y_per_m)}};
}

Words table_of(const schema::GroovesLayer& grooves, const schema::Patch& patch, const PlaneSteps& steps) {
  const double period_m = grooves.period_m.value, angle_deg = grooves.direction_deg.value;
  const double angle_rad = angle_deg * std::numbers::pi / 180;
  const auto amplitudes = groove_amplitudes(grooves.profile, grooves.filter_m->value / period_m);
  const core::GroovesTable table{row_of(patch, patch.angle_deg + angle_deg, period_m, steps),
                                 static_cast<float>(std::cos(angle_rad) / period_m),
                                 static_cast<float>(std::sin(angle_rad) / period_m),
                                 static_cast<std::uint32_t>(amplitudes.size())};
  Words words;
  append(words, &table, 1);
  append(words, std::vector<float>(amplitudes.begin(), amplitudes.end()));
  return words;
}

Words table_of(const schema::NoiseLayer& noise, const schema::Patch& patch, const PlaneSteps& steps) {
  const double period_m = noise.period_m.value;
  const auto amplitudes = octave_amplitudes(noise);
  const core::NoiseSurfaceTable table{
      {row_of(patch, patch.angle_deg, period_m, steps), row_of(patch, patch.angle_deg + 90, period_m, steps)},
      static_cast<float>(1 / period_m),
      static_cast<std::uint32_t>(amplitudes.size()),
      core::shuffled_noise(static_cast<std::uint32_t>(noise.seed.value))};
  Words words;
  append(words, &table, 1);
  append(words, std::vector<float>(amplitudes.begin(), amplitudes.end()));
  return words;
}

}  // namespace

Words relief_table(const Relief& relief, double angle_deg, const schema::Patch& patch,
                   const PlaneSteps& steps) {
  const double angle_rad = angle_deg * std::numbers::pi / 180;
  const core::ReliefTable table{
      static_cast<float>(relief.highest_per_m), static_cast<std::uint32_t>(relief.levels.size()),
      static_cast<float>(std::cos(angle_rad)), static_cast<float>(std::sin(angle_rad))};
  Words words;
  append(words, &table, 1);
  std::uint32_t first = 0;
  for (const ReliefLevel& level : relief.levels) {
    core::ReliefLevelTable row;
    const std::size_t places[2] = {level.columns, level.rows}, of_map[2] = {relief.columns, relief.rows};
    for (int i = 0; i < 2; ++i) {
      const auto count = static_cast<double>(places[i]);
      const double pitch_m = relief.pitch_m * static_cast<double>(of_map[i]) / count;
      row.along[i] = row_of(patch, patch.angle_deg + angle_deg + 90 * i, pitch_m, steps,
                            (count - 1) / 2 - relief.centre_m[i] / pitch_m);
      row.samples_per_m[i] = static_cast<float>(1 / pitch_m);
    }
    row.columns = static_cast<std::uint32_t>(level.columns);
    row.rows = static_cast<std::uint32_t>(level.rows);
    row.first = first;
    first += row.columns * row.rows;
    append(words, &row, 1);
  }
  for (const ReliefLevel& level : relief.levels) append(words, level.coefficients);
  return words;
}

namespace {

Words table_of(const ForceRelief& forces, const schema::Patch& patch, const PlaneSteps& steps) {
  Words words = relief_table(forces.x, 0, patch, steps);
  for (const ReliefLevel& level : forces.y.levels) append(words, level.coefficients);
  return words;
}

template <class Table>
Words words_of(const Table& table) {
  Words words;
  append(words, &table, 1);
  return words;
}

Words table_of(const FieldSection& section, const schema::Patch& patch, const PlaneSteps& steps) {
  const auto atoms = section.in_units();
  const core::FieldTable table{{row_of(patch, patch.angle_deg, section.period_m, steps),
                                row_of(patch, patch.angle_deg + 90, section.period_m, steps)},
                               static_cast<float>(1 / section.unit_m()),
                               static_cast<float>(section.core * section.core),
                               static_cast<std::uint32_t>(atoms.size())};
  Words words;
  append(words, &table, 1);
  append(words, atoms);
  return words;
}

Words table_of(const ForceLayer& layer, const schema::Patch& patch, const PlaneSteps& steps,
               const Reliefs& reliefs) {
  return layer.visit(
      [&](const schema::HeightMapLayer& map) { return relief_table(reliefs.of(map), 0, patch, steps); },
      [&](const schema::TextureForceLayer& texture) {
        return relief_table(reliefs.of(texture), texture.direction_deg.value, patch, steps);
      },
      [&](const schema::ForceMapLayer& map) { return table_of(reliefs.of(map), patch, steps); },
      [&](const schema::GroovesLayer& grooves) { return table_of(grooves, patch, steps); },
      [&](const schema::NoiseLayer& noise) { return table_of(noise, patch, steps); },
      [&](const schema::BodyLayer& body) {
        return words_of(body_table(body.mass_kg.value, 0, steps.tick_s));
      },
      [&](const schema::LassoLayer& lasso) {
        return words_of(body_table(lasso.mass_kg.value, lasso.damping_n_s_per_m.value, steps.tick_s));
      },
      [](const schema::MoverLayer& mover) {
        const double angle_rad = mover.direction_deg.value * std::numbers::pi / 180;
        return words_of(core::MoverTable{static_cast<float>(std::cos(angle_rad)),
                                         static_cast<float>(std::sin(angle_rad))});
      },
      [&](const schema::FieldLayer& field) {
        return table_of(field_section(field, reliefs.of(field), patch), patch, steps);
      },
      [](const auto& /*without a table*/) { return Words(); });
}

KindInBlock kind_of(const ForceLayer& layer) {
  return layer.visit(
      [](const schema::SpringLayer& /*spring*/) -> KindInBlock {
        return {SceneLayerKind::spring, {"stiffness_n_per_m", "centre_x_m", "centre_y_m"}};
      },
      [](const schema::DamperLayer& damper) -> KindInBlock {
        return {damper.two_ticks ? SceneLayerKind::tick_damper : SceneLayerKind::damper,
                {"damping_n_s_per_m"}};
      },
      [](const schema::GroovesLayer& /*grooves*/) -> KindInBlock {
        return {SceneLayerKind::grooves, {"depth_m", "kappa_n"}};
      },
      [](const schema::NoiseLayer& /*noise*/) -> KindInBlock {
        return {SceneLayerKind::noise, {"depth_m", "kappa_n"}};
      },
      [](const schema::HeightMapLayer& /*map*/) -> KindInBlock {
        return {SceneLayerKind::height_map, {"kappa_n"}};
      },
      [](const schema::TextureForceLayer& /*texture*/) -> KindInBlock {
        return {SceneLayerKind::height_map, {"gain"}};
      },
      [](const schema::BodyLayer& /*body*/) -> KindInBlock {
        return {SceneLayerKind::body,
                {"stiffness_n_per_m", "damping_n_s_per_m", "static_friction_n", "kinetic_friction_n"}};
      },
      [](const schema::LassoLayer& /*lasso*/) -> KindInBlock {
        return {SceneLayerKind::lasso, {"stiffness_n_per_m", "length_m"}};
      },
      [](const schema::MoverLayer& /*mover*/) -> KindInBlock {
        return {SceneLayerKind::mover, {"damping_n_s_per_m", "speed_mps"}};
      },
      [](const schema::FieldLayer& /*field*/) -> KindInBlock {
        return {SceneLayerKind::field, {"force_scale", "z_m"}};
      },
      [](const schema::ForceMapLayer& /*map*/) -> KindInBlock {
        return {SceneLayerKind::force_map, {"gain"}};
      });
}

static_assert(schema::kMostLayers == core::kMostSceneLayers);  // data-schema does not include core

// With the dampers that were added.
Result<void> check_layer_count(const schema::Scene& scene, const std::string& where) {
  std::size_t layers = 0;
  for (const schema::Patch& patch : scene.patches) layers += patch.layers.size();
  if (layers <= core::kMostSceneLayers) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("with the dampers that adaptive layers add, the scene has {} layers, more than {}",
                          layers, core::kMostSceneLayers),
              where, "make two scenes of it");
}

std::vector<float> numbers_in(const ForceLayer& layer, const std::vector<std::string_view>& members) {
  const auto all = schema::numbers_of(layer);
  std::vector<float> numbers;
  for (const std::string_view member : members)
    numbers.push_back(
        static_cast<float>(std::ranges::find(all, member, &schema::NamedLayerNumber::name)->number.value));
  return numbers;
}

core::ScenePatch patch_data(const schema::Patch& patch) {
  const double angle_rad = patch.angle_deg * std::numbers::pi / 180;
  core::ScenePatch data;
  data.centre_x_m = static_cast<float>(patch.x_m);
  data.centre_y_m = static_cast<float>(patch.y_m);
  data.cosine = static_cast<float>(std::cos(angle_rad));
  data.sine = static_cast<float>(std::sin(angle_rad));
  data.half_width_m = static_cast<float>(patch.width_m / 2);
  data.half_height_m = static_cast<float>(patch.height_m / 2);
  data.adds = patch.combine == schema::PatchCombine::add ? 1 : 0;
  return data;
}

Result<Relief> levels_of_map(const std::string& file, double rate_hz) {
  const auto map = schema::read_height_map(file);
  TACTO_TRY(map);
  return relief_levels(*map, rate_hz, kFastestHandMps, schema::height_map_path(file));
}

// `path`: along a path, against its direction: less its mean, so that the fades are those of a force without
// a mean, and of a stroke backwards with the other sign.
Result<Relief> levels_of_texture(const std::string& file, double rate_hz, bool path) {
  const auto texture = schema::read_texture(file);
  TACTO_TRY(texture);
  if (auto playable = check_playable(*texture); !playable)
    return fail(ErrorKind::unsuitable, playable.error().what, file, playable.error().remedy);
  const schema::SpaceSignal& signal = texture->signal;
  const schema::SpaceSignal ones{signal.pitch_m, 0, std::vector<double>(signal.values.size(), 1.0)};
  const TextureLookup faded(signal, 0), fade(ones, 0);
  schema::SpaceSignal force_n{signal.pitch_m, 0, {}};
  double sum_n = 0, weights = 0;
  for (std::size_t i = 0; i < signal.values.size(); ++i) {
    force_n.values.push_back(faded(force_n.position_m(i)));
    sum_n += force_n.values.back(), weights += fade(force_n.position_m(i));
  }
  if (path)
    for (std::size_t i = 0; i < signal.values.size(); ++i)
      force_n.values[i] =
          texture->direction * (force_n.values[i] - sum_n / weights * fade(force_n.position_m(i)));
  auto levels = texture_levels(force_n, rate_hz, kFastestHandMps, file);
  TACTO_TRY(levels);
  for (const ReliefLevel& level : levels->levels)
    if (std::ranges::any_of(level.coefficients,
                            [](float c) { return std::abs(c) > core::kLargestCoefficient_m; }))
      return fail(ErrorKind::unsuitable, "its mean force is too large for its length", file,
                  "subtract the mean of its forces, or make it shorter");
  return levels;
}

// The block of core/scene/scene_block.hpp: header, patches, layers, the numbers that can change, tables. A
// layer holds the index of its first number and of the first word of its table.
Words block_of(const std::vector<schema::Patch>& from, const PlaneSteps& steps, const Reliefs& reliefs) {
  std::vector<core::ScenePatch> patches;
  std::vector<core::SceneLayer> layers;
  std::vector<float> numbers;
  Words tables;
  for (const schema::Patch& patch : from) {
    patches.push_back(patch_data(patch));
    patches.back().first_layer = static_cast<std::uint16_t>(layers.size());
    patches.back().layers = static_cast<std::uint16_t>(patch.layers.size());
    for (const ForceLayer& layer : patch.layers) {
      const KindInBlock kind = kind_of(layer);
      layers.push_back({static_cast<std::uint16_t>(kind.kind), static_cast<std::uint16_t>(numbers.size()),
                        static_cast<std::uint32_t>(tables.size())});
      const auto of_layer = numbers_in(layer, kind.members);
      numbers.insert(numbers.end(), of_layer.begin(), of_layer.end());
      numbers.resize(layers.back().first_number + core::numbers_of(kind.kind));
      append(tables, table_of(layer, patch, steps, reliefs));
    }
  }
  core::SceneHeader header;
  header.patches = static_cast<std::uint16_t>(patches.size());
  header.layers = static_cast<std::uint16_t>(layers.size());
  header.numbers = static_cast<std::uint16_t>(numbers.size());
  header.table_words = static_cast<std::uint32_t>(tables.size());
  Words words;
  append(words, &header, 1);
  append(words, patches);
  append(words, layers);
  append(words, numbers);
  append(words, tables);
  header.check =
      core::scene_check(words.data(), static_cast<std::uint32_t>(words.size() * sizeof(std::uint32_t)));
  std::memcpy(words.data(), &header, sizeof header);
  return words;
}

}  // namespace

PlaneSteps steps_of(const schema::Device& device, double rate_hz) {
  PlaneSteps steps{0, 0, 1 / rate_hz, 0};
  for (const schema::DeviceAxis& axis : device.axes)
    (axis.name == "x" ? steps.x_m : axis.name == "y" ? steps.y_m : steps.z_m) = axis.encoder_step_m;
  if (!(steps.x_m > 0)) steps.x_m = steps.y_m;
  if (!(steps.y_m > 0)) steps.y_m = steps.x_m;
  if (!(steps.z_m > 0)) steps.z_m = steps.x_m;
  return steps;
}

core::SceneView PreparedScene::view() const {
  core::SceneView view;
  core::read_scene_block(words.data(), static_cast<std::uint32_t>(bytes()), view);
  return view;
}

PreparedScene PreparedScene::with(std::vector<schema::Patch> others) const {
  PreparedScene scene{std::move(others), {}, steps, stiffness_limit_n_per_m, reliefs};
  scene.words = block_of(scene.patches, steps, reliefs);
  return scene;
}

std::vector<std::string_view> numbers_in_block(const ForceLayer& layer) {
  return kind_of(layer).members;
}

std::size_t PreparedScene::layer_bytes(const schema::Patch& patch, const ForceLayer& layer) const {
  return sizeof(core::SceneLayer) + core::numbers_of(kind_of(layer).kind) * sizeof(float) +
         table_of(layer, patch, steps, reliefs).size() * sizeof(std::uint32_t);
}

std::string PreparedScene::remedy_for(std::size_t room) const {
  if (!reliefs.volumes.empty()) return remedy_for_volumes(*this, room);
  if (!meshes.empty()) return remedy_for_meshes(*this, room);
  if (!reliefs.surfaces.empty()) return remedy_for_reliefs(*this, room);
  if (!pieces.empty() && reliefs.textures.empty() && reliefs.height_maps.empty()) return {};
  if (!pieces.empty()) return "make its textures shorter, or give its height maps a larger pitch";
  std::size_t maps = 0, textures = 0;
  for (const schema::Patch& patch : patches)
    for (const ForceLayer& layer : patch.layers)
      layer.visit(
          [&](const schema::HeightMapLayer& /*map*/) { maps += layer_bytes(patch, layer); },
          [&](const schema::ForceMapLayer& /*map*/) { maps += layer_bytes(patch, layer); },
          [&](const schema::TextureForceLayer& /*texture*/) { textures += layer_bytes(patch, layer); },
          [](const auto& /*other*/) {});
  const std::size_t others = bytes() - maps;
  if (textures > 0 && others >= room) return "make its textures shorter";
  if (maps == 0 || others >= room) return {};
  const double factor = std::sqrt(static_cast<double>(maps) / static_cast<double>(room - others));
  return fmt::format("give its height and force maps a pitch {:.2f} times as large",
                     std::ceil(100 * factor) / 100);
}

namespace {

Result<void> read_relief(schema::Piece& piece, const std::string& where, const std::string& at,
                         double rate_hz, Reliefs& reliefs) {
  schema::PieceRelief& of = *piece.relief;
  const auto map = schema::read_height_map(schema::texture_in_scene(where, of.file));
  TACTO_TRY(map);
  const schema::HeightFigures figures = schema::figures_of(*map);
  of.range_m = figures.highest_m - figures.lowest_m;
  if (of.interpolated) {
    piece.texture = schema::PieceTexture{schema::PieceTextureType::normals, of.file, relief_axes(piece)};
    return {};
  }
  of.surface = piece.clay ? fmt::format("{}#{}", of.file, piece.name) : of.file;
  auto& surface = reliefs.surfaces[of.surface];
  if (piece.clay) {
    auto clay = clay_relief(piece, *map, rate_hz, at);
    TACTO_TRY(clay);
    surface = std::make_shared<const Relief>(std::move(*clay));
  } else if (!surface) {
    surface = std::make_shared<const Relief>(surface_relief(*map));
  }
  of.largest = surface->largest_slope();
  of.steepest = surface->curvature_per_m(INFINITY, INFINITY);
  return {};
}

}  // namespace

Result<Reliefs> read_reliefs(schema::Scene& scene, const std::string& where, double rate_hz) {
  Reliefs reliefs;
  const auto map_in = [&](const schema::Patch& patch, schema::HeightMapLayer& layer) -> Result<void> {
    auto& relief = reliefs.height_maps[layer.file];
    if (!relief) {
      auto levels = levels_of_map(schema::texture_in_scene(where, layer.file), rate_hz);
      TACTO_TRY(levels);
      relief = std::make_shared<const Relief>(std::move(*levels));
    }
    layer.curvature_per_m = relief->curvature_per_m(patch.width_m, patch.height_m);
    return {};
  };
  const auto texture_in = [&](const schema::Patch& patch, schema::TextureForceLayer& layer) -> Result<void> {
    auto& relief = reliefs.textures[layer.file];
    if (!relief) {
      auto levels = levels_of_texture(schema::texture_in_scene(where, layer.file), rate_hz, false);
      TACTO_TRY(levels);
      relief = std::make_shared<const Relief>(std::move(*levels));
    }
    layer.steepest_n_per_m = relief->curvature_per_m(length_across(patch, layer.direction_deg.value), 0);
    return {};
  };
  const auto atoms_in = [&](const schema::Patch& patch, schema::FieldLayer& layer) -> Result<void> {
    const std::string file = schema::texture_in_scene(where, layer.file);
    auto& atoms = reliefs.atoms[layer.file];
    if (!atoms) {
      auto read = schema::read_atoms(file);
      TACTO_TRY(read);
      atoms = std::make_shared<const std::vector<schema::Atom>>(std::move(*read));
    }
    const FieldSection section = field_section(layer, *atoms, patch);
    TACTO_TRY(check_section(section, file));
    layer.stiffest_n_per_m = stiffest_n_per_m(section, layer.z_m, patch);
    return {};
  };
  const auto forces_in = [&](const schema::Patch& patch, schema::ForceMapLayer& layer) -> Result<void> {
    const std::string file = schema::texture_in_scene(where, layer.file);
    auto& forces = reliefs.force_maps[layer.file];
    if (!forces) {
      const auto grid = schema::read_force_grid(file);
      TACTO_TRY(grid);
      auto levels = force_levels(*grid, rate_hz, kFastestHandMps, file);
      TACTO_TRY(levels);
      forces = std::make_shared<const ForceRelief>(std::move(*levels));
    }
    const ForceSlopes slopes = forces->slopes(patch.width_m, patch.height_m);
    layer.attracting_n_per_m = slopes.attracting_n_per_m;
    layer.repelling_n_per_m = slopes.repelling_n_per_m;
    layer.curl_n_per_m = slopes.curl_n_per_m;
    return {};
  };
  for (std::size_t i = 0; i < scene.pieces.size(); ++i) {
    schema::Piece& piece = scene.pieces[i];
    const std::string at = fmt::format("{}#/pieces/{}", where, i);
    TACTO_TRY(read_piece_volume(piece, where, at, scene.tool_m.size(), reliefs.volumes));
    if (piece.relief) TACTO_TRY(read_relief(piece, where, at, rate_hz, reliefs));
    if (!piece.texture || piece.texture->type == schema::PieceTextureType::sine) continue;
    const std::string file = schema::texture_in_scene(where, piece.texture->file);
    const bool bump = piece.texture->type != schema::PieceTextureType::recording;
    auto& relief = (bump ? reliefs.height_maps : reliefs.textures)[piece.texture->file];
    if (!relief) {
      auto levels = bump ? levels_of_map(file, rate_hz) : levels_of_texture(file, rate_hz, true);
      TACTO_TRY(levels);
      relief = std::make_shared<const Relief>(std::move(*levels));
    }
    piece.texture->largest = relief->largest_slope();
    piece.texture->steepest = relief->curvature_per_m(INFINITY, INFINITY);
  }
  for (schema::Patch& patch : scene.patches)
    for (ForceLayer& layer : patch.layers)
      TACTO_TRY(layer.visit([&](schema::FieldLayer& field) { return atoms_in(patch, field); },
                            [&](schema::ForceMapLayer& map) { return forces_in(patch, map); },
                            [&](schema::HeightMapLayer& map) { return map_in(patch, map); },
                            [&](schema::TextureForceLayer& texture) { return texture_in(patch, texture); },
                            [](auto& /*other*/) { return Result<void>(); }));
  return reliefs;
}

double length_across(const schema::Patch& patch, double direction_deg) {
  const double angle_rad = direction_deg * std::numbers::pi / 180;
  return patch.width_m * std::abs(std::cos(angle_rad)) + patch.height_m * std::abs(std::sin(angle_rad));
}

double stiffness_limit_of(const schema::Device& device, double rate_hz,
                          const std::optional<schema::Hand>& hand, double virtual_damping_n_s_per_m,
                          bool in_space) {
  double limit = INFINITY;
  const TickTiming timing{1 / rate_hz, device.delay_s * rate_hz};
  for (const schema::DeviceAxis& axis : device.axes) {
    if (axis.name == "z" && !in_space) continue;
    const schema::Hand held = hand.value_or(schema::Hand());
    limit = std::min(limit, hand || virtual_damping_n_s_per_m > 0
                                ? hand_stiffness_limit(axis, held, timing, virtual_damping_n_s_per_m)
                                : free_stiffness_limit(axis.mass_kg, axis.viscous_n_s_per_m, timing.period_s,
                                                       timing.delay_ticks));
  }
  return limit;
}

Result<void> set_filters(schema::Scene& scene, double limit_n_per_m, const std::string& where) {
  for (std::size_t i = 0; i < scene.patches.size(); ++i)
    for (std::size_t j = 0; j < scene.patches[i].layers.size(); ++j)
      TACTO_TRY(scene.patches[i].layers[j].visit(
          [&](schema::GroovesLayer& grooves) -> Result<void> {
            if (grooves.filter_m) return {};
            if (grooves.profile != schema::GrooveProfile::sine && !(limit_n_per_m > 0))
              return fail(ErrorKind::unsuitable,
                          "a device without viscous friction has no stiffness limit to filter grooves for",
                          fmt::format("{}#/patches/{}/layers/{}/filter_m", where, i, j),
                          "give the filter, or the friction of the device");
            grooves.filter_m = schema::LayerNumber{automatic_filter_m(grooves, limit_n_per_m)};
            return {};
          },
          [](auto& /*other*/) { return Result<void>(); }));
  return {};
}

Result<PreparedScene> prepare_scene(schema::Scene scene, const std::string& where,
                                    const schema::Device& device, double rate_hz,
                                    const std::optional<schema::Hand>& hand) {
  if (!scene.pieces.empty()) return prepare_pieces(std::move(scene), where, device, rate_hz, hand);
  if (scene.patches.empty())
    return fail(ErrorKind::unsuitable, "this scene has no force patches and no pieces", where,
                "a scene of a tray is played with --transducer");
  TACTO_TRY(check_bodies(scene, where, rate_hz));
  PreparedScene base;
  base.stiffness_limit_n_per_m = stiffness_limit_of(device, rate_hz, hand);
  base.steps = steps_of(device, rate_hz);
  TACTO_TRY(set_filters(scene, base.stiffness_limit_n_per_m, where));
  auto reliefs = read_reliefs(scene, where, rate_hz);
  TACTO_TRY(reliefs);
  base.reliefs = std::move(*reliefs);
  TACTO_TRY(add_adaptive_damping(scene, where, device, rate_hz, hand));
  TACTO_TRY(check_layer_count(scene, where));
  std::ranges::reverse(scene.patches);
  std::ranges::stable_sort(scene.patches, std::ranges::greater(), &schema::Patch::order);
  return base.with(std::move(scene.patches));
}

}  // namespace tacto::playback
