// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/stable_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "playback/prepare/scene/scene_device.hpp"

namespace tacto::playback {

using schema::Device;
using schema::ErrorKind;
using schema::fail;
using schema::Hand;
using schema::Result;

namespace {

constexpr int kDampingSteps = 200;  // of the range in which a damping is searched, before bisection

// The loop of a device at one rate, in a hand or free.
struct DeviceLoop {
  const Device& device;
  double rate_hz;
  const std::optional<Hand>& hand;

  Result<void> check_known() const {
    if (device.axes.front().mass_kg > 0) return {};
    return fail(ErrorKind::unsuitable,
                fmt::format("the device '{}' does not state its mass and friction, from which the limit of "
                            "stiffness is computed",
                            device.name),
                {}, "leave the remedy out, and choose the stiffness by 'tactograph design'");
  }
  std::string held() const { return hand ? "hand " + hand->name : "nothing held"; }
  // With this much damping more than the load has, at the worse end of its sliders; and the damping there.
  std::pair<double, double> limit(const ActingLoad& load, double added) const {
    std::pair<double, double> least{INFINITY, 0};
    for (const double own : std::set{load.least_damping_n_s_per_m, load.most_damping_n_s_per_m})
      least = std::min(least, {stiffness_limit_of(device, rate_hz, hand, own + added), own + added});
    return least;
  }
  // The limit of a sampled damper alone, 2 M / T.
  double most_damping() const {
    double mass_kg = INFINITY;
    for (const schema::DeviceAxis& axis : device.axes)
      if (axis.name != "z") mass_kg = std::min(mass_kg, axis.mass_kg);
    return 2 * (mass_kg + (hand ? hand->mass_kg : 0)) * rate_hz;
  }
  // Whether a damper changes the force at a count by no more than friction or stiffness allow; `own` is the
  // damping that the scene has.
  Result<void> check_rounding(double stiffness, double own, double added) const {
    const double damping = own + added;
    for (const schema::DeviceAxis& axis : device.axes) {
      if (axis.name == "z") continue;
      const double step_n = damping * axis.encoder_step_m * rate_hz,
                   allowed_n = std::max(axis.coulomb_n, stiffness * axis.encoder_step_m);
      if (step_n > allowed_n)
        return fail(
            ErrorKind::unsuitable,
            fmt::format(
                "{:.4g} N/m need a damping of {:.4g} N s/m with {}{}, which changes the force "
                "by {:.3g} N at each count of the encoder along {}: at most {:.3g} N are "
                "allowed, the friction of the device or the change of the stiffness itself",
                stiffness, added, held(),
                own > 0 ? fmt::format(" beside the {:.4g} N s/m of the scene's dampers", own) : std::string(),
                step_n, axis.name, allowed_n),
            {}, "choose less stiffness, a finer encoder or less delay");
    }
    return {};
  }
};

double adaptive_stiffness(const schema::Patch& patch) {
  double sum = 0;
  for (const schema::ForceLayer& layer : patch.layers)
    if (is_adaptive(layer)) sum += local_stiffness_n_per_m(layer);
  return sum;
}

// The adaptive layer of a place with the largest stiffness, by JSON pointer.
std::string stiffest_adaptive(const std::vector<schema::Patch>& patches,
                              const std::vector<std::size_t>& acting) {
  double most = -1;
  std::string pointer;
  for (const std::size_t i : acting)
    for (std::size_t j = 0; j < patches[i].layers.size(); ++j) {
      const schema::ForceLayer& layer = patches[i].layers[j];
      if (!is_adaptive(layer) || local_stiffness_n_per_m(layer) <= most) continue;
      most = local_stiffness_n_per_m(layer);
      pointer = fmt::format("#/patches/{}/layers/{}/adaptive", i, j);
    }
  return pointer;
}

// The damper of a place with the largest damping, by JSON pointer; precondition: there is one.
std::string strongest_damper(const std::vector<schema::Patch>& patches,
                             const std::vector<std::size_t>& acting) {
  double most = -1;
  std::string pointer;
  for (const std::size_t i : acting)
    for (std::size_t j = 0; j < patches[i].layers.size(); ++j)
      patches[i].layers[j].visit(
          [&](const schema::DamperLayer& damper) {
            if (largest_value(damper.damping_n_s_per_m) <= most) return;
            most = largest_value(damper.damping_n_s_per_m);
            pointer = fmt::format("#/patches/{}/layers/{}/damping_n_s_per_m{}", i, j,
                                  damper.damping_n_s_per_m.slider ? "/slider/to" : "");
          },
          [](const auto& /*other*/) {});
  return pointer;
}

// A damper whose slider reaches so far that a damping is refused which would be accepted at its lower end; or
// a damper without which the stiffness would be accepted. None: the stiffness is too large.
bool dampers_prevent(const ActingLoad& load, const Device& device, double rate_hz,
                     const std::optional<Hand>& hand) {
  const double least = load.least_damping_n_s_per_m;
  return load.most_damping_n_s_per_m > 0 &&
         (added_damping({load.stiffness_n_per_m, least, least, {}}, device, rate_hz, hand) ||
          added_damping({load.stiffness_n_per_m, 0, 0, {}}, device, rate_hz, hand));
}

bool has_added(const schema::Patch& patch) {
  return std::ranges::any_of(patch.layers, schema::is_added);
}

void scale_number(schema::LayerNumber& number, double factor) {
  number.value *= factor;
  if (number.slider) number.slider->from *= factor, number.slider->to *= factor;
}

// Of the number of a layer to which its stiffness is proportional; its name.
std::string_view scale_stiffness(schema::ForceLayer& layer, double factor) {
  const auto scaled = [&](schema::LayerNumber& number, std::string_view name) {
    scale_number(number, factor);
    return name;
  };
  return layer.visit(
      [&](schema::SpringLayer& spring) { return scaled(spring.stiffness_n_per_m, "stiffness_n_per_m"); },
      [&](schema::GroovesLayer& grooves) { return scaled(grooves.kappa_n, "kappa_n"); },
      [&](schema::NoiseLayer& noise) { return scaled(noise.kappa_n, "kappa_n"); },
      [&](schema::HeightMapLayer& map) { return scaled(map.kappa_n, "kappa_n"); },
      [&](schema::TextureForceLayer& texture) { return scaled(texture.gain, "gain"); },
      [&](schema::FieldLayer& field) { return scaled(field.force_scale, "force_scale"); },
      [&](schema::ForceMapLayer& map) { return scaled(map.gain, "gain"); },
      [](auto& /*of another stiffness or none*/) { return std::string_view(); });
}

}  // namespace

double PlaceLimit::used() const {
  if (limit_n_per_m > 0) return load.stiffness_n_per_m / limit_n_per_m;
  return INFINITY;
}

std::vector<PlaceLimit> place_limits(const std::vector<schema::Patch>& patches, const Device& device,
                                     double rate_hz, const std::optional<Hand>& hand) {
  const DeviceLoop loop{device, rate_hz, hand};
  std::vector<PlaceLimit> limits;
  for (ActingPatches& place : acting_patches(patches, device)) {
    const ActingLoad load = load_of(patches, place.patches);
    if (load.stiffness_n_per_m <= 0 && load.most_damping_n_s_per_m <= 0) continue;
    const auto [limit, damping] = loop.limit(load, 0);
    limits.push_back({std::move(place), load, damping, limit});
  }
  return limits;
}

Result<double> added_damping(const ActingLoad& load, const Device& device, double rate_hz,
                             const std::optional<Hand>& hand) {
  const DeviceLoop loop{device, rate_hz, hand};
  TACTO_TRY(loop.check_known());
  const double stiffness = load.stiffness_n_per_m, own = load.most_damping_n_s_per_m;
  double best = 0, bad = 0;  // the largest limit
  const auto suffices = [&](double added) {
    const double limit = loop.limit(load, added).first;
    best = std::max(best, limit);
    return kStableMargin * stiffness <= limit;
  };
  if (suffices(0)) return 0.0;
  const double most = loop.most_damping() - own;
  double good = NAN;
  for (int i = 1; i < kDampingSteps && std::isnan(good); ++i) {
    const double added = most * i / kDampingSteps;
    (suffices(added) ? good : bad) = added;
  }
  if (!(good > 0))
    return fail(ErrorKind::unsuitable,
                fmt::format("no damper makes {:.4g} N/m stable at {:g} Hz with {}: below {:.4g} N s/m, the "
                            "limit of a sampled damper (2 M / T), the largest limit of stiffness is {:.4g} "
                            "N/m, and {:g} times the stiffness is asked for",
                            stiffness, rate_hz, loop.held(), loop.most_damping(), best, kStableMargin),
                {}, "choose less stiffness, a higher rate or less delay");
  while (good - bad > 1e-12 * good) {
    const double middle = (good + bad) / 2;
    if (middle <= bad || middle >= good) break;
    (suffices(middle) ? good : bad) = middle;
  }
  TACTO_TRY(loop.check_rounding(stiffness, own, good));
  return good;
}

Result<void> add_adaptive_damping(schema::Scene& scene, const std::string& where, const Device& device,
                                  double rate_hz, const std::optional<Hand>& hand) {
  std::vector<schema::Patch>& patches = scene.patches;
  std::vector<double> adaptive, added(patches.size());
  for (const schema::Patch& patch : patches) adaptive.push_back(adaptive_stiffness(patch));
  if (std::ranges::none_of(adaptive, [](double stiffness) { return stiffness > 0; }) ||
      std::ranges::any_of(patches, has_added))
    return {};
  const auto sum_at = [](const ActingPatches& place, const std::vector<double>& of) {
    return std::accumulate(place.patches.begin(), place.patches.end(), 0.0,
                           [&](double sum, std::size_t i) { return sum + of[i]; });
  };
  std::vector<ActingPatches> places = acting_patches(patches, device);
  std::erase_if(places, [&](const ActingPatches& place) { return !(sum_at(place, adaptive) > 0); });
  const auto refused = [&](const ActingPatches& place, const schema::Error& error) {
    return tl::unexpected(schema::Error{error.kind, error.what,
                                        where + stiffest_adaptive(patches, place.patches), error.remedy});
  };
  for (const ActingPatches& place : places) {
    const ActingLoad load = load_of(patches, place.patches);
    const auto needed = added_damping(load, device, rate_hz, hand);
    if (!needed && dampers_prevent(load, device, rate_hz, hand))
      return fail(needed.error().kind, needed.error().what, where + strongest_damper(patches, place.patches),
                  "choose less damping, or leave 'adaptive' out");
    if (!needed) return refused(place, needed.error());
    for (const std::size_t i : place.patches)
      added[i] = std::max(added[i], *needed * adaptive[i] / sum_at(place, adaptive));
  }
  // A place may now have more than it needs, because a patch needs it elsewhere.
  const DeviceLoop loop{device, rate_hz, hand};
  for (const ActingPatches& place : places) {
    const ActingLoad load = load_of(patches, place.patches);
    const double sum = sum_at(place, added), limit = loop.limit(load, sum).first;
    if (!(load.stiffness_n_per_m < limit))
      return refused(place, {ErrorKind::unsuitable,
                             fmt::format("{:.4g} N/m would be unstable with the {:.4g} N s/m that their "
                                         "patches need at other places: the limit is {:.4g} N/m",
                                         load.stiffness_n_per_m, sum, limit),
                             {},
                             "place the patches side by side, or give each place its own patch"});
    if (sum > 0)
      if (const auto fine = loop.check_rounding(load.stiffness_n_per_m, load.most_damping_n_s_per_m, sum);
          !fine)
        return refused(place, fine.error());
  }
  for (std::size_t i = 0; i < patches.size(); ++i)
    if (added[i] > 0) patches[i].layers.emplace_back(schema::DamperLayer{{added[i]}, "", true, true});
  return {};
}

Result<std::vector<HeldLayer>> hold_stable(std::vector<schema::Patch>& patches, const Device& device,
                                           double rate_hz, const std::optional<Hand>& hand) {
  const DeviceLoop loop{device, rate_hz, hand};
  TACTO_TRY(loop.check_known());
  std::vector<double> factors(patches.size(), 1);
  for (const PlaceLimit& at : place_limits(patches, device, rate_hz, hand)) {
    if (at.used() < 1) continue;
    if (!(at.limit_n_per_m > 0))
      return fail(ErrorKind::unsuitable,
                  fmt::format("patch '{}' cannot be held stable: no stiffness is stable with {} and {:.4g} "
                              "N s/m of virtual damping",
                              patches[at.place.patches.front()].name, loop.held(), at.damping_n_s_per_m),
                  {}, "a device needs viscous friction, and a damper below its own limit");
    for (const std::size_t i : at.place.patches)
      factors[i] = std::min(factors[i], 1 / (kStableMargin * at.used()));
  }
  std::vector<HeldLayer> held;
  for (std::size_t i = 0; i < patches.size(); ++i)
    for (std::size_t j = 0; j < patches[i].layers.size(); ++j) {
      schema::ForceLayer& layer = patches[i].layers[j];
      const double from = local_stiffness_n_per_m(layer);
      if (factors[i] >= 1 || !(from > 0)) continue;
      const std::string_view member = scale_stiffness(layer, factors[i]);
      held.push_back(
          {patches[i].name, std::string(type_of(layer)), j, from, local_stiffness_n_per_m(layer), member});
    }
  return held;
}

Result<std::vector<HeldLayer>> hold_stable(PreparedScene& scene, const Device& device, double rate_hz,
                                           const std::optional<Hand>& hand) {
  if (!scene.pieces.empty())
    return fail(ErrorKind::unsuitable, "--hold-stable does not scale pieces yet", {},
                "choose their stiffness by 'tactograph design'");
  std::vector<schema::Patch> patches(scene.patches.rbegin(), scene.patches.rend());
  auto held = hold_stable(patches, device, rate_hz, hand);
  if (!held || held->empty()) return held;
  std::ranges::reverse(patches);
  scene = scene.with(std::move(patches));
  return held;
}

std::string held_words(const HeldLayer& layer) {
  return fmt::format("{} {} of patch '{}': held stable, {:.4g} N/m to {:.4g} N/m", layer.type, layer.index,
                     layer.patch, layer.from_n_per_m, layer.to_n_per_m);
}

}  // namespace tacto::playback
