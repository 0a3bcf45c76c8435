// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/scene_device.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/prepare/relief/groove_series.hpp"
#include "playback/prepare/relief/noise_octaves.hpp"
#include "playback/prepare/scene/acting_load.hpp"
#include "playback/prepare/scene/piece_block.hpp"
#include "playback/prepare/scene/stable_scene.hpp"

namespace tacto::playback {

using schema::Device;
using schema::DeviceAxis;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr double kNoiseCurvature = 12.5;  // of one octave, per squared cell: the largest of 8e6 places
constexpr int kPatchGrid = 101;           // places along each side of a patch

// A place, or a force, in the plane.
struct Vector {
  double x = 0, y = 0;
};

const DeviceAxis* axis_named(const Device& device, std::string_view name) {
  const auto found = std::ranges::find(device.axes, name, &DeviceAxis::name);
  return found == device.axes.end() ? nullptr : &*found;
}

core::AxisAlong along_of(const DeviceAxis& axis) {
  return axis.name == "x" ? core::AxisAlong::x : axis.name == "y" ? core::AxisAlong::y : core::AxisAlong::z;
}

core::ForceAxis axis_setup(const DeviceAxis& axis) {
  return {along_of(axis), static_cast<float>(axis.encoder_step_m), static_cast<float>(axis.peak_force_n),
          static_cast<float>(axis.continuous_force_n)};
}

// The two axes of the plane; an axis that the device does not have stays at 0.
struct PlaneTravel {
  const DeviceAxis* axes[2];

  explicit PlaneTravel(const Device& device) : axes{axis_named(device, "x"), axis_named(device, "y")} {}
  bool is_line() const { return axes[0] == nullptr || axes[1] == nullptr; }
  bool reaches(Vector place) const {
    const double along[2] = {place.x, place.y};
    for (int i = 0; i < 2; ++i)
      if (axes[i] != nullptr && (along[i] < axes[i]->travel_from_m || along[i] > axes[i]->travel_to_m))
        return false;
    return true;
  }
};

// A patch with its axes.
class TurnedPatch {
 public:
  explicit TurnedPatch(const schema::Patch& patch)
      : patch_(patch),
        cosine_(std::cos(patch.angle_deg * std::numbers::pi / 180)),
        sine_(std::sin(patch.angle_deg * std::numbers::pi / 180)) {}
  Vector in_plane(double u_m, double v_m) const {
    return {patch_.x_m + cosine_ * u_m - sine_ * v_m, patch_.y_m + sine_ * u_m + cosine_ * v_m};
  }
  // From its centre, in its axes.
  Vector in_patch(Vector place) const {
    const double x = place.x - patch_.x_m, y = place.y - patch_.y_m;
    return {cosine_ * x + sine_ * y, cosine_ * y - sine_ * x};
  }
  bool holds(Vector place) const {
    const Vector local = in_patch(place);
    return std::abs(local.x) <= patch_.width_m / 2 && std::abs(local.y) <= patch_.height_m / 2;
  }

 private:
  const schema::Patch& patch_;
  double cosine_, sine_;
};

// Places of the patch: a grid of it, or of the line on which a device of one axis moves.
std::vector<Vector> places_of(const schema::Patch& patch, const TurnedPatch& turned,
                              const PlaneTravel& travel) {
  std::vector<Vector> places;
  const auto part = [](int i) { return (i + 0.5) / kPatchGrid; };
  if (!travel.is_line()) {
    for (int i = 0; i < kPatchGrid; ++i)
      for (int j = 0; j < kPatchGrid; ++j)
        places.push_back(turned.in_plane(patch.width_m * (part(i) - 0.5), patch.height_m * (part(j) - 0.5)));
    return places;
  }
  const bool along_x = travel.axes[0] != nullptr;
  const DeviceAxis& axis = along_x ? *travel.axes[0] : *travel.axes[1];
  for (int i = 0; i < kPatchGrid * kPatchGrid; ++i) {
    const double at_m =
        axis.travel_from_m + (axis.travel_to_m - axis.travel_from_m) * (i + 0.5) / (kPatchGrid * kPatchGrid);
    const Vector place = along_x ? Vector{at_m, 0} : Vector{0, at_m};
    if (turned.holds(place)) places.push_back(place);
  }
  return places;
}

// Whether the force of a hand that rests at this place is beyond a limit.
bool exceeds(const core::SceneView& patch, const core::ForceSetup& setup, float* live, Vector place) {
  core::SceneKernel kernel;
  kernel.set(patch, setup, live);
  std::int32_t counts[core::kMostAxes] = {};
  for (std::uint32_t i = 0; i < setup.axis_count; ++i) {
    const core::ForceAxis& axis = setup.axes[i];
    if (axis.along == core::AxisAlong::z) continue;
    const double at_m = axis.along == core::AxisAlong::x ? place.x : place.y;
    counts[i] = static_cast<std::int32_t>(std::lround(at_m / double{axis.metres_per_count}));
  }
  const core::ForceOutput output = kernel.tick(counts, true);
  double square = 0;
  for (std::uint32_t i = 0; i < setup.axis_count; ++i) {
    const double force_n = double{output.unlimited_n[i]};
    if (std::abs(force_n) > double{setup.axes[i].peak_n}) return true;
    square += force_n * force_n;
  }
  return square > double{setup.peak_n} * double{setup.peak_n};
}

double percent_of(std::size_t part, std::size_t of) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(of);
}

struct ReachedPlaces {
  std::vector<Vector> places;
  std::size_t of = 0;  // of the patch
};

ReachedPlaces reached_places(const schema::Patch& patch, const Device& device) {
  const PlaneTravel travel(device);
  ReachedPlaces reached{places_of(patch, TurnedPatch(patch), travel), 0};
  reached.of = reached.places.size();
  std::erase_if(reached.places, [&](Vector place) { return !travel.reaches(place); });
  return reached;
}

std::string travel_words(const schema::Patch& patch, const ReachedPlaces& reached) {
  const std::size_t in = reached.places.size();
  if (in == 0) return fmt::format("patch '{}' is outside the travel of the device", patch.name);
  if (in == reached.of) return {};
  return fmt::format("patch '{}': {:.3g} % of its area is outside the travel of the device", patch.name,
                     percent_of(reached.of - in, reached.of));
}

void note_patch(const PreparedScene& alone, const Device& device, const core::ForceSetup& setup,
                std::vector<std::string>& notes) {
  const schema::Patch& patch = alone.patches.front();
  const ReachedPlaces reached = reached_places(patch, device);
  const std::vector<Vector>& places = reached.places;
  if (std::string words = travel_words(patch, reached); !words.empty()) notes.push_back(std::move(words));
  if (places.empty()) return;
  const core::SceneView view = alone.view();
  std::vector<float> live(view.live_words());
  const auto high =
      std::ranges::count_if(places, [&](Vector place) { return exceeds(view, setup, live.data(), place); });
  if (high > 0)
    notes.push_back(
        fmt::format("patch '{}': its force on a hand at rest exceeds the peak force of the device at {:.3g} "
                    "% of the places "
                    "that the hand reaches; there the force is limited",
                    patch.name, percent_of(static_cast<std::size_t>(high), places.size())));
}

void note_maps(const PreparedScene& scene, const schema::Patch& patch, std::vector<std::string>& notes) {
  for (const schema::ForceLayer& layer : patch.layers)
    layer.visit(
        [&](const schema::HeightMapLayer& map) {
          const Relief& relief = scene.reliefs.of(map);
          const double width_m = static_cast<double>(relief.columns) * relief.pitch_m,
                       height_m = static_cast<double>(relief.rows) * relief.pitch_m;
          const bool wide = patch.width_m > (1 + 1e-9) * width_m,
                     high = relief.rows > 1 && patch.height_m > (1 + 1e-9) * height_m;
          if (wide || high)
            notes.push_back(
                fmt::format("patch '{}' is larger than its height map '{}' of {:.4g} m x {:.4g} m: beyond "
                            "the edges of the "
                            "map its outermost heights continue",
                            patch.name, map.file, width_m, height_m));
        },
        [&](const schema::TextureForceLayer& texture) {
          const Relief& relief = scene.reliefs.of(texture);
          const double length_m = static_cast<double>(relief.columns) * relief.pitch_m;
          if (length_across(patch, texture.direction_deg.value) > (1 + 1e-9) * length_m)
            notes.push_back(
                fmt::format("patch '{}' is larger than its texture '{}' of {:.4g} m: beyond the ends of the "
                            "texture its force is 0",
                            patch.name, texture.file, length_m));
        },
        [&](const schema::ForceMapLayer& map) {
          const Relief& relief = scene.reliefs.of(map).x;
          const double from_centre_m[2] = {std::abs(relief.centre_m[0]), std::abs(relief.centre_m[1])};
          const double half_m[2] = {0.5 * static_cast<double>(relief.columns) * relief.pitch_m,
                                    0.5 * static_cast<double>(relief.rows) * relief.pitch_m};
          const bool wide =
              relief.columns > 1 && patch.width_m / 2 + from_centre_m[0] > (1 + 1e-9) * half_m[0];
          const bool high = relief.rows > 1 && patch.height_m / 2 + from_centre_m[1] > (1 + 1e-9) * half_m[1];
          if (wide || high)
            notes.push_back(
                fmt::format("patch '{}' reaches beyond the grid of its force map '{}': there the outermost "
                            "forces of the map continue",
                            patch.name, map.file));
        },
        [](const auto& /*other*/) {});
}

// "spring 0 of patch 'floor'": the layer with the largest share of what acts at a place.
std::string largest_share(const std::vector<schema::Patch>& patches, const std::vector<std::size_t>& acting) {
  std::pair<double, double> most{-1, -1};
  std::string name;
  for (const std::size_t i : acting)
    for (std::size_t j = 0; j < patches[i].layers.size(); ++j) {
      const ActingLoad load = load_of(patches[i].layers[j]);
      const std::pair share{load.stiffness_n_per_m, load.most_damping_n_s_per_m};
      if (share <= most) continue;
      most = share;
      name = fmt::format("{} {} of patch '{}'", type_of(patches[i].layers[j]), j, patches[i].name);
    }
  return name;
}

// One sentence about the first place with bodies that is unstable.
void note_unstable_bodies(const std::vector<schema::Patch>& patches, const Device& device, double rate_hz,
                          const std::optional<schema::Hand>& hand, std::vector<std::string>& notes) {
  const schema::Hand held = hand.value_or(schema::Hand());
  const TickTiming timing{1 / rate_hz, device.delay_s * rate_hz};
  const auto stable = [&](const SampledLoad& load) {
    return std::ranges::all_of(device.axes, [&](const DeviceAxis& axis) {
      return axis.name == "z" ||
             is_stable({axis.mass_kg + held.mass_kg, axis.viscous_n_s_per_m + held.damping_n_s_per_m,
                        held.stiffness_n_per_m},
                       timing, load);
    });
  };
  for (const ActingPatches& place : acting_patches(patches, device)) {
    const ActingLoad load = load_of(patches, place.patches);
    if (load.bodies.empty() || std::ranges::all_of(load.at_ends(), stable)) continue;
    notes.push_back(fmt::format(
        "{} is unstable on this device with {} (computed): 'tactograph design' lists what would prevent it",
        load.bodies.front().name, hand ? "hand " + hand->name : "nothing held"));
    return;
  }
}

// One sentence about the place that is the farthest beyond its limit. Not for a device of unknown mass.
void note_instability(const PreparedScene& scene, const Device& device, double rate_hz,
                      const std::optional<schema::Hand>& hand, std::vector<std::string>& notes) {
  if (!(device.axes.front().mass_kg > 0)) return;
  const std::vector<schema::Patch> patches(scene.patches.rbegin(), scene.patches.rend());  // as in a file
  note_unstable_bodies(patches, device, rate_hz, hand, notes);
  const std::vector<PlaceLimit> limits = place_limits(patches, device, rate_hz, hand);
  const auto worst = std::ranges::max_element(limits, {}, &PlaceLimit::used);
  if (worst == limits.end() || worst->used() < 1) return;
  // Beside too much damping no stiffness is small enough.
  const char* const remedy =
      worst->damping_n_s_per_m > 0 && worst->limit_n_per_m <= 0
          ? "choose less damping"
          : "'play' and 'render' with --hold-stable scale its stiffness down, and 'tactograph design' lists "
            "what else would prevent it";
  notes.push_back(fmt::format(
      "{} is unstable on this device with {}: {:.4g} N/m and {:.4g} N s/m act there together, the "
      "limit is {:.4g} N/m (computed); {}",
      largest_share(patches, worst->place.patches), hand ? "hand " + hand->name : "nothing held",
      worst->load.stiffness_n_per_m, worst->damping_n_s_per_m, worst->limit_n_per_m, remedy));
}

}  // namespace

Result<core::ForceSetup> force_setup_of(const Device& device, std::optional<double> rate_hz) {
  if (axis_named(device, "x") == nullptr && axis_named(device, "y") == nullptr)
    return fail(ErrorKind::unsuitable,
                fmt::format("the device '{}' has neither an axis x nor an axis y", device.name), {},
                "force patches are in the plane of x and y");
  const double rate = rate_hz.value_or(device.rates_hz.back());
  if (std::ranges::find(device.rates_hz, rate) == device.rates_hz.end())
    return fail(ErrorKind::unsuitable,
                fmt::format("the device '{}' has no rate of {:g} Hz", device.name, rate), "--rate",
                fmt::format("its rates are {} Hz", fmt::join(device.rates_hz, ", ")));
  core::ForceSetup setup;
  for (const DeviceAxis& axis : device.axes) setup.axes[setup.axis_count++] = axis_setup(axis);
  setup.peak_n = static_cast<float>(device.peak_force_n);
  setup.continuous_n = static_cast<float>(device.continuous_force_n);
  setup.slew_n_per_s = static_cast<float>(device.slew_n_per_s);
  setup.rate_hz = static_cast<float>(rate);
  return setup;
}

double local_stiffness_n_per_m(const schema::ForceLayer& layer) {
  return layer.visit(
      [](const schema::SpringLayer& spring) { return largest_value(spring.stiffness_n_per_m); },
      [](const schema::GroovesLayer& grooves) {
        const double period_m = grooves.period_m.value;
        const auto amplitudes = groove_amplitudes(grooves.profile, grooves.filter_m->value / period_m);
        return largest_value(grooves.kappa_n) * largest_value(grooves.depth_m) *
               largest_curvature(amplitudes) / (period_m * period_m);
      },
      [](const schema::HeightMapLayer& map) { return largest_value(map.kappa_n) * map.curvature_per_m; },
      [](const schema::TextureForceLayer& texture) {
        return std::abs(farthest_value(texture.gain)) * texture.steepest_n_per_m;
      },
      [](const schema::FieldLayer& field) {
        return largest_value(field.force_scale) * field.stiffest_n_per_m;
      },
      [](const schema::ForceMapLayer& map) {
        return std::max(largest_value(map.gain) * map.attracting_n_per_m,
                        -least_value(map.gain) * map.repelling_n_per_m);
      },
      [](const schema::NoiseLayer& noise) {
        double curvature = 0, cells_per_m = 1 / noise.period_m.value;
        for (const double amplitude : octave_amplitudes(noise)) {
          curvature += kNoiseCurvature * amplitude * cells_per_m * cells_per_m;
          cells_per_m *= 2;
        }
        return largest_value(noise.kappa_n) * largest_value(noise.depth_m) * curvature;
      },
      [](const auto& /*other*/) { return 0.0; });
}

std::string note_of_travel(const schema::Patch& patch, const Device& device) {
  return travel_words(patch, reached_places(patch, device));
}

std::vector<std::string> limits_of_device(const PreparedScene& scene, const Device& device,
                                          const core::ForceSetup& setup,
                                          const std::optional<schema::Hand>& hand) {
  if (!scene.pieces.empty()) return limits_of_pieces(scene, device, double{setup.rate_hz}, hand);
  std::vector<std::string> notes;
  for (const char* name : {"x", "y"})
    if (axis_named(device, name) == nullptr)
      notes.push_back(
          fmt::format("the device has no axis {0}: the hand stays at {0} = 0, and forces along {0} "
                      "are left out",
                      name));
  for (const schema::Patch& patch : scene.patches) {
    note_patch(scene.with({patch}), device, setup, notes);
    note_maps(scene, patch, notes);
  }
  note_instability(scene, device, double{setup.rate_hz}, hand, notes);
  return notes;
}

}  // namespace tacto::playback
