// SPDX-License-Identifier: GPL-3.0-or-later
// Layers that give a force on the hand from its place and speed in a plane (Minsky 1990).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/one_of.hpp"

namespace tacto::schema {

/// The range in which a number may be changed while the scene is played.
struct SliderRange {
  double from = 0, to = 0;
  bool operator==(const SliderRange&) const = default;
};

/// A number of a layer, and its slider if it has one. In the file: 3, or {"value": 3, "slider": {"from": 1,
/// "to": 5}}.
struct LayerNumber {
  double value = 0;
  std::optional<SliderRange> slider = std::nullopt;
  bool operator==(const LayerNumber&) const = default;
};

/// The upper end of its slider, or its value.
inline double largest_value(const LayerNumber& number) {
  return number.slider ? number.slider->to : number.value;
}

/// The lower end of its slider, or its value.
inline double least_value(const LayerNumber& number) {
  return number.slider ? number.slider->from : number.value;
}

// Lengths and directions are in the patch's axes, from its centre; a direction is an angle from the patch's x
// axis towards its y axis. kappa_n is the force on a slope of 1: force = -kappa grad h. `extra_json` has the
// members of a newer version. `adaptive`: where the layer is too stiff for the device, damping is added
// (playback/prepare/scene/stable_scene.hpp).

/// A measured or computed relief.
struct HeightMapLayer {
  std::string file;  ///< stem or NAME.height.nc, from the scene's folder
  LayerNumber kappa_n;
  std::string extra_json;
  double curvature_per_m = 0;  ///< not in the file: the largest of its surface in the patch, once it was read
  bool adaptive = false;
};

enum class GrooveProfile { sine, triangle, square };

/// Parallel grooves; depth_m is from top to bottom.
struct GroovesLayer {
  GrooveProfile profile = GrooveProfile::sine;
  LayerNumber period_m, depth_m, kappa_n;
  LayerNumber direction_deg;  ///< across the grooves
  /// Sigma of the Gaussian filter that smooths the profile in advance; none: computed from the device's limit
  /// ("auto" in the file).
  std::optional<LayerNumber> filter_m = std::nullopt;
  LayerNumber filter_margin{1.5};  ///< factor on the computed sigma
  std::string extra_json;
  bool adaptive = false;
};

/// Perlin's improved noise, in octaves; `roughness` is the factor from the amplitude of one to the next.
struct NoiseLayer {
  LayerNumber period_m;    ///< of the lowest octave
  LayerNumber octaves{1};  ///< a whole number
  LayerNumber roughness{0.5};
  LayerNumber seed;  ///< a whole number
  LayerNumber depth_m, kappa_n;
  std::string extra_json;
  bool adaptive = false;
};

/// The end of its slider that is farther from 0, or its value.
inline double farthest_value(const LayerNumber& number) {
  if (!number.slider) return number.value;
  return -number.slider->from > number.slider->to ? number.slider->from : number.slider->to;
}

/// A recorded texture, across a direction; its middle is at the centre of the patch. Force on the hand along
/// the direction: the gain times the stored force, 0 beyond its ends.
struct TextureForceLayer {
  std::string file;           ///< stem or file name of the texture, from the scene's folder
  LayerNumber direction_deg;  ///< along which the texture's position grows
  LayerNumber gain{1};        ///< 1; its sign may invert the texture
  std::string extra_json;
  double steepest_n_per_m = 0;  ///< not in the file: of its force at a gain of 1, once it was read
  bool adaptive = false;
};

/// A spring to a place.
struct SpringLayer {
  LayerNumber stiffness_n_per_m;
  LayerNumber centre_x_m, centre_y_m;  ///< where its force is 0
  std::string extra_json;
  bool adaptive = false;
};

/// A viscous medium: soup (large damping), ice (small damping, on a patch above soup).
struct DamperLayer {
  LayerNumber damping_n_s_per_m;
  std::string extra_json;
  bool added = false;  ///< not in the file: it was added for the adaptive layers of its patch
};

/// A brick: a mass with dry friction on its base, coupled to the hand by a spring and a damper. It is taken
/// up at rest where the hand enters the patch.
struct BodyLayer {
  LayerNumber mass_kg, stiffness_n_per_m;
  LayerNumber damping_n_s_per_m;
  LayerNumber static_friction_n;   ///< below this force it does not start to move
  LayerNumber kinetic_friction_n;  ///< against its motion; at most the static friction
  std::string extra_json;
};

/// A mass on a spring that only pulls: its force is 0 up to length_m. It is taken up as a body is.
struct LassoLayer {
  LayerNumber mass_kg, stiffness_n_per_m, length_m;
  LayerNumber damping_n_s_per_m;  ///< of the motion of the mass in the patch
  std::string extra_json;
};

/// An object that moves by itself and drags the hand: force = damping (speed of the object - speed of the
/// hand).
struct MoverLayer {
  LayerNumber speed_mps, damping_n_s_per_m;
  LayerNumber direction_deg;
  std::string extra_json;
};

/// Forces that were computed in advance, on a grid. The origin of its places is the centre of the patch. They
/// need not have a potential: the energy that a turn of the hand gains is at most the curl times its area.
struct ForceMapLayer {
  std::string file;     ///< CSV of nodes, from the scene's folder (force_grid.hpp)
  LayerNumber gain{1};  ///< 1
  std::string extra_json;
  /// Not in the file: at a gain of 1, once it was read. The largest stiffness, and the most negative one.
  double attracting_n_per_m = 0, repelling_n_per_m = 0, curl_n_per_m = 0;
};

/// The field of atoms (Lennard-Jones and Coulomb) on a probe, in a plane section through them. The origin of
/// the atoms is the centre of the patch.
struct FieldLayer {
  std::string file;          ///< CSV of atoms, from the scene's folder (atoms.hpp)
  LayerNumber length_scale;  ///< length on the bench, divided by that of the atoms
  LayerNumber force_scale;   ///< force on the hand, divided by that on the probe
  LayerNumber z_m;           ///< of the section in which the hand moves, on the bench
  LayerNumber core{1};       ///< radius of the core, where the force is bounded, divided by sigma
  LayerNumber probe_charge_c;
  std::string extra_json;
  double stiffest_n_per_m = 0;  ///< not in the file: on the bench at a force_scale of 1, once it was read
};

/// One layer of a patch, of one kind. Code that reads a layer handles every kind of it, or does not compile.
using ForceLayer = OneOf<HeightMapLayer, GroovesLayer, NoiseLayer, TextureForceLayer, SpringLayer,
                         DamperLayer, BodyLayer, LassoLayer, MoverLayer, ForceMapLayer, FieldLayer>;

/// "sine", "triangle", "square".
std::string_view to_string(GrooveProfile profile);

/// The layer's `type` in the file: "height_map", "grooves", ...
std::string_view type_of(const ForceLayer& layer);

/// All types, in the order of ForceLayer.
std::vector<std::string> force_layer_types();

/// A number of a layer under its name in the file.
struct NamedLayerNumber {
  std::string_view name;
  LayerNumber number;
  bool changes = true;  ///< may have a slider: it can change while the scene plays
  bool whole = false;   ///< a whole number
};

/// The numbers of a layer, in the order of the file. `filter_m` is absent where it is "auto".
std::vector<NamedLayerNumber> numbers_of(const ForceLayer& layer);

/// Errors: unsuitable, by JSON pointer: a number with a slider that cannot change, or is outside of it.
/// `where` is the pointer of its layer or piece.
Result<void> check_slider(const NamedLayerNumber& named, const std::string& where);

/// Whether the layer has `adaptive`, and it is true.
bool is_adaptive(const ForceLayer& layer);
/// Makes `adaptive` of a layer that has it false.
void clear_adaptive(ForceLayer& layer);

/// Whether the layer is not in the file, but was added for adaptive layers.
bool is_added(const ForceLayer& layer);

/// The file that a layer names; empty for a kind without one.
std::string file_of(const ForceLayer& layer);

}  // namespace tacto::schema
