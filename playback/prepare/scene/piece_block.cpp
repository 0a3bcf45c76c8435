// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/piece_block.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <utility>

#include "playback/prepare/scene/clay_block.hpp"
#include "playback/prepare/scene/contact_transient.hpp"
#include "playback/prepare/scene/judged_piece.hpp"
#include "playback/prepare/scene/mesh_block.hpp"
#include "playback/prepare/scene/slide_table.hpp"
#include "playback/prepare/scene/volume_block.hpp"

namespace tacto::playback {

using core::SceneLayerKind;
using schema::ErrorKind;
using schema::fail;
using schema::Piece;
using schema::PieceShape;
using schema::Result;

namespace {

constexpr double kMostPlaceCounts = 0x1p30;
constexpr double kWholeSpace_m = 1000;  // half the side of the patch that holds the pieces

template <class T>
void append_words(std::vector<std::uint32_t>& words, const std::vector<T>& parts) {
  static_assert(sizeof(T) % sizeof(std::uint32_t) == 0);
  const std::size_t before = words.size();
  words.resize(before + parts.size() * sizeof(T) / sizeof(std::uint32_t));
  std::memcpy(words.data() + before, parts.data(), parts.size() * sizeof(T));
}

SceneLayerKind kind_of_piece(PieceShape shape) {
  switch (shape) {
    case PieceShape::plane:
      return SceneLayerKind::plane;
    case PieceShape::sphere:
      return SceneLayerKind::sphere;
    case PieceShape::cylinder:
      return SceneLayerKind::cylinder;
    case PieceShape::mesh:
      return SceneLayerKind::mesh;
    case PieceShape::volume:
      return SceneLayerKind::volume;
    case PieceShape::quadric:
      break;
  }
  return SceneLayerKind::quadric;
}

// At whole counts, and a rest.
Result<core::PieceTable> table_at(const schema::MeshVertex& place_m, const PlaneSteps& steps,
                                  const std::string& where) {
  core::PieceTable table;
  const double step_m[3] = {steps.x_m, steps.y_m, steps.z_m};
  for (std::size_t i = 0; i < 3; ++i) {
    const double counts = std::round(place_m[i] / step_m[i]);
    if (!(std::abs(counts) <= kMostPlaceCounts))
      return fail(ErrorKind::unsuitable,
                  fmt::format("a place of {:g} m is {:.3g} counts of the encoder", place_m[i], counts),
                  where + "/place", fmt::format("at most {:g} counts are possible", kMostPlaceCounts));
    table.origin[i] = static_cast<std::int32_t>(counts);
    table.rest_m[i] = static_cast<float>(place_m[i] - counts * step_m[i]);
  }
  return table;
}

// A plane and a plate are raised by the radius of the point; balls and cylinders get a larger radius.
Result<core::PieceTable> table_of_piece(const Piece& piece, double point_radius_m, const PlaneSteps& steps,
                                        const std::string& where) {
  const auto& d = piece.direction;
  const double size = std::hypot(d[0], d[1], d[2]);
  const double n[3] = {d[0] / size, d[1] / size, d[2] / size};
  const double raised_m = piece.shape == PieceShape::plane ? point_radius_m : 0;
  auto placed = table_at(
      {piece.x_m + raised_m * n[0], piece.y_m + raised_m * n[1], piece.z_m + raised_m * n[2]}, steps, where);
  TACTO_TRY(placed);
  core::PieceTable& table = *placed;
  if (piece.shape == PieceShape::quadric) {
    // In units of the largest one: the kernel's least gradient is an absolute one.
    const auto [least, most] = std::ranges::minmax(piece.coefficients);
    const double scale = std::max(-least, most);
    std::ranges::transform(piece.coefficients, table.form,
                           [&](double c) { return static_cast<float>(c / scale); });
    return placed;
  }
  for (int i = 0; i < 3; ++i) table.form[core::kPieceDirection + i] = static_cast<float>(n[i]);
  const double extent_m = piece.shape != PieceShape::plane ? piece.radius_m + point_radius_m
                          : piece.thickness_m > 0          ? piece.thickness_m + 2 * point_radius_m
                                                           : 0;
  table.form[core::kPieceSize] = static_cast<float>(extent_m);
  return placed;
}

// Its origin is the middle of its box: so the places of its vertices are small.
Result<std::vector<std::uint32_t>> words_of_mesh(const Piece& piece, const schema::Mesh& mesh,
                                                 const PlaneSteps& steps,
                                                 const core::TransientTable& transient,
                                                 const std::string& where) {
  const schema::MeshVertex middle = middle_of(mesh);
  auto placed = table_at({piece.x_m + middle[0], piece.y_m + middle[1], piece.z_m + middle[2]}, steps, where);
  TACTO_TRY(placed);
  std::vector<std::uint32_t> words = mesh_table(mesh, {-middle[0], -middle[1], -middle[2]});
  static_assert(offsetof(core::MeshTable, piece) == 0);
  core::PieceTable table;
  std::memcpy(static_cast<void*>(&table), words.data(), sizeof table);
  std::copy(std::begin(table.form), std::end(table.form), placed->form);
  placed->transient = transient;
  std::memcpy(words.data(), &*placed, sizeof *placed);
  return words;
}

// Each file once.
Result<void> read_meshes(PreparedScene& scene, const std::string& where) {
  for (const Piece& piece : scene.pieces) {
    if (piece.shape != PieceShape::mesh || scene.meshes.contains(piece.mesh)) continue;
    auto mesh = schema::read_mesh(schema::texture_in_scene(where, piece.mesh));
    TACTO_TRY(mesh);
    scene.meshes[piece.mesh] = std::make_shared<const schema::Mesh>(std::move(*mesh));
  }
  return {};
}

// Behind the other words of its piece, which begin with the PieceTable.
void append_travel(const Piece& piece, std::vector<std::uint32_t>& words) {
  if (piece.travel.empty()) return;
  words[offsetof(core::PieceTable, travel) / sizeof(std::uint32_t)] =
      static_cast<std::uint32_t>(words.size());
  append_words(words, std::vector{core::TravelTable{static_cast<std::uint32_t>(piece.travel.size())}});
  for (const schema::TravelPoint& point : piece.travel)
    append_words(words, std::vector{core::TravelPoint{static_cast<float>(point.depth_m),
                                                      static_cast<float>(point.force_n)}});
}

core::PieceTextureKind kind_of_texture(schema::PieceTextureType type) {
  switch (type) {
    case schema::PieceTextureType::recording:
      return core::PieceTextureKind::recording;
    case schema::PieceTextureType::bump:
      return core::PieceTextureKind::bump;
    case schema::PieceTextureType::normals:
      return core::PieceTextureKind::normals;
    case schema::PieceTextureType::sine:
      break;
  }
  return core::PieceTextureKind::sine;
}

// The same.
Result<void> append_slide(const Piece& piece, double tick_s, const std::string& where,
                          std::vector<std::uint32_t>& words) {
  if (!piece.slide) return {};
  const auto table = slide_table(piece, tick_s, where);
  TACTO_TRY(table);
  words[offsetof(core::PieceTable, slide) / sizeof(std::uint32_t)] = static_cast<std::uint32_t>(words.size());
  append_words(words, std::vector{*table});
  return {};
}

// Of a map whose centre is at the place of the piece.
void set_axes(const std::array<std::array<double, 3>, 2>& from, const Piece& piece, const PlaneSteps& steps,
              const core::PieceTable& table, float (&axes)[2][3], float (&at_m)[2]) {
  const double step_m[3] = {steps.x_m, steps.y_m, steps.z_m}, place_m[3] = {piece.x_m, piece.y_m, piece.z_m};
  for (std::size_t i = 0; i < 2; ++i) {
    double origin_m = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      axes[i][j] = static_cast<float>(from[i][j]);
      origin_m += from[i][j] * (table.origin[j] * step_m[j] + double{table.rest_m[j]} - place_m[j]);
    }
    at_m[i] = static_cast<float>(origin_m);
  }
}

// The largest second derivative is computed at the samples and halfway between them.
constexpr double kBendMargin = 1.25;

// What is behind the PieceTable of a raised plane.
void append_relief(const Piece& piece, const Reliefs& reliefs, const PlaneSteps& steps,
                   std::vector<std::uint32_t>& words) {
  if (!is_raised(piece)) return;
  core::ReliefPieceTable table;
  static_assert(offsetof(core::ReliefPieceTable, piece) == 0);
  std::memcpy(static_cast<void*>(&table.piece), words.data(), sizeof table.piece);
  set_axes(relief_axes(piece), piece, steps, table.piece, table.axes, table.origin_m);
  table.bend_per_m = static_cast<float>(kBendMargin * piece.relief->steepest);
  words.clear();
  append_words(words, std::vector{table});
  append_words(words, relief_table(reliefs.of(*piece.relief), 0, {}, {0, 0}));
  if (piece.clay) set_clay(*piece.clay, words);
}

// Behind the other words of its piece.
void append_texture(const Piece& piece, const Reliefs& reliefs, const PlaneSteps& steps,
                    std::vector<std::uint32_t>& words) {
  if (!piece.texture) return;
  core::PieceTable table;
  std::memcpy(static_cast<void*>(&table), words.data(), sizeof table);
  table.texture = static_cast<std::uint32_t>(words.size());
  std::memcpy(words.data(), &table, sizeof table);
  const schema::PieceTextureType type = piece.texture->type;
  core::PieceTextureTable texture;
  set_axes(schema::map_axes(piece.texture->axes), piece, steps, table, texture.axes, texture.origin_m);
  for (std::size_t i = 0; i < 2 && type == schema::PieceTextureType::sine; ++i)
    texture.per_m[i] = static_cast<float>(1 / piece.texture->periods_m[i]);
  texture.amplitude_n = static_cast<float>(piece.texture->amplitude_n);
  texture.kind = static_cast<std::uint32_t>(kind_of_texture(type));
  if (type == schema::PieceTextureType::sine) {
    append_words(words, std::vector{texture});
    return;
  }
  const Relief& relief = reliefs.of(*piece.texture);
  if (type == schema::PieceTextureType::recording)
    texture.per_m[0] = static_cast<float>(1 / (2 * static_cast<double>(relief.columns) * relief.pitch_m));
  append_words(words, std::vector{texture});
  append_words(words, relief_table(relief, 0, {}, {0, 0}));
}

void append_numbers(const Piece& piece, std::vector<float>& numbers) {
  for (const auto& [name, value, changes] : schema::kWallNumbers)
    numbers.push_back(static_cast<float>(piece.*value));
  numbers.insert(numbers.end(), core::kWallStateWords, 0.0F);
}

Result<void> check_wall(const Piece& piece, const schema::Device& device, double rate_hz,
                        const std::optional<schema::Hand>& hand, const std::string& where) {
  if (!(piece.integral_n_per_m_s > 0)) return {};
  const Piece steepest = steepest_wall(piece);
  const double growth = wall_growth(steepest, device, rate_hz, hand);
  if (growth <= 1) return {};
  Piece stiffer = steepest;
  stiffer.stiffness_n_per_m = 1 + 1.01 * steepest.stiffness_n_per_m;
  const bool stiffens = wall_growth(stiffer, device, rate_hz, hand) < growth;
  return fail(
      ErrorKind::unsuitable,
      fmt::format("the integral of piece '{}' makes its wall unstable on the device '{}': with {:g} "
                  "N/m, {:g} N s/m and {:g} N/(m s) a motion grows from tick to tick (computed)",
                  piece.name, device.name, piece.stiffness_n_per_m, piece.damping_n_s_per_m,
                  piece.integral_n_per_m_s),
      where + "/integral_n_per_m_s",
      fmt::format("choose a smaller integral, more damping or {} stiffness", stiffens ? "more" : "less"));
}

std::optional<std::string> cut_of_transient(const Piece& piece, const schema::Device& device,
                                            double rate_hz) {
  const auto transient = transient_of(piece);
  if (!transient) return std::nullopt;
  const double whole_to_mps = transient_whole_to_mps(piece, device, rate_hz);
  if (whole_to_mps >= kFastTap_mps) return std::nullopt;
  return fmt::format(
      "the transient of piece '{}' with its wall is whole up to contacts of {:.3g} m/s; faster ones are cut "
      "by "
      "the limits of the device: at {:g} m/s its own peak is {:.3g} N (peak force {:g} N, slew {:g} N/s)",
      piece.name, whole_to_mps, kFastTap_mps, kFastTap_mps * transient_peak_n_s_per_m(*transient),
      device.peak_force_n, device.slew_n_per_s);
}

}  // namespace

Result<PreparedScene> prepare_pieces(schema::Scene scene, const std::string& where,
                                     const schema::Device& device, double rate_hz,
                                     const std::optional<schema::Hand>& hand) {
  PreparedScene base;
  auto reliefs = read_reliefs(scene, where, rate_hz);
  TACTO_TRY(reliefs);
  base.reliefs = std::move(*reliefs);
  base.pieces = scene.pieces;
  base.point_radius_m = scene.point_radius_m;
  base.contact = scene.contact;
  base.tool_m = scene.tool_m;
  base.steps = steps_of(device, rate_hz);
  base.stiffness_limit_n_per_m = stiffness_limit_of(device, rate_hz, hand, 0, true);
  core::ScenePatch space;
  space.half_width_m = space.half_height_m = static_cast<float>(kWholeSpace_m);
  space.layers = static_cast<std::uint16_t>(scene.pieces.size());
  space.adds = scene.contact == schema::PieceContact::add ? 1 : 0;
  TACTO_TRY(read_meshes(base, where));
  std::vector<core::SceneLayer> layers;
  std::vector<float> numbers;
  std::vector<std::uint32_t> tables;
  for (const Piece& piece : scene.pieces) {
    const std::string at = fmt::format("{}#/pieces/{}", where, layers.size());
    for (const Piece& end : slider_ends(piece)) TACTO_TRY(check_wall(end, device, rate_hz, hand, at));
    TACTO_TRY(check_clay(piece, device, at));
    const auto transient = transient_table(piece, rate_hz, at);
    TACTO_TRY(transient);
    const SceneLayerKind kind = is_raised(piece) ? SceneLayerKind::relief : kind_of_piece(piece.shape);
    layers.push_back({static_cast<std::uint16_t>(kind), static_cast<std::uint16_t>(numbers.size()),
                      static_cast<std::uint32_t>(tables.size())});
    append_numbers(piece, numbers);
    if (piece.shape == PieceShape::mesh) {
      auto words = words_of_mesh(piece, *base.meshes.at(piece.mesh), base.steps, *transient, at);
      TACTO_TRY(words);
      append_travel(piece, *words);
      TACTO_TRY(append_slide(piece, base.steps.tick_s, at, *words));
      append_texture(piece, base.reliefs, base.steps, *words);
      append_words(tables, *words);
      continue;
    }
    if (piece.shape == PieceShape::volume) {
      auto placed = table_at({piece.x_m, piece.y_m, piece.z_m}, base.steps, at);
      TACTO_TRY(placed);
      placed->transient = *transient;
      auto table =
          volume_table(piece, *base.reliefs.volumes.at(piece.volume), *placed, base.steps, base.tool_m);
      TACTO_TRY(set_carving(piece, *base.reliefs.volumes.at(piece.volume), rate_hz, at, table));
      append_words(tables, table);
      continue;
    }
    auto table = table_of_piece(piece, scene.point_radius_m, base.steps, at);
    TACTO_TRY(table);
    table->transient = *transient;
    std::vector<std::uint32_t> words;
    append_words(words, std::vector{*table});
    append_relief(piece, base.reliefs, base.steps, words);
    append_travel(piece, words);
    TACTO_TRY(append_slide(piece, base.steps.tick_s, at, words));
    append_texture(piece, base.reliefs, base.steps, words);
    append_words(tables, words);
  }
  core::SceneHeader header;
  header.patches = 1;
  header.layers = static_cast<std::uint16_t>(layers.size());
  header.numbers = static_cast<std::uint16_t>(numbers.size());
  header.table_words = static_cast<std::uint32_t>(tables.size());
  append_words(base.words, std::vector{header});
  append_words(base.words, std::vector{space});
  append_words(base.words, layers);
  append_words(base.words, numbers);
  append_words(base.words, tables);
  header.check = core::scene_check(base.words.data(), static_cast<std::uint32_t>(base.bytes()));
  std::memcpy(base.words.data(), &header, sizeof header);
  return base;
}

std::string remedy_for_meshes(const PreparedScene& scene, std::size_t room) {
  std::size_t bytes = 0, triangles = 0;
  const core::SceneView view = scene.view();
  for (std::size_t i = 0; i < scene.pieces.size(); ++i) {
    if (scene.pieces[i].shape != PieceShape::mesh) continue;
    const auto& table = core::table_of<core::MeshTable>(view, view.layers[i]);
    triangles += table.triangles;
    bytes += sizeof table + sizeof(core::MeshNode) * table.nodes +
             3 * sizeof(std::uint32_t) * (std::size_t{table.triangles} + table.vertices);
  }
  const std::size_t others = scene.bytes() - bytes;
  if (others >= room) return "leave pieces out";
  const double share = static_cast<double>(room - others) / static_cast<double>(bytes);
  return fmt::format("decimate its meshes: of {} triangles about {:.0f} fit", triangles,
                     std::floor(0.95 * share * static_cast<double>(triangles)));
}

std::vector<std::string> limits_of_pieces(const PreparedScene& scene, const schema::Device& device,
                                          double rate_hz, const std::optional<schema::Hand>& hand) {
  std::vector<std::string> notes;
  for (const char* name : {"x", "y", "z"})
    if (std::ranges::find(device.axes, name, &schema::DeviceAxis::name) == device.axes.end())
      notes.push_back(fmt::format(
          "the device has no axis {0}: the hand stays at {0} = 0, and forces along {0} are left out", name));
  for (const Piece& piece : scene.pieces)
    if (auto note = cut_of_transient(piece, device, rate_hz)) notes.push_back(std::move(*note));
  for (const Piece& piece : scene.pieces)
    if (piece.shape == PieceShape::volume && solid_at_border(piece, *scene.reliefs.volumes.at(piece.volume)))
      notes.push_back(
          fmt::format("the volume of piece '{}' is solid at its border, where its force ends with a step: "
                      "a hand that passes there may gain energy",
                      piece.name));
  if (!(device.axes.front().mass_kg > 0)) return notes;
  schema::Scene judged_scene;
  judged_scene.pieces = scene.pieces;
  judged_scene.point_radius_m = scene.point_radius_m;
  judged_scene.contact = scene.contact;
  for (std::size_t i = 0; i < scene.pieces.size(); ++i) {
    const JudgedPiece judged = judged_piece(judged_scene, i, device, rate_hz, hand);
    const auto note = [&](const char* where, const Piece& load, const std::vector<std::string>& with) {
      notes.push_back(fmt::format(
          "piece '{}' is unstable on this device with {}{}{}{}: {:.4g} N/m and {:.4g} N s/m act there, the "
          "limit is {:.4g} N/m (computed, without the Coulomb friction of the device)",
          judged.alone.name, hand ? "hand " + hand->name : "nothing held", where,
          with.empty() ? "" : ", together with ", fmt::join(with, ", "), load.stiffness_n_per_m,
          load.damping_n_s_per_m, stiffness_limit_of(device, rate_hz, hand, load.damping_n_s_per_m, true)));
    };
    if (judged.growth > 1) note("", judged.total, judged.with);
    if (judged.growth_along > 1) note(", along its surface", judged.along, judged.along_with);
  }
  return notes;
}

}  // namespace tacto::playback
