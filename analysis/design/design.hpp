// SPDX-License-Identifier: GPL-3.0-or-later
// How stiff a scene may be on a device: the limit of each layer, the layer that becomes unstable first, and
// what changes that.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/design/simulated_taps.hpp"
#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/results/results.hpp"
#include "data-schema/scene/scene.hpp"
#include "playback/stability/sampled_loop.hpp"

namespace tacto::analysis {

// One axis of a device with a virtual spring and damper, and the five limits by which it can be judged.

inline constexpr double kMostDelayTicks = 50;

/// What holds the device.
enum class Holder {
  nothing,  ///< computed by eigenvalues (playback/stability/free_limit.hpp)
  hand,     ///< one known hand, computed by eigenvalues (playback/stability/hand_limit.hpp)
  lumped,   ///< the same as Minsky 1990 computes it
  any,      ///< each passive hand, proved (playback/stability/passive_limit.hpp)
  slower,   ///< each passive hand below a speed, proved (same)
};

/// Proved limits are sufficient; computed ones are exact for the linear device without Coulomb friction and
/// encoder.
constexpr bool is_proof(Holder holder) {
  return holder == Holder::any || holder == Holder::slower;
}

/// Bodies are computed by the eigenvalues of the whole loop; no proof covers them.
constexpr bool is_computed_with_bodies(Holder holder) {
  return holder == Holder::nothing || holder == Holder::hand;
}

/// What the layers at one place add up to.
using VirtualLoad = playback::SampledLoad;

inline bool is_nothing(const VirtualLoad& load) {
  return load.stiffness_n_per_m <= 0 && load.damping_n_s_per_m <= 0 && load.bodies.empty();
}

struct JudgedLoop {
  schema::DeviceAxis axis;
  std::optional<schema::Hand> hand;
  std::optional<double> speed_mps;
  double period_s = 0, delay_s = 0;

  playback::TickTiming timing() const { return {period_s, delay_s / period_s}; }
  /// N/m at this virtual damping. Preconditions: a hand for `hand` and `lumped`, a speed for `slower`.
  double limit(Holder holder, double virtual_damping_n_s_per_m) const;
  /// The same beside the bodies of this load, too: by steps of 1.5 and bisection, from its stiffness on. NaN
  /// with bodies for a holder of which is_computed_with_bodies() is false.
  double limit(Holder holder, const VirtualLoad& load) const;
  bool carries(Holder holder, const VirtualLoad& load) const;
  /// The factor by which stiffness and damping, those of bodies included, together may grow; infinity for no
  /// load, 0 if none is small enough.
  double margin(Holder holder, const VirtualLoad& load) const;
  /// 0 if no period is short enough; with a delay the shortest tried is delay / 50.
  double greatest_period_s(Holder holder, const VirtualLoad& load) const;
  /// Infinity beyond 50 ticks; negative if it is not even stable without delay.
  double largest_delay_s(Holder holder, const VirtualLoad& load) const;

 private:
  bool is_stable(Holder holder, const VirtualLoad& load) const;
};

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
