// SPDX-License-Identifier: Apache-2.0
// A scene of force patches, or of pieces in space, as one block of plain data: prepared on the computer,
// checked, and read in place.
#pragma once

#include <stdint.h>

#include "firmware-host/core/scene/field.hpp"
#include "firmware-host/core/scene/lattice_place.hpp"
#include "firmware-host/core/scene/noise.hpp"

namespace tacto::core {

inline constexpr uint32_t kSceneMark = 0x4E435354;  ///< "TSCN"
inline constexpr uint16_t kSceneVersion = 1;
inline constexpr uint32_t kMostSceneLayers = 256;
inline constexpr uint32_t kMostLayerNumbers = 3;  ///< but of bodies and lassos
inline constexpr uint32_t kMostSceneBodies = 16;  ///< bodies and lassos
inline constexpr uint32_t kMostPieces = 32;
inline constexpr uint32_t kPatchWords = 3;  ///< of a patch in the kernel's memory: its place and its order

/// The kinds of layers that the kernel has. A number is never reused.
enum class SceneLayerKind : uint16_t {
  spring = 0,
  damper = 1,
  grooves = 2,
  noise = 3,
  height_map = 4,
  body = 5,
  lasso = 6,
  mover = 7,
  field = 8,
  force_map = 9,
  tick_damper = 10,
  plane = 16,
  sphere = 17,
  cylinder = 18,
  quadric = 19,
  mesh = 20,
  relief = 22,
  volume = 24
};

/// Whether a layer is a piece: a solid in space. In a block either all layers are pieces or none is.
constexpr bool is_piece(SceneLayerKind kind) noexcept {
  return (kind >= SceneLayerKind::plane && kind <= SceneLayerKind::mesh) || kind == SceneLayerKind::relief ||
         kind == SceneLayerKind::volume;
}

constexpr bool is_known(SceneLayerKind kind) noexcept {
  return kind <= SceneLayerKind::tick_damper || is_piece(kind);
}

/// The places of a layer's numbers, from its first one.
enum SpringNumber : uint32_t { kSpringStiffness = 0, kSpringCentreX = 1, kSpringCentreY = 2 };
enum DamperNumber : uint32_t { kDamperDamping = 0 };
enum SurfaceNumber : uint32_t { kSurfaceDepth = 0, kSurfaceKappa = 1 };
enum HeightMapNumber : uint32_t { kHeightMapKappa = 0 };
enum BodyNumber : uint32_t {
  kBodyStiffness = 0,
  kBodyDamping = 1,
  kBodyStaticFriction = 2,
  kBodyKineticFriction = 3
};
enum LassoNumber : uint32_t { kLassoStiffness = 0, kLassoLength = 1 };
enum MoverNumber : uint32_t { kMoverDamping = 0, kMoverSpeed = 1 };
/// Behind these numbers of a body and a lasso: its state (BodyState), 0 in a block.
inline constexpr uint32_t kBodyStateWords = 9;
enum PieceNumber : uint32_t {
  kPieceStiffness = 0,
  kPieceDamping = 1,
  kPieceArrestMass = 2,
  kPieceIntegral = 3,
  kPieceIntegralBound = 4,
  kPieceIntegralLeak = 5,
  kPieceStaticFriction = 6,
  kPieceKineticFriction = 7,
  kPieceViscous = 8,
  kPieceTextureGain = 9,
  kPieceNumbers = 10
};
/// Behind these numbers of a piece: its state (WallState), 0 in a block.
inline constexpr uint32_t kWallStateWords = 17;
enum FieldNumber : uint32_t { kFieldScale = 0, kFieldZ = 1 };
enum ForceMapNumber : uint32_t { kForceMapGain = 0 };

/// Whether a layer of a kind has a state.
constexpr bool has_body(SceneLayerKind kind) noexcept {
  return kind == SceneLayerKind::body || kind == SceneLayerKind::lasso;
}

/// How many numbers of a layer of a kind can change.
constexpr uint32_t changeable_numbers_of(SceneLayerKind kind) noexcept {
  switch (kind) {
    case SceneLayerKind::spring:
      return 3;
    case SceneLayerKind::damper:
    case SceneLayerKind::tick_damper:
    case SceneLayerKind::height_map:
    case SceneLayerKind::force_map:
      return 1;
    case SceneLayerKind::body:
      return 4;
    case SceneLayerKind::plane:
    case SceneLayerKind::sphere:
    case SceneLayerKind::cylinder:
    case SceneLayerKind::quadric:
    case SceneLayerKind::mesh:
    case SceneLayerKind::relief:
    case SceneLayerKind::volume:
      return kPieceNumbers;
    case SceneLayerKind::grooves:
    case SceneLayerKind::noise:
    case SceneLayerKind::lasso:
    case SceneLayerKind::mover:
    case SceneLayerKind::field:
      break;
  }
  return 2;
}

/// How many numbers a layer of a kind has in a block.
constexpr uint32_t numbers_of(SceneLayerKind kind) noexcept {
  return changeable_numbers_of(kind) + (has_body(kind)   ? kBodyStateWords
                                        : is_piece(kind) ? kWallStateWords
                                                         : 0);
}

/// The block is, in this order and little-endian: this header, the patches, the layers, the numbers, the
/// tables of the layers that have one: what cannot change while the scene plays.
struct SceneHeader {
  uint32_t mark = kSceneMark;
  uint16_t version = kSceneVersion;
  uint16_t patches = 0, layers = 0, numbers = 0;
  uint32_t check = 0;  ///< CRC-32C of the fields above and of all that follows this one
  uint32_t table_words = 0;
};
static_assert(sizeof(SceneHeader) == 20);

/// A rectangle in the plane, turned by the angle of `cosine` and `sine`. The topmost patch is the first one.
struct ScenePatch {
  float centre_x_m = 0, centre_y_m = 0;
  float cosine = 1, sine = 0;
  float half_width_m = 0, half_height_m = 0;
  uint16_t first_layer = 0, layers = 0;
  uint32_t adds = 0;  ///< 1: it acts beside the topmost patch
};
static_assert(sizeof(ScenePatch) == 32);

struct SceneLayer {
  uint16_t kind = 0;  ///< SceneLayerKind
  uint16_t first_number = 0;
  uint32_t table = 0;  ///< place of its table, in words of 4 bytes
};
static_assert(sizeof(SceneLayer) == 8);

/// Periods per count of the encoder: whole + part 2^-32 + rest 2^-64.
struct SceneStride {
  int32_t whole = 0;
  uint32_t part = 0, rest = 0;
};

/// A place on a surface in periods, from the counts of the axes: at count 0 whole + part 2^-32.
struct SceneRow {
  int32_t whole = 0;
  uint32_t part = 0;
  SceneStride per_count[2];  ///< of the axes along x and y
};
static_assert(sizeof(SceneRow) == 32);

/// Before the amplitudes of the harmonics, from the first on, f32, for a depth of 1.
struct GroovesTable {
  SceneRow across;
  float periods_per_m_x = 0, periods_per_m_y = 0;  ///< in the axes of the patch
  uint32_t harmonics = 0;
};
static_assert(sizeof(GroovesTable) == 44);

/// Before the amplitudes of the octaves, from the lowest on, f32, for a depth of 1. The surface is the
/// section of the noise at z = 0.
struct NoiseSurfaceTable {
  SceneRow along[2];        ///< along the axes x and y of the patch
  float periods_per_m = 0;  ///< of the lowest octave
  uint32_t octaves = 0;
  NoiseTable gradients;
};
static_assert(sizeof(NoiseSurfaceTable) == 328);

/// Before the atoms. A unit of length is 2^-32 of a period of the rows, which is more than four times as far
/// as an atom, or a place in the patch, is from its centre: so their differences do not wrap.
struct FieldTable {
  SceneRow along[2];      ///< along the axes x and y of the patch
  float units_per_m = 0;  ///< for z
  float core = 1;         ///< FieldForce
  uint32_t atoms = 0;
};
static_assert(sizeof(FieldTable) == 76);

inline const FieldAtom* atoms_of(const FieldTable& table) noexcept {
  return reinterpret_cast<const FieldAtom*>(&table + 1);
}

inline constexpr uint32_t kMostReliefLevels = 32;
/// Of a height map within 1 m: 3 along each axis if its signs alternate.
inline constexpr float kLargestCoefficient_m = 10;
/// The same of a force map of forces up to 1000 N.
inline constexpr float kLargestCoefficient_n = 1e4F;

/// The levels of a height map, from the finest on: this, the levels, then the coefficients of all levels,
/// f32, one level after the other, row by row. Of a force map these are the coefficients of the forces along
/// the columns; then follow as many of the forces along the rows.
struct ReliefTable {
  float highest_per_m =
      0;  ///< spatial frequency, of the first level; half an octave less of each further one
  uint32_t levels = 0;
  float cosine = 1, sine = 0;  ///< of the angle of the map in the patch
};
static_assert(sizeof(ReliefTable) == 16);

struct ReliefLevelTable {
  SceneRow along[2];            ///< along the columns and rows of the map, in samples
  float samples_per_m[2] = {};  ///< along them
  uint32_t columns = 0, rows = 0;
  uint32_t first = 0;  ///< of its coefficients, among those of all levels
};
static_assert(sizeof(ReliefLevelTable) == 84);

inline const ReliefLevelTable* levels_of(const ReliefTable& table) noexcept {
  return reinterpret_cast<const ReliefLevelTable*>(&table + 1);
}

inline const float* coefficients_of(const ReliefTable& table, const ReliefLevelTable& level) noexcept {
  return reinterpret_cast<const float*>(levels_of(table) + table.levels) + level.first;
}

/// Of all levels, of one component.
inline uint32_t coefficient_count(const ReliefTable& table) noexcept {
  const ReliefLevelTable& last = levels_of(table)[table.levels - 1];
  return last.first + last.columns * last.rows;
}

/// The numbers behind a table: amplitudes.
template <class Table>
const float* amplitudes_of(const Table& table) noexcept {
  return reinterpret_cast<const float*>(&table + 1);
}

/// The motion of a body of mass m with the damping b of its surroundings over a tick T, in which its force is
/// constant (its exact discretisation, computed in double precision; z = b T / m):
///     speed += speed_loss speed + speed_by_force force,    place += place_by_speed speed + place_by_force
///     force
/// speed_loss = e^-z - 1, place_by_speed = T (1 - e^-z) / z, speed_by_force = place_by_speed / m,
/// place_by_force = (T^2 / m) (z - 1 + e^-z) / z^2; without damping 0, T, T / m and T^2 / (2 m).
struct BodyTable {
  float speed_loss = 0, place_by_speed_s = 0, speed_by_force_s_per_kg = 0, place_by_force_s2_per_kg = 0;
};
static_assert(sizeof(BodyTable) == 16);

/// The direction in which an object moves by itself.
struct MoverTable {
  float cosine = 1, sine = 0;  ///< of its angle in the patch
};
static_assert(sizeof(MoverTable) == 8);

/// The places in the form of a piece: of a quadric its ten coefficients, of the others a unit vector and a
/// size (of a plane its normal and the thickness of the plate, 0 without an end; of a cylinder its axis and
/// radius; of a sphere the radius). With the radius of the point that touches.
enum PieceForm : uint32_t { kPieceDirection = 0, kPieceSize = 3, kPieceFormWords = 10 };

/// A contact's transient, a solution of s'' + 2 a s' + W^2 s = 0: from tick to tick (s, c) += (step[0] s +
/// step[1] c, step[2] s + step[3] c), from the speed inwards x `start` on; s is the force, c = s' / W.
struct TransientTable {
  float start_n_s_per_m[2] = {};  ///< 0: none
  float step[4] = {-1, 0, 0, -1};
};
static_assert(sizeof(TransientTable) == 24);

/// A solid in space. Its origin is at whole counts of the axes x, y and z, and a rest.
struct PieceTable {
  int32_t origin[3] = {};
  float rest_m[3] = {};
  float form[kPieceFormWords] = {};
  TransientTable transient = {};
  uint32_t travel = 0;   ///< words from its beginning to its TravelTable; 0: none
  uint32_t texture = 0;  ///< the same of its PieceTextureTable
  uint32_t slide = 0;    ///< the same of its SlideTable
};
static_assert(sizeof(PieceTable) == 100);

/// A triangle mesh: this, then the nodes, the triangles as three vertices each (u32), counter-clockwise from
/// outside, and the vertices as three coordinates each (f32, m, from the origin of the piece).
struct MeshTable {
  PieceTable piece;  ///< of its form only the size is used: the half extent, within which all vertices are
  float skin_m = 0;  ///< distance that the ghost keeps from the triangles; half of it is never undercut
  uint32_t nodes = 0, triangles = 0, vertices = 0;
};
static_assert(sizeof(MeshTable) == 116);

inline constexpr uint32_t kMostLeafTriangles = 7;

/// A box of the tree, around triangles and their skin. The tree is stored from the root on, each node before
/// what is below it: a way that misses a box goes on at `skip`, otherwise at the next node.
struct MeshNode {
  float least_m[3] = {}, most_m[3] = {};
  uint32_t skip = 0;  ///< larger than its own place
  uint32_t leaf = 0;  ///< first triangle x 8 + number of triangles; number 0: not a leaf
};
static_assert(sizeof(MeshNode) == 32);

inline const MeshNode* nodes_of(const MeshTable& table) noexcept {
  return reinterpret_cast<const MeshNode*>(&table + 1);
}
inline const uint32_t* triangles_of(const MeshTable& table) noexcept {
  return reinterpret_cast<const uint32_t*>(nodes_of(table) + table.nodes);
}
inline const float* vertices_of(const MeshTable& table) noexcept {
  return reinterpret_cast<const float*>(triangles_of(table) + 3 * static_cast<uint64_t>(table.triangles));
}

inline constexpr uint32_t kMostTravelPoints = 32;

/// The force of a wall's spring at a depth. From 0 N at a depth of 0 to the first point, and from point to
/// point, it is straight; two points of the same depth are a jump. Beyond the last one it grows with the
/// stiffness of the piece.
struct TravelPoint {
  float depth_m = 0, force_n = 0;
};
struct TravelTable {
  uint32_t points = 0;  ///< TravelPoint, behind this
};
inline const TravelPoint* points_of(const TravelTable& table) noexcept {
  return reinterpret_cast<const TravelPoint*>(&table + 1);
}
/// Precondition: it has one.
inline const TravelTable& travel_of(const PieceTable& table) noexcept {
  return *reinterpret_cast<const TravelTable*>(reinterpret_cast<const uint32_t*>(&table) + table.travel);
}

/// A piece that moves along an axis, between two stops; behind its travel.
struct SlideTable {
  float axis[3] = {1, 0, 0};          ///< unit vector
  float from_m = 0, to_m = 0;         ///< stops, from where it begins: from <= 0 <= to
  float speed_by_force_s_per_kg = 1;  ///< T / m
  float kept = 1;        ///< share of a speed after a tick of viscous friction: 1 / (1 + T b / m)
  float friction_n = 0;  ///< dry
  float detent_n = 0, detents_per_m = 0;  ///< force -detent_n sin(2 pi detents_per_m place)
};
static_assert(sizeof(SlideTable) == 40);

/// Precondition: it has one.
inline const SlideTable& slide_of(const PieceTable& table) noexcept {
  return *reinterpret_cast<const SlideTable*>(reinterpret_cast<const uint32_t*>(&table) + table.slide);
}

enum class PieceTextureKind : uint32_t { recording = 1, bump = 2, sine = 3, normals = 4 };

/// Behind all other words of a piece, and, but of a sine, before a relief (ReliefTable).
struct PieceTextureTable {
  uint32_t kind = 0;      ///< PieceTextureKind
  float per_m[2] = {};    ///< of a recording: how often a path plays it forth and back; of a sine: periods
  float amplitude_n = 0;  ///< of a sine
  float axes[2][3] = {{1, 0, 0}, {0, 1, 0}};  ///< of a map, unit vectors
  float origin_m[2] = {};                     ///< on the map: the origin of the piece
};
static_assert(sizeof(PieceTextureTable) == 48);

/// Precondition: it has one.
inline const PieceTextureTable& texture_of(const PieceTable& table) noexcept {
  return *reinterpret_cast<const PieceTextureTable*>(reinterpret_cast<const uint32_t*>(&table) +
                                                     table.texture);
}
inline const ReliefTable& relief_of(const PieceTextureTable& texture) noexcept {
  return *reinterpret_cast<const ReliefTable*>(&texture + 1);
}

/// How the heights of a relief sink: press_clay(). All of these lengths and the heights are whole multiples
/// of one power of two of a metre, at most 2^24 times it: so in single precision their sums are exact.
struct ClayTable {
  float force_n = 0;              ///< of the spring above which the point presses them; 0: never
  float half_m = 0;               ///< d / 2: of a tick
  float least_m = 0, most_m = 0;  ///< no height falls below, or rises above
  uint32_t kept = 0;              ///< 1: the surroundings rise by what sinks
};
static_assert(sizeof(ClayTable) == 20);

/// A plane that a height map raises along its normal: this, then the map (ReliefTable) of one level.
struct ReliefPieceTable {
  PieceTable piece;                           ///< of its form the normal of the plane
  float axes[2][3] = {{1, 0, 0}, {0, 1, 0}};  ///< of the map, unit vectors across each other and the normal
  float origin_m[2] = {};                     ///< on the map: the origin of the piece
  float bend_per_m = 0;  ///< at least the largest second derivative of the heights, in any direction
  ClayTable clay = {};
};
static_assert(sizeof(ReliefPieceTable) == 156);

inline const ReliefTable& relief_of(const ReliefPieceTable& table) noexcept {
  return *reinterpret_cast<const ReliefTable*>(&table + 1);
}

/// A block that was read; it points into its memory.
struct SceneView {
  const ScenePatch* patches = nullptr;
  const SceneLayer* layers = nullptr;
  const float* numbers = nullptr;
  const uint32_t* tables = nullptr;
  uint32_t patch_count = 0, layer_count = 0, number_count = 0, table_words = 0;
  bool needs_speed = false;    ///< it has a layer whose force depends on the speed
  bool in_space = false;       ///< its layers are pieces, all of one patch; that adds: contact `add`
  bool tables_change = false;  ///< the hand changes its tables: volumes that are carved, clay

  /// Of 4 bytes, of the memory that a kernel needs beside the block: the numbers, the places and the order of
  /// the patches and, if they change, the tables.
  uint32_t live_words() const noexcept { return words_before_tables() + (tables_change ? table_words : 0); }
  uint32_t words_before_tables() const noexcept { return number_count + patch_count * kPatchWords; }
  /// With the numbers and tables as they are now in such a memory. Safe in the tick.
  SceneView as_in(const float* live) const noexcept {
    SceneView now = *this;
    now.numbers = live;
    if (tables_change) now.tables = reinterpret_cast<const uint32_t*>(live + words_before_tables());
    return now;
  }
};

enum class SceneFault : uint8_t {
  none,
  size,       ///< shorter or longer than its header says
  mark,       ///< not a scene
  version,    ///< of another version
  check,      ///< changed since it was made
  structure,  ///< a patch or layer refers to what is not there, or a kind is not known
  value,      ///< a number out of its range, or not a number
};

/// Makes a view of a block, whose memory is aligned to 4 bytes. Refuses every block that could make the
/// kernel read outside of it or compute a force that is not finite. Sets `view` only if there is no fault.
SceneFault read_scene_block(const void* block, uint32_t bytes, SceneView& view) noexcept;

/// The check of a block of at least a header's size.
uint32_t scene_check(const void* block, uint32_t bytes) noexcept;

/// The table of a layer, whose kind has one. Safe in the tick.
template <class Table>
const Table& table_of(const SceneView& view, const SceneLayer& layer) noexcept {
  static_assert(alignof(Table) == alignof(uint32_t));
  return *reinterpret_cast<const Table*>(view.tables + layer.table);
}

inline uint64_t joined(int32_t whole, uint32_t part) noexcept {
  return uint64_t{static_cast<uint32_t>(whole)} << 32 | part;
}

/// The place of a hand on a surface: exact but for 2^-33 periods per axis, and wraps at 2^31 periods. Safe in
/// the tick.
inline Q32 place_on(const SceneRow& row, const int32_t (&counts)[2]) noexcept {
  uint64_t place = joined(row.whole, row.part);
  for (int i = 0; i < 2; ++i) {
    const SceneStride& stride = row.per_count[i];
    const int64_t count = counts[i];
    place += static_cast<uint64_t>(count) * joined(stride.whole, stride.part);
    place += static_cast<uint64_t>((count * static_cast<int64_t>(stride.rest)) >> 32);
  }
  return static_cast<Q32>(place);
}

/// Whether a layer has this number, and may have this value.
bool number_fits(const SceneView& view, uint32_t layer, uint32_t number, float value) noexcept;

/// The farthest that a patch is moved, in counts: the difference of two places is a number of 32 bits.
inline constexpr int32_t kFarthestMove = (INT32_C(1) << 30) - 1;

struct PlaneVector {
  float x = 0, y = 0;
};

/// A vector of the plane in the axes of a patch. Safe in the tick.
inline PlaneVector into_patch(const ScenePatch& patch, PlaneVector v) noexcept {
  return {patch.cosine * v.x + patch.sine * v.y, patch.cosine * v.y - patch.sine * v.x};
}

/// The place in the axes of a patch, from its centre. Safe in the tick.
inline PlaneVector place_in_patch(const ScenePatch& patch, PlaneVector place) noexcept {
  return into_patch(patch, {place.x - patch.centre_x_m, place.y - patch.centre_y_m});
}

/// Whether a place, in the axes of the patch, belongs to it; its border does. Safe in the tick.
inline bool within_patch(const ScenePatch& patch, PlaneVector place) noexcept {
  return place.x >= -patch.half_width_m && place.x <= patch.half_width_m && place.y >= -patch.half_height_m &&
         place.y <= patch.half_height_m;
}

}  // namespace tacto::core
