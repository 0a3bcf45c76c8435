// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/scene_block.hpp"

#include <stddef.h>

#include "firmware-host/core/kernel/finite.hpp"
#include "firmware-host/core/scene/grooves.hpp"
#include "firmware-host/core/scene/volume.hpp"
#include "firmware-host/core/wire/crc32c.hpp"

namespace tacto::core {
namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the block is read in place");

// As in the schema of scenes, so that sums of forces stay far below the largest float.
constexpr float kFarthest_m = 10, kStiffest_n_per_m = 1e6F, kMostDamping_n_s_per_m = 1e4F;
constexpr float kFarthestPatch_m = 1e3F;
constexpr float kUnitRounding = 1e-5F;  // rounding of cosine^2 + sine^2
constexpr float kDeepest_m = 1, kMostKappa_n = 1000, kMostForceGain = 1000;
constexpr float kMostPeriods_per_m = 1.001e6F;
constexpr float kLargestAmplitude = 2;  // of a harmonic; 4 / pi of a square wave
constexpr float kMostSamples_per_m = 1.001e8F;
constexpr float kMostFriction_n = 1000, kFastestMover_mps = 10;
constexpr float kLongestTick_s = 10, kLightest_per_kg = 1e9F, kHeaviest_per_kg = 1e-12F;
constexpr float kMostFieldScale = 1e15F, kMostUnits_per_m = 1e17F, kMostUnits = 0x1p34F;
constexpr float kMostSquaredSigma = 0x1p66F, kLeastCore = 0.24F, kMostCore = 1.45F;
constexpr float kMostAtomForce = 1;  // N per unit

constexpr float kMostPiece_kg = 100, kMostFriction = 10, kMostIntegral = 1e7F, kMostLeak_per_s = 1000;
constexpr float kMostTransient_n_s_per_m = 1e6F;
constexpr float kLeastLoss = 1e-6F;  // of a transient from tick to tick
constexpr float kMostPasses_per_m = 1e6F;
constexpr float kLargestPiece_m = 20, kMostCoefficient = 1e9F, kFarthestRest_m = 1;
constexpr float kMostBend_per_m = 1e17F;  // of coefficients up to 10 m, 1e-8 m apart
constexpr uint32_t kMostFall = 0xFFFF0000;
constexpr float kMostVoxels_per_m = 1e7F, kMost_m_per_value = 0.1F, kMostIso = 65536;
constexpr float kThinnestSkin_m = 1e-12F, kThickestSkin_m = 1e-3F;

bool is_direction(float cosine, float sine) noexcept {
  return within(cosine * cosine + sine * sine, 1 - kUnitRounding, 1 + kUnitRounding);
}

bool sound(const ScenePatch& patch) noexcept {
  return within(patch.centre_x_m, -kFarthestPatch_m, kFarthestPatch_m) &&
         within(patch.centre_y_m, -kFarthestPatch_m, kFarthestPatch_m) &&
         is_direction(patch.cosine, patch.sine) && within(patch.half_width_m, 0, kFarthestPatch_m) &&
         within(patch.half_height_m, 0, kFarthestPatch_m) && patch.adds <= 1;
}

bool sound(SceneLayerKind kind, const float* number) noexcept {
  switch (kind) {
    case SceneLayerKind::spring:
      return within(number[kSpringStiffness], 0, kStiffest_n_per_m) &&
             within(number[kSpringCentreX], -kFarthest_m, kFarthest_m) &&
             within(number[kSpringCentreY], -kFarthest_m, kFarthest_m);
    case SceneLayerKind::damper:
    case SceneLayerKind::tick_damper:
      return within(number[kDamperDamping], 0, kMostDamping_n_s_per_m);
    case SceneLayerKind::height_map:
      return within(number[kHeightMapKappa], -kMostKappa_n, kMostKappa_n);
    case SceneLayerKind::force_map:
      return within(number[kForceMapGain], -kMostForceGain, kMostForceGain);
    case SceneLayerKind::body:
      return within(number[kBodyStiffness], 0, kStiffest_n_per_m) &&
             within(number[kBodyDamping], 0, kMostDamping_n_s_per_m) &&
             within(number[kBodyStaticFriction], 0, kMostFriction_n) &&
             within(number[kBodyKineticFriction], 0, kMostFriction_n);
    case SceneLayerKind::lasso:
      return within(number[kLassoStiffness], 0, kStiffest_n_per_m) &&
             within(number[kLassoLength], 0, kFarthest_m);
    case SceneLayerKind::mover:
      return within(number[kMoverDamping], 0, kMostDamping_n_s_per_m) &&
             within(number[kMoverSpeed], -kFastestMover_mps, kFastestMover_mps);
    case SceneLayerKind::field:
      return within(number[kFieldScale], 0, kMostFieldScale) &&
             within(number[kFieldZ], -kFarthest_m, kFarthest_m);
    case SceneLayerKind::plane:
    case SceneLayerKind::sphere:
    case SceneLayerKind::cylinder:
    case SceneLayerKind::quadric:
    case SceneLayerKind::mesh:
    case SceneLayerKind::relief:
    case SceneLayerKind::volume:
      return within(number[kPieceStiffness], 0, kStiffest_n_per_m) &&
             within(number[kPieceDamping], 0, kMostDamping_n_s_per_m) &&
             within(number[kPieceArrestMass], 0, kMostPiece_kg) &&
             within(number[kPieceIntegral], 0, kMostIntegral) &&
             within(number[kPieceIntegralBound], 0, kMostKappa_n) &&
             within(number[kPieceIntegralLeak], 0, kMostLeak_per_s) &&
             within(number[kPieceStaticFriction], 0, kMostFriction) &&
             within(number[kPieceKineticFriction], 0, kMostFriction) &&
             within(number[kPieceViscous], 0, kMostDamping_n_s_per_m) &&
             within(number[kPieceTextureGain], -kMostForceGain, kMostForceGain);
    case SceneLayerKind::grooves:
    case SceneLayerKind::noise:
      break;
  }
  return within(number[kSurfaceDepth], 0, kDeepest_m) && within(number[kSurfaceKappa], 0, kMostKappa_n);
}

bool amplitudes_sound(const float* amplitude, uint32_t count) noexcept {
  for (uint32_t i = 0; i < count; ++i)
    if (!within(amplitude[i], -kLargestAmplitude, kLargestAmplitude)) return false;
  return true;
}

bool sound(const GroovesTable& table) noexcept {
  return within(table.periods_per_m_x, -kMostPeriods_per_m, kMostPeriods_per_m) &&
         within(table.periods_per_m_y, -kMostPeriods_per_m, kMostPeriods_per_m) &&
         amplitudes_sound(amplitudes_of(table), table.harmonics);
}

bool sound(const NoiseSurfaceTable& table) noexcept {
  return within(table.periods_per_m, 0, kMostPeriods_per_m) &&
         amplitudes_sound(amplitudes_of(table), table.octaves);
}

bool sound(const BodyTable& table) noexcept {
  return within(table.speed_loss, -1, 0) && within(table.place_by_speed_s, 0, kLongestTick_s) &&
         within(table.speed_by_force_s_per_kg, kHeaviest_per_kg, kLightest_per_kg) &&
         within(table.place_by_force_s2_per_kg, 0, kLightest_per_kg);
}

bool sound(const MoverTable& table) noexcept {
  return is_direction(table.cosine, table.sine);
}

// A table of one length.
template <class Table>
SceneFault check_plain(const SceneView& view, const SceneLayer& layer, uint32_t room,
                       uint32_t& words) noexcept {
  words = sizeof(Table) / sizeof(uint32_t);
  if (words > room) return SceneFault::structure;
  return sound(table_of<Table>(view, layer)) ? SceneFault::none : SceneFault::value;
}

// Its motion begins with the first tick.
bool state_is_zero(SceneLayerKind kind, const float* number) noexcept {
  for (uint32_t i = changeable_numbers_of(kind); i < numbers_of(kind); ++i)
    if (!within(number[i], 0, 0)) return false;
  return true;
}

// A table that ends with amplitudes, at the place of `layer`; `room` words are left in the block. Sets its
// length in words.
template <class Table>
SceneFault check_surface(const SceneView& view, const SceneLayer& layer, uint32_t Table::*amplitudes,
                         uint32_t most, uint32_t room, uint32_t& words) noexcept {
  constexpr uint32_t kHead = sizeof(Table) / sizeof(uint32_t);
  if (room < kHead) return SceneFault::structure;
  const auto& table = table_of<Table>(view, layer);
  if (table.*amplitudes > most || table.*amplitudes > room - kHead) return SceneFault::structure;
  words = kHead + table.*amplitudes;
  return sound(table) ? SceneFault::none : SceneFault::value;
}

// Of a height map, and of a force map of two components.
SceneFault check_relief(const SceneView& view, const SceneLayer& layer, uint32_t components, float largest,
                        uint32_t room, uint32_t& words) noexcept {
  constexpr uint32_t kHead = sizeof(ReliefTable) / sizeof(uint32_t),
                     kLevel = sizeof(ReliefLevelTable) / sizeof(uint32_t);
  if (room < kHead) return SceneFault::structure;
  const auto& table = table_of<ReliefTable>(view, layer);
  if (table.levels == 0 || table.levels > kMostReliefLevels || table.levels * kLevel > room - kHead)
    return SceneFault::structure;
  uint64_t coefficients = 0;
  for (uint32_t i = 0; i < table.levels; ++i) {
    const ReliefLevelTable& level = levels_of(table)[i];
    const uint64_t own = static_cast<uint64_t>(level.columns) * level.rows;
    if (own == 0 || own > room || level.first != coefficients) return SceneFault::structure;
    coefficients += own;
    for (const float samples_per_m : level.samples_per_m)
      if (!within(samples_per_m, 0, kMostSamples_per_m)) return SceneFault::value;
  }
  const uint32_t head = kHead + table.levels * kLevel;
  coefficients *= components;
  if (coefficients > room - head) return SceneFault::structure;
  words = head + static_cast<uint32_t>(coefficients);
  const float* const first = coefficients_of(table, levels_of(table)[0]);
  for (uint64_t i = 0; i < coefficients; ++i)
    if (!within(first[i], -largest, largest)) return SceneFault::value;
  return within(table.highest_per_m, 0, kMostSamples_per_m) && is_direction(table.cosine, table.sine)
             ? SceneFault::none
             : SceneFault::value;
}

bool sound(const FieldAtom& atom) noexcept {
  return within(atom.z, -kMostUnits, kMostUnits) && within(atom.squared_sigma, 1, kMostSquaredSigma) &&
         within(atom.lennard_jones, 0, kMostAtomForce) &&
         within(atom.coulomb, -kMostAtomForce, kMostAtomForce);
}

SceneFault check_field(const SceneView& view, const SceneLayer& layer, uint32_t room,
                       uint32_t& words) noexcept {
  constexpr uint32_t kHead = sizeof(FieldTable) / sizeof(uint32_t),
                     kAtom = sizeof(FieldAtom) / sizeof(uint32_t);
  if (room < kHead) return SceneFault::structure;
  const auto& table = table_of<FieldTable>(view, layer);
  if (table.atoms > kMostAtoms || table.atoms * kAtom > room - kHead) return SceneFault::structure;
  words = kHead + table.atoms * kAtom;
  for (uint32_t i = 0; i < table.atoms; ++i)
    if (!sound(atoms_of(table)[i])) return SceneFault::value;
  return within(table.units_per_m, 0, kMostUnits_per_m) && within(table.core, kLeastCore, kMostCore)
             ? SceneFault::none
             : SceneFault::value;
}

// For the eigenvalues 1 - x and 1 - y of a step: x + y, x y and so their size, from numbers near 0.
bool sound(const TransientTable& table) noexcept {
  for (const float start : table.start_n_s_per_m)
    if (!within(start, -kMostTransient_n_s_per_m, kMostTransient_n_s_per_m)) return false;
  for (const float step : table.step)
    if (!within(step, -2, 2)) return false;
  const float sum = -(table.step[0] + table.step[3]),
              product = table.step[0] * table.step[3] - table.step[1] * table.step[2];
  return product >= kLeastLoss * sum && sum - product >= kLeastLoss && 4 - 2 * sum + product >= 0;
}

bool sound(const PieceTable& table, SceneLayerKind kind) noexcept {
  if (!sound(table.transient)) return false;
  for (const float rest_m : table.rest_m)
    if (!within(rest_m, -kFarthestRest_m, kFarthestRest_m)) return false;
  const float most = kind == SceneLayerKind::quadric ? kMostCoefficient : kLargestPiece_m;
  for (const float number : table.form)
    if (!within(number, -most, most)) return false;
  if (kind == SceneLayerKind::quadric) return true;
  const float* const n = table.form + kPieceDirection;
  const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  return within(square, 1 - kUnitRounding, 1 + kUnitRounding) &&
         within(table.form[kPieceSize], 0, kLargestPiece_m);
}

bool sound(const PieceTextureTable& table) noexcept {
  for (const float(&axis)[3] : table.axes)
    if (!within(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2], 1 - kUnitRounding,
                1 + kUnitRounding))
      return false;
  for (const float at_m : table.origin_m)
    if (!within(at_m, -kLargestPiece_m, kLargestPiece_m)) return false;
  return table.kind >= 1 && table.kind <= static_cast<uint32_t>(PieceTextureKind::normals) &&
         within(table.per_m[0], 0, kMostPasses_per_m) && within(table.per_m[1], 0, kMostPasses_per_m) &&
         within(table.amplitude_n, 0, kMostKappa_n);
}

// Behind the `words` of its piece, which it adds to.
SceneFault check_travel(const SceneView& view, const SceneLayer& layer, uint32_t room,
                        uint32_t& words) noexcept {
  const auto& piece = table_of<PieceTable>(view, layer);
  if (piece.travel == 0) return SceneFault::none;
  if (piece.travel != words || room - words < 1) return SceneFault::structure;
  const TravelTable& table = travel_of(piece);
  if (table.points == 0 || table.points > kMostTravelPoints || 2 * table.points > room - words - 1)
    return SceneFault::structure;
  words += 1 + 2 * table.points;
  float last_m = 0;
  for (uint32_t i = 0; i < table.points; ++i) {
    const TravelPoint& point = points_of(table)[i];
    if (!within(point.depth_m, last_m, kLargestPiece_m) || !within(point.force_n, 0, kMostKappa_n))
      return SceneFault::value;
    last_m = point.depth_m;
  }
  return SceneFault::none;
}

bool sound(const SlideTable& table) noexcept {
  const float* const a = table.axis;
  return within(a[0] * a[0] + a[1] * a[1] + a[2] * a[2], 1 - kUnitRounding, 1 + kUnitRounding) &&
         within(table.from_m, -kLargestPiece_m, 0) && within(table.to_m, 0, kLargestPiece_m) &&
         within(table.speed_by_force_s_per_kg, kHeaviest_per_kg, kLightest_per_kg) &&
         within(table.kept, 0, 1) && within(table.friction_n, 0, kMostFriction_n) &&
         within(table.detent_n, 0, kMostKappa_n) && within(table.detents_per_m, 0, kMostPeriods_per_m);
}

// The same.
SceneFault check_slide(const SceneView& view, const SceneLayer& layer, uint32_t room,
                       uint32_t& words) noexcept {
  const auto& piece = table_of<PieceTable>(view, layer);
  if (piece.slide == 0) return SceneFault::none;
  constexpr uint32_t kOwn = sizeof(SlideTable) / sizeof(uint32_t);
  if (piece.slide != words || room - words < kOwn) return SceneFault::structure;
  words += kOwn;
  return sound(slide_of(piece)) ? SceneFault::none : SceneFault::value;
}

// The same.
SceneFault check_texture(const SceneView& view, const SceneLayer& layer, uint32_t room,
                         uint32_t& words) noexcept {
  constexpr uint32_t kHead = sizeof(PieceTextureTable) / sizeof(uint32_t);
  const auto& piece = table_of<PieceTable>(view, layer);
  if (piece.texture == 0) return SceneFault::none;
  if (piece.texture != words || room - words < kHead) return SceneFault::structure;
  if (!sound(texture_of(piece))) return SceneFault::value;
  words += kHead;
  if (texture_of(piece).kind == static_cast<uint32_t>(PieceTextureKind::sine)) return SceneFault::none;
  uint32_t of_relief = 0;
  const SceneLayer behind{layer.kind, layer.first_number, layer.table + words};
  const SceneFault fault = check_relief(view, behind, 1, kLargestCoefficient_m, room - words, of_relief);
  words += of_relief;
  return fault;
}

SceneFault check_behind(const SceneView& view, const SceneLayer& layer, uint32_t room,
                        uint32_t& words) noexcept {
  SceneFault fault = check_travel(view, layer, room, words);
  if (fault == SceneFault::none) fault = check_slide(view, layer, room, words);
  return fault == SceneFault::none ? check_texture(view, layer, room, words) : fault;
}

SceneFault check_piece(const SceneView& view, const SceneLayer& layer, uint32_t room,
                       uint32_t& words) noexcept {
  words = sizeof(PieceTable) / sizeof(uint32_t);
  if (words > room) return SceneFault::structure;
  if (!sound(table_of<PieceTable>(view, layer), static_cast<SceneLayerKind>(layer.kind)))
    return SceneFault::value;
  return check_behind(view, layer, room, words);
}

bool sound(const MeshNode& node, uint32_t place, const MeshTable& table) noexcept {
  for (int i = 0; i < 3; ++i)
    if (!within(node.least_m[i], -kLargestPiece_m, kLargestPiece_m) ||
        !within(node.most_m[i], -kLargestPiece_m, kLargestPiece_m))
      return false;
  const uint32_t first = node.leaf / (kMostLeafTriangles + 1), count = node.leaf % (kMostLeafTriangles + 1);
  return node.skip > place && node.skip <= table.nodes && first <= table.triangles &&
         count <= table.triangles - first;
}

SceneFault check_mesh(const SceneView& view, const SceneLayer& layer, uint32_t room,
                      uint32_t& words) noexcept {
  constexpr uint32_t kHead = sizeof(MeshTable) / sizeof(uint32_t),
                     kNode = sizeof(MeshNode) / sizeof(uint32_t);
  if (room < kHead) return SceneFault::structure;
  const auto& table = table_of<MeshTable>(view, layer);
  const uint64_t all =
      kHead + uint64_t{kNode} * table.nodes + uint64_t{3} * table.triangles + uint64_t{3} * table.vertices;
  if (table.nodes == 0 || table.triangles >= 1U << 29 || all > room) return SceneFault::structure;
  words = static_cast<uint32_t>(all);
  if (!sound(table.piece, SceneLayerKind::mesh) || !within(table.skin_m, kThinnestSkin_m, kThickestSkin_m))
    return SceneFault::value;
  for (uint32_t i = 0; i < table.nodes; ++i)
    if (!sound(nodes_of(table)[i], i, table)) return SceneFault::structure;
  for (uint32_t i = 0; i < 3 * table.triangles; ++i)
    if (triangles_of(table)[i] >= table.vertices) return SceneFault::structure;
  for (uint64_t i = 0; i < uint64_t{3} * table.vertices; ++i)
    if (!within(vertices_of(table)[i], -kLargestPiece_m, kLargestPiece_m)) return SceneFault::value;
  return check_behind(view, layer, room, words);
}

bool sound(const ReliefPieceTable& table) noexcept {
  const float *const n = table.piece.form + kPieceDirection, *const u = table.axes[0],
                     *const v = table.axes[1];
  const auto product = [](const float* a, const float* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const auto across = [&](const float* a, const float* b) {
    return within(product(a, b), -kUnitRounding, kUnitRounding);
  };
  const auto unit = [&](const float* a) {
    return within(product(a, a), 1 - kUnitRounding, 1 + kUnitRounding);
  };
  return sound(table.piece, SceneLayerKind::relief) && across(n, u) && across(n, v) && across(u, v) &&
         unit(u) && unit(v) && within(table.origin_m[0], -kLargestPiece_m, kLargestPiece_m) &&
         within(table.origin_m[1], -kLargestPiece_m, kLargestPiece_m) &&
         within(table.bend_per_m, 0, kMostBend_per_m) && within(table.clay.force_n, 0, kMostKappa_n) &&
         within(table.clay.half_m, 0, kDeepest_m) &&
         within(table.clay.least_m, -kLargestCoefficient_m, kLargestCoefficient_m) &&
         within(table.clay.most_m, table.clay.least_m, kLargestCoefficient_m) && table.clay.kept <= 1;
}

SceneFault check_relief_piece(SceneView& view, const SceneLayer& layer, uint32_t room,
                              uint32_t& words) noexcept {
  constexpr uint32_t kHead = sizeof(ReliefPieceTable) / sizeof(uint32_t);
  if (room < kHead) return SceneFault::structure;
  const auto& table = table_of<ReliefPieceTable>(view, layer);
  if (!sound(table)) return SceneFault::value;
  view.tables_change = view.tables_change || table.clay.force_n > 0;
  const SceneLayer behind{layer.kind, layer.first_number, layer.table + kHead};
  const SceneFault fault = check_relief(view, behind, 1, kLargestCoefficient_m, room - kHead, words);
  words += kHead;
  return fault == SceneFault::none ? check_behind(view, layer, room, words) : fault;
}

bool sound(const VolumeAxis& axis) noexcept {
  return axis.samples >= 2 && axis.samples <= kMostVolumeSamples && within(axis.per_m, 0, kMostVoxels_per_m);
}

// Without a travel, a texture and a slide.
SceneFault check_volume(SceneView& view, const SceneLayer& layer, uint32_t room, uint32_t& words) noexcept {
  constexpr uint32_t kHead = sizeof(VolumeTable) / sizeof(uint32_t);
  if (room < kHead) return SceneFault::structure;
  const auto& table = table_of<VolumeTable>(view, layer);
  if (table.piece.travel != 0 || table.piece.texture != 0 || table.piece.slide != 0)
    return SceneFault::structure;
  uint64_t values = 1;
  for (const VolumeAxis& axis : table.along) {
    if (!sound(axis)) return SceneFault::value;
    values *= axis.samples;
  }
  if (table.points > kMostToolPoints) return SceneFault::structure;
  const uint64_t all = kHead + table.points * (sizeof(ToolPoint) / sizeof(uint32_t)) + (values + 1) / 2 +
                       block_words_of(table);
  if (all > room) return SceneFault::structure;
  words = static_cast<uint32_t>(all);
  view.tables_change = view.tables_change || table.carve_n > 0;
  return within(table.carve_n, 0, kMostKappa_n) && table.carve_per_tick <= kMostFall &&
                 table.carve_rest == 0 && table.carve_to >= INT16_MIN && table.carve_to <= INT16_MAX &&
                 sound(table.piece, SceneLayerKind::volume) && within(table.iso, -kMostIso, kMostIso) &&
                 within(table.m_per_value, 0, kMost_m_per_value)
             ? SceneFault::none
             : SceneFault::value;
}

SceneFault check_table(SceneView& view, const SceneLayer& layer, uint32_t room, uint32_t& words) noexcept {
  switch (static_cast<SceneLayerKind>(layer.kind)) {
    case SceneLayerKind::grooves:
      return check_surface(view, layer, &GroovesTable::harmonics, kMostHarmonics, room, words);
    case SceneLayerKind::noise:
      return check_surface(view, layer, &NoiseSurfaceTable::octaves, kMostOctaves, room, words);
    case SceneLayerKind::height_map:
      return check_relief(view, layer, 1, kLargestCoefficient_m, room, words);
    case SceneLayerKind::force_map:
      return check_relief(view, layer, 2, kLargestCoefficient_n, room, words);
    case SceneLayerKind::body:
    case SceneLayerKind::lasso:
      return check_plain<BodyTable>(view, layer, room, words);
    case SceneLayerKind::mover:
      return check_plain<MoverTable>(view, layer, room, words);
    case SceneLayerKind::field:
      return check_field(view, layer, room, words);
    case SceneLayerKind::plane:
    case SceneLayerKind::sphere:
    case SceneLayerKind::cylinder:
    case SceneLayerKind::quadric:
      return check_piece(view, layer, room, words);
    case SceneLayerKind::mesh:
      return check_mesh(view, layer, room, words);
    case SceneLayerKind::relief:
      return check_relief_piece(view, layer, room, words);
    case SceneLayerKind::volume:
      return check_volume(view, layer, room, words);
    case SceneLayerKind::spring:
    case SceneLayerKind::damper:
    case SceneLayerKind::tick_damper:
      break;
  }
  return SceneFault::none;
}

// Patches and layers use all layers, numbers and tables, one after the other: none is shared or left over.
SceneFault check_patches(const SceneView& view) noexcept {
  uint32_t layers = 0;
  for (uint32_t i = 0; i < view.patch_count; ++i) {
    const ScenePatch& patch = view.patches[i];
    if (patch.first_layer != layers || patch.layers == 0) return SceneFault::structure;
    layers += patch.layers;
    if (!sound(patch)) return SceneFault::value;
  }
  return layers == view.layer_count ? SceneFault::none : SceneFault::structure;
}

SceneFault check_layers(SceneView& view) noexcept {
  uint32_t numbers = 0, tables = 0, bodies = 0;
  view.in_space = view.layer_count > 0 && is_piece(static_cast<SceneLayerKind>(view.layers[0].kind));
  if (view.in_space && (view.patch_count != 1 || view.layer_count > kMostPieces))
    return SceneFault::structure;
  for (uint32_t i = 0; i < view.layer_count; ++i) {
    const SceneLayer& layer = view.layers[i];
    if (layer.first_number != numbers || layer.table != tables) return SceneFault::structure;
    const auto kind = static_cast<SceneLayerKind>(layer.kind);
    if (!is_known(kind) || is_piece(kind) != view.in_space) return SceneFault::structure;
    numbers += numbers_of(kind);
    if (has_body(kind)) ++bodies;
    if (numbers > view.number_count || bodies > kMostSceneBodies) return SceneFault::structure;
    const float* const number = view.numbers + layer.first_number;
    if (!sound(kind, number) || !state_is_zero(kind, number)) return SceneFault::value;
    view.needs_speed =
        view.needs_speed || (kind != SceneLayerKind::spring && kind != SceneLayerKind::lasso &&
                             kind != SceneLayerKind::field && kind != SceneLayerKind::tick_damper);
    uint32_t words = 0;
    if (const SceneFault fault = check_table(view, layer, view.table_words - tables, words);
        fault != SceneFault::none)
      return fault;
    tables += words;
  }
  return numbers == view.number_count && tables == view.table_words ? SceneFault::none
                                                                    : SceneFault::structure;
}

}  // namespace

bool number_fits(const SceneView& view, uint32_t layer, uint32_t number, float value) noexcept {
  if (layer >= view.layer_count) return false;
  const auto kind = static_cast<SceneLayerKind>(view.layers[layer].kind);
  const uint32_t count = changeable_numbers_of(kind);
  if (number >= count) return false;
  float numbers[kPieceNumbers];  // no kind has more
  for (uint32_t i = 0; i < count; ++i) numbers[i] = view.numbers[view.layers[layer].first_number + i];
  numbers[number] = value;
  return sound(kind, numbers);
}

uint32_t scene_check(const void* block, uint32_t bytes) noexcept {
  const auto* const at = static_cast<const uint8_t*>(block);
  constexpr uint32_t kAfter = offsetof(SceneHeader, check) + sizeof(SceneHeader::check);
  const uint32_t before = wire::crc32c(at, offsetof(SceneHeader, check));
  return wire::crc32c(at + kAfter, bytes - kAfter, before);
}

SceneFault read_scene_block(const void* block, uint32_t bytes, SceneView& view) noexcept {
  SceneHeader header;
  if (bytes < sizeof header) return SceneFault::size;
  __builtin_memcpy(&header, block, sizeof header);
  if (header.mark != kSceneMark) return SceneFault::mark;
  if (header.version != kSceneVersion) return SceneFault::version;
  const uint32_t patches = header.patches * uint32_t{sizeof(ScenePatch)},
                 layers = header.layers * uint32_t{sizeof(SceneLayer)},
                 numbers = header.numbers * uint32_t{sizeof(float)};
  const uint32_t before_tables = uint32_t{sizeof header} + patches + layers + numbers;
  if (bytes < before_tables || (bytes - before_tables) % sizeof(uint32_t) != 0 ||
      header.table_words != (bytes - before_tables) / sizeof(uint32_t))
    return SceneFault::size;
  if (header.check != scene_check(block, bytes)) return SceneFault::check;
  if (header.layers > kMostSceneLayers || header.patches > header.layers) return SceneFault::structure;
  const auto* const at = static_cast<const uint8_t*>(block) + sizeof header;
  SceneView read{reinterpret_cast<const ScenePatch*>(at),
                 reinterpret_cast<const SceneLayer*>(at + patches),
                 reinterpret_cast<const float*>(at + patches + layers),
                 reinterpret_cast<const uint32_t*>(at + patches + layers + numbers),
                 header.patches,
                 header.layers,
                 header.numbers,
                 header.table_words,
                 false,
                 false};
  if (const SceneFault fault = check_patches(read); fault != SceneFault::none) return fault;
  if (const SceneFault fault = check_layers(read); fault != SceneFault::none) return fault;
  view = read;
  return SceneFault::none;
}

}  // namespace tacto::core
