// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/design/simulated_taps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "firmware-host/core/scene/scene_kernel.hpp"
#include "firmware-host/sim/planar/planar_body.hpp"

namespace tacto::analysis {
namespace {

using firmware_host::encoder_count;

constexpr double kTapS = 16;                  // of a tap, and at most
constexpr std::size_t kMostTapTicks = 16000;  // so many ticks
constexpr int kTapGrid = 41;                  // places along each side of a patch
constexpr double kStiffnessStep_m =
    2e-6;                         // over which a stiffness is measured: above single precision's rounding
constexpr double kTapPart = 0.4;  // of what layers and device give
constexpr double kTapDecays = 0.9, kTapGrows = 1.15;  // RMS from one quarter of the time to the next
constexpr int kSwings = 6;                            // crossings, before a motion is a swing

double limit_n(const schema::Device& device, std::size_t axis) {
  return std::min(device.axes[axis].continuous_force_n, device.continuous_force_n);
}

// RMS about a straight line.
double spread(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double square = 0, slope = 0, squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double time = static_cast<double>(i) - (n - 1) / 2, from = values[i] - mean;
    square += from * from;
    slope += time * from;
    squares += time * time;
  }
  return std::sqrt(std::max(0.0, square - (squares > 0 ? slope * slope / squares : 0)) / n);
}

// How often the values cross their mean.
int crossings(std::span<const double> values) {
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  int count = 0;
  for (std::size_t i = 1; i < values.size(); ++i) count += (values[i] > mean) != (values[i - 1] > mean);
  return count;
}

struct Quarters {
  double rms_counts[4], rms_n;  // of the force in the last quarter
};

Quarters quarters_of(const std::vector<double>& path_m, const std::vector<double>& force_n, std::size_t ticks,
                     double step_m) {
  const std::size_t quarter = std::max<std::size_t>(ticks / 4, 1);
  Quarters quarters;
  for (std::size_t i = 0; i < 4; ++i)
    quarters.rms_counts[i] = spread(std::span(path_m).subspan(i * quarter, quarter)) / step_m;
  quarters.rms_n = spread(std::span(force_n).subspan(3 * quarter, quarter));
  return quarters;
}

// Growth is that of the time until the layers were left for good; leaving them at once, as a wall or a spring
// near an edge, is none. Otherwise a tap ends where it is at last.
void judge(SimulatedTap& tap, const std::vector<double>& force_n, std::size_t inside, double step_m) {
  Quarters of = quarters_of(tap.path_m, force_n, inside, step_m);
  const auto& rms = of.rms_counts;
  const bool swings = crossings(std::span(tap.path_m).first(std::max<std::size_t>(inside, 1))) >= kSwings;
  const bool grows = swings && rms[3] > 1 && rms[3] > kTapGrows * rms[2] && rms[2] > kTapGrows * rms[1];
  if (!grows) of = quarters_of(tap.path_m, force_n, tap.path_m.size(), step_m);
  constexpr double kRounding = 1e-9;  // of the positions, in counts
  tap.rms_counts = rms[3] < kRounding ? 0 : rms[3];
  tap.rms_n = of.rms_n;
  if (grows)
    tap.end = TapEnd::grows;
  else if (rms[3] > 1 && rms[3] > kTapDecays * rms[2])
    tap.end = TapEnd::oscillates;
}

}  // namespace

std::string_view to_string(TapEnd end) {
  return end == TapEnd::rests ? "rests" : end == TapEnd::oscillates ? "oscillates" : "grows";
}

schema::Scene with_sliders_at_ends(schema::Scene scene, bool most_damping) {
  const auto raise = [](schema::LayerNumber& number) { number.value = largest_value(number); };
  for (schema::Patch& patch : scene.patches)
    for (schema::ForceLayer& layer : patch.layers)
      layer.visit(
          [&](schema::SpringLayer& spring) { raise(spring.stiffness_n_per_m); },
          [&](schema::DamperLayer& damper) {
            schema::LayerNumber& number = damper.damping_n_s_per_m;
            if (number.slider) number.value = most_damping ? number.slider->to : number.slider->from;
          },
          [&](schema::GroovesLayer& grooves) { raise(grooves.kappa_n), raise(grooves.depth_m); },
          [&](schema::HeightMapLayer& map) { raise(map.kappa_n); },
          [&](schema::TextureForceLayer& texture) { texture.gain.value = farthest_value(texture.gain); },
          [&](schema::NoiseLayer& noise) { raise(noise.kappa_n), raise(noise.depth_m); },
          [&](schema::FieldLayer& field) { raise(field.force_scale); },
          [&](schema::BodyLayer& body) { raise(body.stiffness_n_per_m); },
          [&](schema::LassoLayer& lasso) { raise(lasso.stiffness_n_per_m); },
          [&](schema::ForceMapLayer& map) { map.gain.value = farthest_value(map.gain); },
          [](auto& /*other*/) {});
  return scene;
}

TapBench::TapBench(const schema::Scene& scene, const playback::PreparedScene& prepared,
                   const schema::Device& device, const core::ForceSetup& setup, const schema::Hand& hand)
    : scene_(scene),
      view_(prepared.view()),
      device_(device),
      setup_(setup),
      hand_(hand),
      stack_(scene.patches) {}

std::vector<double> TapBench::force_at(const std::vector<std::int32_t>& counts) const {
  std::vector<float> live(view_.live_words());
  core::SceneKernel kernel;
  kernel.set(view_, setup_, live.data());
  const core::ForceOutput output = kernel.tick(counts.data(), true);
  return {output.unlimited_n, output.unlimited_n + device_.axes.size()};
}

// The change of the force against a displacement of the axis along the sign.
double TapBench::restoring_n(const TapPlace& at, double distance_m) const {
  std::vector<std::int32_t> counts;
  for (std::size_t i = 0; i < at.place_m.size(); ++i)
    counts.push_back(
        encoder_count(device_.axes[i], at.place_m[i] + (i == at.axis ? at.sign * distance_m : 0)));
  return at.sign * (at.rest_n[at.axis] - force_at(counts)[at.axis]);
}

bool TapBench::acts_at(const TapPlace& at, double from_m) const {
  double place[2] = {};
  for (std::size_t i = 0; i < device_.axes.size(); ++i)
    if (const std::string& name = device_.axes[i].name; name != "z")
      place[name == "x" ? 0 : 1] = at.place_m[i] + (i == at.axis ? from_m : 0);
  const schema::DeviceAxis& axis = device_.axes[at.axis];
  return at.place_m[at.axis] + from_m > axis.travel_from_m &&
         at.place_m[at.axis] + from_m < axis.travel_to_m && stack_.acting_at(place[0], place[1]) == at.acting;
}

std::optional<TapPlace> TapBench::stiffest(const playback::ActingPatches& place, std::size_t axis) const {
  const double step_m = device_.axes[axis].encoder_step_m;
  const double beside_m = std::max(1.0, std::round(kStiffnessStep_m / step_m)) * step_m;
  std::optional<TapPlace> best;
  const auto consider = [&](double x_m, double y_m) {
    TapPlace at{place.patches, axis, {}, {}, 1, 0, 0, 0};
    std::vector<std::int32_t> counts;
    for (const schema::DeviceAxis& each : device_.axes) {
      counts.push_back(encoder_count(each, each.name == "x" ? x_m : each.name == "y" ? y_m : 0));
      at.place_m.push_back(counts.back() * each.encoder_step_m);
    }
    if (!acts_at(at, 0)) return;
    at.rest_n = force_at(counts);
    const double rest_n = std::abs(at.rest_n[axis]);
    if (rest_n > kTapPart * limit_n(device_, axis)) return;
    TapPlace other = at;
    other.sign = -1;
    for (TapPlace* side : {&at, &other})
      side->stiffness_n_per_m =
          acts_at(*side, side->sign * beside_m) ? restoring_n(*side, beside_m) / beside_m : 0;
    if (other.stiffness_n_per_m > at.stiffness_n_per_m) at = other;
    const double ours = at.stiffness_n_per_m, others = best ? best->stiffness_n_per_m : -1;
    if (ours > 1.01 * others || (ours > 0.99 * others && rest_n < std::abs(best->rest_n[axis]))) best = at;
  };
  const schema::Patch* least = &scene_.patches[place.patches.front()];
  for (const std::size_t i : place.patches) {
    const schema::Patch& patch = scene_.patches[i];
    if (patch.width_m * patch.height_m < least->width_m * least->height_m) least = &patch;
  }
  const auto in_patch = [&](const schema::Patch& patch, double u_m, double v_m) {
    const double angle = patch.angle_deg * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
    u_m = std::clamp(u_m, -patch.width_m / 2, patch.width_m / 2);
    v_m = std::clamp(v_m, -patch.height_m / 2, patch.height_m / 2);
    consider(patch.x_m + c * u_m - s * v_m, patch.y_m + s * u_m + c * v_m);
  };
  for (const std::size_t i : place.patches)
    for (const schema::ForceLayer& layer : scene_.patches[i].layers)
      layer.visit(
          [&](const schema::SpringLayer& spring) {
            in_patch(scene_.patches[i], spring.centre_x_m.value, spring.centre_y_m.value);
          },
          [](const auto& /*other*/) {});
  for (int i = 0; i < kTapGrid; ++i)
    for (int j = 0; j < kTapGrid; ++j)
      in_patch(*least, ((i + 0.5) / kTapGrid - 0.5) * least->width_m,
               ((j + 0.5) / kTapGrid - 0.5) * least->height_m);
  if (!best) return best;
  for (double distance_m = step_m; distance_m < least->width_m + least->height_m;
       distance_m += std::max(step_m, 0.1 * distance_m)) {
    const double restoring = restoring_n(*best, distance_m);
    if (!acts_at(*best, best->sign * distance_m) || restoring < best->restoring_n) break;
    best->extent_m = distance_m;
    best->restoring_n = restoring;
  }
  return best;
}

SimulatedTap TapBench::tap(const TapPlace& at, double push_n, double speed_mps, double factor) const {
  std::vector<float> live(view_.live_words());
  core::SceneKernel kernel;
  kernel.set(view_, setup_, live.data());
  for (std::uint32_t i = 0; i < view_.layer_count; ++i) {
    const core::SceneLayer& layer = view_.layers[i];
    if (const auto kind = static_cast<core::SceneLayerKind>(layer.kind);
        kind != core::SceneLayerKind::damper && kind != core::SceneLayerKind::tick_damper &&
        kind != core::SceneLayerKind::mover)
      live[layer.first_number] *= static_cast<float>(factor);  // the force of each kind is proportional to it
  }
  firmware_host::PlanarBody body(device_, hand_, 1 / double{setup_.rate_hz});
  std::vector<double> push(at.rest_n), speed(at.place_m.size()), force(at.place_m.size());
  for (double& each : push) each *= -factor;
  push[at.axis] += at.sign * push_n;
  speed[at.axis] = at.sign * speed_mps;
  body.start_at(at.place_m, speed, push);
  SimulatedTap tap;
  tap.push_n = push_n;
  tap.speed_mps = speed_mps;
  std::vector<double> force_n;
  std::vector<std::int32_t> counts(at.place_m.size());
  const auto ticks = std::min(kMostTapTicks, static_cast<std::size_t>(kTapS * double{setup_.rate_hz}));
  std::size_t inside = 0;
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = body.count(i);
    const core::ForceOutput output = kernel.tick(counts.data(), true);
    std::copy_n(output.force_n, force.size(), force.begin());
    tap.path_m.push_back(body.place_m(at.axis) - at.place_m[at.axis]);
    force_n.push_back(force[at.axis]);
    if (acts_at(at, tap.path_m.back())) inside = tick + 1;
    body.step(force, at.place_m, at.place_m);
  }
  judge(tap, force_n, inside, device_.axes[at.axis].encoder_step_m);
  return tap;
}

std::vector<std::pair<double, double>> TapBench::taps(const TapPlace& at, double factor) const {
  const double most_n = kTapPart * std::min(factor * at.restoring_n, limit_n(device_, at.axis));
  const double mass_kg = device_.axes[at.axis].mass_kg + hand_.mass_kg;
  const double most_mps = at.stiffness_n_per_m > 0
                              ? at.extent_m / 2 * std::sqrt(factor * at.stiffness_n_per_m / mass_kg)
                              : INFINITY;
  std::vector<std::pair<double, double>> all;
  for (const double push : {1.0, 0.3, 0.02})
    for (const double speed : {0.02, 0.1, 0.3}) {
      const std::pair tap{std::min(push, most_n), std::min(speed, most_mps)};
      if (std::ranges::find(all, tap) == all.end()) all.push_back(tap);
    }
  return all;
}

SimulatedTap TapBench::worst(const TapPlace& at) const {
  SimulatedTap worst;
  for (const auto& [push_n, speed_mps] : taps(at, 1)) {
    SimulatedTap tap = this->tap(at, push_n, speed_mps);
    if (worst.path_m.empty() || std::pair(tap.end, tap.rms_counts) > std::pair(worst.end, worst.rms_counts))
      worst = std::move(tap);
  }
  return worst;
}

std::optional<double> TapBench::resting_factor(const TapPlace& at, double most) const {
  const auto rests = [&](double factor) {
    return std::ranges::all_of(taps(at, factor), [&](const auto& each) {
      return tap(at, each.first, each.second, factor).end == TapEnd::rests;
    });
  };
  if (rests(most)) return std::nullopt;
  double good = 0, bad = most;
  while (bad - good > kRestingPart * most) {
    const double middle = (good + bad) / 2;
    (rests(middle) ? good : bad) = middle;
  }
  return good;
}

}  // namespace tacto::analysis
