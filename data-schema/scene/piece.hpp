// SPDX-License-Identifier: GPL-3.0-or-later
// A piece: a solid in space whose surface a point touches (Massie 1996), and the law of its wall.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/scene/force_layer.hpp"

namespace tacto::schema {

enum class PieceShape { plane, sphere, cylinder, quadric, mesh, volume };

/// How pieces act: a ghost point stays on their surfaces (Zilles and Salisbury 1995), or each piece pushes to
/// its nearest face, and the forces add up.
enum class PieceContact { ghost, add };

/// Of x^2, y^2, z^2, xy, yz, xz, x, y, z and 1.
inline constexpr std::size_t kQuadricTerms = 10;

/// At a contact with the speed v inwards: beta v sin(2 pi f t) e^(-a t) (Fiene and Kuchenbecker 2007).
struct ContactTransient {
  double amplitude_n_s_per_m = 0;  ///< beta
  double frequency_hz = 0;         ///< f
  double decay_per_s = 0;          ///< a
};

/// A mass of the hand on a spring and a damper, which meets the spring and the damper of a surface: the
/// decaying part of its force at a contact is the transient (the same paper, model (12)).
struct HandSurface {
  double hand_mass_kg = 0, hand_damping_n_s_per_m = 0, hand_stiffness_n_per_m = 0;
  double surface_damping_n_s_per_m = 0, surface_stiffness_n_per_m = 0;
  double amplitude = 0.86;  ///< share of the model's force; people prefer this one (section 5)
};

struct HandSurfaceNumber {
  const char* name;
  double HandSurface::*value;
};
inline constexpr HandSurfaceNumber kHandSurfaceNumbers[] = {
    {"hand_mass_kg", &HandSurface::hand_mass_kg},
    {"hand_damping_n_s_per_m", &HandSurface::hand_damping_n_s_per_m},
    {"hand_stiffness_n_per_m", &HandSurface::hand_stiffness_n_per_m},
    {"surface_damping_n_s_per_m", &HandSurface::surface_damping_n_s_per_m},
    {"surface_stiffness_n_per_m", &HandSurface::surface_stiffness_n_per_m},
    {"amplitude", &HandSurface::amplitude}};

/// A breakpoint of the force of a wall's spring.
struct TravelPoint {
  double depth_m = 0, force_n = 0;
};

/// Above this force of its spring the values of a volume around the point fall.
struct Carving {
  double force_n = 0, value_per_s = 0;
};

/// A relief of clay: above this force of the wall's spring the 4 grid points around the point sink, and the 8
/// next to them half as fast (Massie 1996, section 3.7).
struct Clay {
  double force_n = 0, sink_m_per_s = 0;
  double thickness_m = 0;  ///< below the lowest height of the map: nothing sinks deeper
  bool kept = false;       ///< the volume: the surroundings rise by what sinks
  /// Not in the file, once its map was read for a device: half of what a height sinks in a tick, and between
  /// which ones the heights stay.
  double half_m = 0, least_m = 0, most_m = 0;
};

/// The last one is not in a file: a relief with interpolated normals is one.
enum class PieceTextureType { recording, bump, sine, normals };

/// What a surface adds to the force of its wall.
struct PieceTexture {
  PieceTextureType type = PieceTextureType::recording;
  std::string file;  ///< stem or file name of a texture or height map, from the scene's folder
  /// Bump: along the columns and rows of the map, whose centre is at the place of the piece. It is projected
  /// on the surface across both. Sine: amplitude x sin x sin of the places along both.
  std::array<std::array<double, 3>, 2> axes = {{{1, 0, 0}, {0, 1, 0}}};
  std::array<double, 2> periods_m = {};  ///< of a sine
  double amplitude_n = 0;
  /// Not in the file, once it was read: the largest force of a recording, N, and its largest slope, N/m; the
  /// largest slope of a map and its largest curvature, 1/m. At a gain of 1.
  double largest = 0, steepest = 0;
};

/// A plane with the heights of a map above it, along its normal; the centre of the map is at its place.
struct PieceRelief {
  std::string file;  ///< stem or file name of a height map, from the scene's folder
  /// Of its columns and rows, projected on the plane.
  std::array<std::array<double, 3>, 2> axes = {{{1, 0, 0}, {0, 1, 0}}};
  /// The surface stays flat, and the force of its wall turns to the normal of the map (Massie 1996).
  bool interpolated = false;
  /// Not in the file, once it was read: the largest slope, the largest curvature, 1/m, and the difference of
  /// the highest and the lowest height.
  double largest = 0, steepest = 0, range_m = 0;
  std::string surface = {};  ///< the same: its name among the surfaces that were read
};

/// A piece that moves along one direction, from its place on, between two stops: a mass with viscous and dry
/// friction, and detents, which are sine-shaped: -detent_n sin(2 pi place / detent_m).
struct PieceSlide {
  std::array<double, 3> direction = {1, 0, 0};
  double from_m = 0, to_m = 0;
  double mass_kg = 0, viscous_n_s_per_m = 0, friction_n = 0;
  double detent_n = 0, detent_m = 0;
};

struct SlideNumber {
  const char* name;
  double PieceSlide::*value;
};
inline constexpr SlideNumber kSlideNumbers[] = {
    {"from_m", &PieceSlide::from_m},         {"to_m", &PieceSlide::to_m},
    {"mass_kg", &PieceSlide::mass_kg},       {"viscous_n_s_per_m", &PieceSlide::viscous_n_s_per_m},
    {"friction_n", &PieceSlide::friction_n}, {"detent_n", &PieceSlide::detent_n},
    {"detent_m", &PieceSlide::detent_m}};

/// Of the detents around their places of rest.
double detent_stiffness_n_per_m(const PieceSlide& slide);

/// Unit vectors: the first axis, and the part of the second one across it. Precondition: check_pieces().
std::array<std::array<double, 3>, 2> map_axes(const std::array<std::array<double, 3>, 2>& axes);

struct Piece {
  std::string name;  ///< different for each piece of a scene
  PieceShape shape = PieceShape::plane;
  double x_m = 0, y_m = 0,
         z_m = 0;  ///< a point of a plane or an axis, a centre, a mesh's origin, a volume's middle
  std::array<double, 3> direction = {0, 0, 1};  ///< plane: out of the solid; cylinder: its axis
  double thickness_m = 0;                       ///< plane: of the plate below it; 0: without an end
  double radius_m = 0;                          ///< sphere, cylinder
  /// Quadric: solid where the sum of coefficient x term is below 0; terms in m, from the place.
  std::array<double, kQuadricTerms> coefficients = {};
  std::string mesh;  ///< mesh: the stem of its file, or the file
  double stiffness_n_per_m = 0;
  double damping_n_s_per_m = 0;
  /// Coefficients of the force along the normal: a spring of stiffness_n_per_m holds the hand along the
  /// surface up to the static one, then it slips to the kinetic one.
  double static_friction = 0, kinetic_friction = 0;
  double viscous_n_s_per_m = 0;  ///< against the hand's speed along the surface while it touches
  double arrest_mass_kg = 0;  ///< the impulse at the beginning of a contact is this mass x the normal speed
  double integral_n_per_m_s = 0;                             ///< growth of the force with depth and time
  double integral_bound_n = 0;                               ///< most of that force
  double integral_leak_per_s = 0;                            ///< share of that force which is lost per second
  std::optional<ContactTransient> transient = std::nullopt;  ///< or hand_surface, or none
  std::optional<HandSurface> hand_surface = std::nullopt;
  std::optional<PieceTexture> texture = std::nullopt;
  /// The force of the spring from 0 N at 0 m on, straight from point to point; two points of one depth are a
  /// click. Beyond the last one it grows with the stiffness. Empty: stiffness x depth.
  std::vector<TravelPoint> travel = {};
  double texture_gain = 1;
  std::optional<PieceRelief> relief = std::nullopt;  ///< plane
  std::optional<PieceSlide> slide = std::nullopt;
  std::map<std::string, SliderRange> sliders = {};  ///< of kWallNumbers that change, by their names
  std::string volume = {};                          ///< volume: the stem of its file, or the file
  double iso = 0;                                   ///< volume: solid where its value is above this one
  double value_per_m = 0;                           ///< volume: depth = (value - iso) / value_per_m
  std::optional<Carving> carve = std::nullopt;      ///< volume: how the point removes material
  /// Not in the file, once its volume was read: the largest slope of the depth, squared.
  double steepness = 1;
  std::optional<Clay> clay = std::nullopt;  ///< plane with a relief of exact normals
};

struct PieceNumber {
  const char* name;
  double Piece::*value;
  bool changes = false;  ///< may have a slider: it can change while the scene plays
};
/// The numbers of a wall, in the order of a block.
inline constexpr PieceNumber kWallNumbers[] = {{"stiffness_n_per_m", &Piece::stiffness_n_per_m, true},
                                               {"damping_n_s_per_m", &Piece::damping_n_s_per_m, true},
                                               {"arrest_mass_kg", &Piece::arrest_mass_kg},
                                               {"integral_n_per_m_s", &Piece::integral_n_per_m_s},
                                               {"integral_bound_n", &Piece::integral_bound_n},
                                               {"integral_leak_per_s", &Piece::integral_leak_per_s},
                                               {"static_friction", &Piece::static_friction, true},
                                               {"kinetic_friction", &Piece::kinetic_friction, true},
                                               {"viscous_n_s_per_m", &Piece::viscous_n_s_per_m, true},
                                               {"texture_gain", &Piece::texture_gain, true}};

/// Whether its surface is that of a height map.
inline bool is_raised(const Piece& piece) {
  return piece.relief && !piece.relief->interpolated;
}

/// Unit vectors in the plane. Precondition: it has a relief; check_pieces().
std::array<std::array<double, 3>, 2> relief_axes(const Piece& plane);

/// Under its name in the file, with its slider.
NamedLayerNumber named_number(const Piece& piece, const PieceNumber& number);

/// What is judged of a piece: it alone, or with all sliders at their upper ends, but dampings or not at the
/// lower ones; the last two of four the same with the least stiffness, which is the worse end of a wall with
/// an integral.
std::vector<Piece> slider_ends(const Piece& piece);

/// The steepest part of its spring: the stiffness, or of a travel the largest slope, at its end the
/// stiffness; of a volume the stiffness x its steepness.
double steepest_spring_n_per_m(const Piece& piece);

/// "plane", "sphere", "cylinder", "quadric", "mesh", "volume".
std::string_view to_string(PieceShape shape);

/// "ghost", "add".
std::string_view to_string(PieceContact contact);

/// "recording", "bump", "sine", "normals".
std::string_view to_string(PieceTextureType type);

}  // namespace tacto::schema
