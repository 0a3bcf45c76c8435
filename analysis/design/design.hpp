// SPDX-License-Identifier: GPL-3.0-or-later
// How stiff a scene may be on a device: the limit of each layer, the layer that becomes unstable first, and
// what changes that.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/design/judged_loop.hpp"
#include "analysis/design/simulated_taps.hpp"
#include "data-schema/results/results.hpp"
#include "data-schema/scene/scene.hpp"

namespace tacto::analysis {

/// What bounds and limits of a scene with several patches assume.
inline constexpr const char* kAssumedPlaces =
    "patches at the places and in the order of the scene; after 'move' or 'raise' other layers may act "
    "together";

struct DesignRequest {
  schema::Device device;
  std::optional<schema::Hand> hand;  ///< for Holder::hand and lumped
  std::optional<double> speed_mps;   ///< for Holder::slower
  double rate_hz = 0;
  Holder judged = Holder::nothing;  ///< which limit decides
  bool simulate = false;
  std::size_t adversary_paths = 0;
};

enum class Stability {
  stable,
  unstable,
  not_known,   ///< beyond what is proved, or with a layer for which no method computes it
  not_reached  ///< outside the travel, or hidden
};

/// "stable", "unstable", "not known", "not reached".
std::string_view to_string(Stability verdict);

/// The worst of the taps on the stiffest place of layers that act together.
struct SimulatedLayers {
  SimulatedTap tap;
  /// With a damper: up to where it rests; infinity if it does beyond the computed limit.
  std::optional<double> limit_n_per_m = std::nullopt;
};

/// A layer, where the layers that act there together are nearest to their limit.
struct JudgedLayer {
  std::string patch, type;
  std::size_t index = 0;            ///< in its patch
  std::vector<std::size_t> acting;  ///< patches at that place
  VirtualLoad own;                  ///< of a body the stiffness and damping of its coupling
  VirtualLoad total;                ///< of all layers that act at that place; sliders at the worse end
  double x_m = 0, y_m = 0;
  JudgedLoop loop;    ///< of the axis that is nearest to its limit
  double margin = 0;  ///< JudgedLoop::margin() of the judged limit
  Stability verdict = Stability::not_reached;
  std::string because;  ///< "proved for each passive hand", "computed by eigenvalues", ...
  std::optional<SimulatedLayers> simulated = std::nullopt;
  std::optional<double> generating_n_per_m = std::nullopt;  ///< playback::least_generating_stiffness()
};

/// A change that alone makes the layer stable.
struct Remedy {
  std::string change, now, needed;      ///< `needed` has the value, or says that none suffices
  std::optional<double> limit_n_per_m;  ///< computed again with the change
};

struct Design {
  DesignRequest request;
  std::vector<JudgedLayer> layers;
  std::optional<std::size_t> first;  ///< the layer of smallest margin
  std::vector<Remedy> remedies;      ///< for it, if it is not stable
  std::string simulated = {};        ///< by what; empty if nothing is
  bool is_unstable() const;
};

/// Springs, dampers, grooves, noise, height maps, textures and fields (their largest local stiffness), movers
/// (as dampers), bodies and lassos of all patches on the axes x and y, with the dampers that were added for
/// adaptive layers. Patches that act at one
/// place add up. A layer is unstable if the computed limit is passed, or if a simulated tap grows. Errors:
/// unsuitable: the scene has no patches; the delay is beyond 50 ticks; with `simulate`, those of
/// playback::prepare_scene(). `where` is the scene's file. Preconditions: grooves have a filter
/// (set_filters()), height maps were read (read_reliefs()), dampers of adaptive layers added
/// (add_adaptive_damping()); a device with an axis x or y, and a rate that it has.
schema::Result<Design> design_scene(const schema::Scene& scene, const std::string& where,
                                    const DesignRequest& request);

/// Stiffness, rate, damping, delay, encoder step, filter of grooves and adaptive viscosity, each changed
/// alone. Rates are those of the device. `of` is the layer; grooves have a filter.
std::vector<Remedy> remedies_for(const JudgedLayer& layer, const schema::ForceLayer& of,
                                 const DesignRequest& request);

/// The holders whose limits this request has: nothing, any, and those for which it has a hand or a speed;
/// lumped if it is judged.
std::vector<Holder> holders_of(const DesignRequest& request);

/// "nothing held", "hand minsky-radial", "any passive hand", ...
std::string holder_name(Holder holder, const DesignRequest& request);

/// Each limit but the lumped one over virtual damping, up to where that of the free device falls to 0, on the
/// axis of the first layer; the layers as marks. Precondition: there is a first layer.
schema::ResultPicture z_width(const Design& design);

/// The worst simulated tap: the place over time, and the layers as its title. Precondition: one was
/// simulated.
schema::ResultPicture worst_tap(const Design& design);

}  // namespace tacto::analysis
