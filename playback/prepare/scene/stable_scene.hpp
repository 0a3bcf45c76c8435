// SPDX-License-Identifier: GPL-3.0-or-later
// Where the layers of a scene are unstable on a force device, and two remedies: added damping, less
// stiffness.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/scene/scene.hpp"
#include "playback/prepare/scene/acting_load.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"
#include "playback/stability/acting_patches.hpp"

namespace tacto::playback {

/// Both remedies make the limit this many times the stiffness of the layers. The limit is that of a velocity
/// between two ticks; the kernel's is later at low speed. With it, the case of Minsky 1990 (2773 N/m at 100
/// Hz, 0.8 kg, 5 N s/m) gets the 15 N s/m of the paper.
inline constexpr double kStableMargin = 1.2;

/// Layers that act together, and the least limit of their stiffness over the sliders of their dampers.
struct PlaceLimit {
  ActingPatches place;
  ActingLoad load;
  double damping_n_s_per_m = 0;  ///< at which the limit is the least
  double limit_n_per_m = 0;      ///< stiffness_limit_of()
  /// The part of the limit that they need: unstable from 1 on, infinity without a limit.
  double used() const;
};

/// Of each set of layers that acts somewhere, with springs or dampers. `patches` as in a scene's file.
/// Precondition: mass and friction of the device are known.
std::vector<PlaceLimit> place_limits(const std::vector<schema::Patch>& patches, const schema::Device& device,
                                     double rate_hz, const std::optional<schema::Hand>& hand);

/// The least damping, beside that of the load, with which kStableMargin times its stiffness is stable; 0 if
/// it is without (adaptive viscosity, Minsky 1990: where 2 B / K < T, B is raised above T K / 2; here the
/// limit is stiffness_limit_of(), which takes the damper as sampled). Never beyond the limit of a sampled
/// damper, B < 2 M / T, M with the hand; nor beyond what the velocity's rounding allows: at each count of the
/// encoder the force of the damper changes by B D / T, which may not exceed the Coulomb friction of the axis
/// or, if that is larger, the change K D of the stiffness itself. Errors: unsuitable: no such damping, or the
/// device does not state its mass.
schema::Result<double> added_damping(const ActingLoad& load, const schema::Device& device, double rate_hz,
                                     const std::optional<schema::Hand>& hand);

/// Adds a damper to each patch whose adaptive layers need one. Where several patches with adaptive layers act
/// together, each adds a part in proportion to the stiffness of these; a patch adds the largest part that it
/// needs anywhere. A scene that has such dampers stays as it is. Precondition: the stiffness of each layer is
/// known (set_filters(), read_reliefs()). Errors: those of added_damping(), by JSON pointer.
schema::Result<void> add_adaptive_damping(schema::Scene& scene, const std::string& where,
                                          const schema::Device& device, double rate_hz,
                                          const std::optional<schema::Hand>& hand);

/// A layer whose stiffness was scaled.
struct HeldLayer {
  std::string patch, type;
  std::size_t index = 0;  ///< in its patch
  double from_n_per_m = 0, to_n_per_m = 0;
  std::string_view member = {};  ///< the number that was scaled, with its slider
};

/// Where layers that act together are beyond their limit, scales the stiffness of all of them (of sliders the
/// range, too) to the limit divided by kStableMargin. Preconditions: as add_adaptive_damping(); `patches` as
/// in a scene's file. Errors: unsuitable: a place where no stiffness is stable; the device does not state its
/// mass.
schema::Result<std::vector<HeldLayer>> hold_stable(std::vector<schema::Patch>& patches,
                                                   const schema::Device& device, double rate_hz,
                                                   const std::optional<schema::Hand>& hand);

/// The same for a scene that was prepared. Errors: also unsuitable: pieces.
schema::Result<std::vector<HeldLayer>> hold_stable(PreparedScene& scene, const schema::Device& device,
                                                   double rate_hz, const std::optional<schema::Hand>& hand);

/// "spring 0 of patch 'a': held stable, 5000 N/m to 1669 N/m".
std::string held_words(const HeldLayer& layer);

}  // namespace tacto::playback
