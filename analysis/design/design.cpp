// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/design/design.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "analysis/design/boundary.hpp"
#include "data-schema/base/quantity.hpp"
#include "playback/prepare/scene/acting_load.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/stability/acting_patches.hpp"
#include "playback/stability/adversary.hpp"
#include "playback/stability/free_limit.hpp"
#include "playback/stability/hand_limit.hpp"
#include "playback/stability/passive_limit.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;

void judge(JudgedLayer& layer, const DesignRequest& request, const playback::ActingLoad& load) {
  const std::vector<std::string>& unknown = load.unknown;
  const Holder judged = request.judged, computed = is_proof(judged) ? Holder::nothing : judged;
  const auto proved = [&](Holder holder) {
    return judged != Holder::lumped && layer.loop.carries(holder, layer.total);
  };
  layer.verdict = Stability::stable;
  layer.because = fmt::format("computed by eigenvalues, {}", holder_name(computed, request));
  if (proved(Holder::any)) {
    layer.because = "proved for each passive hand";
  } else if (request.speed_mps && proved(Holder::slower)) {
    layer.because = "proved for " + holder_name(Holder::slower, request);
  } else if (!layer.loop.carries(computed, layer.total)) {
    layer.verdict = Stability::unstable;
    if (!unknown.empty()) layer.because += fmt::format("; without {}", fmt::join(unknown, ", "));
    return;
  } else if (is_proof(judged)) {
    layer.verdict = Stability::not_known;
    layer.because = "not proved for " + holder_name(judged, request);
  }
  const double holding =
      load.holding_n_per_m + (computed == Holder::nothing ? 0 : request.hand->stiffness_n_per_m);
  if (load.repelling_n_per_m > 0 && load.repelling_n_per_m >= holding) {
    layer.verdict = Stability::not_known;
    layer.because = fmt::format(
        "a force map drives the hand away with up to {:.4g} N/m, and {:.4g} N/m hold it against that",
        load.repelling_n_per_m, holding);
  }
  if (load.curl_n_per_m > 0) {
    layer.verdict = Stability::not_known;
    layer.because = fmt::format(
        "not passive: a turn of the hand gains up to {:.4g} J per m^2 of its area, the curl of the force map",
        load.curl_n_per_m);
  }
  if (unknown.empty()) return;
  layer.verdict = Stability::not_known;
  layer.because = fmt::format("no method computes the stability with {}", fmt::join(unknown, ", "));
}

// The layers that act together at a place, on the axis and at the end of the sliders nearest to the limit.
JudgedLayer judged_place(const DesignRequest& request, const playback::ActingPatches& place,
                         playback::ActingLoad load) {
  if (request.judged == Holder::lumped) {  // a formula of springs and dampers
    for (const playback::ActingBody& body : load.bodies) load.unknown.push_back(body.name);
    load.bodies.clear();
  }
  JudgedLayer worst;
  worst.acting = place.patches;
  worst.x_m = place.x_m;
  worst.y_m = place.y_m;
  for (const schema::DeviceAxis& axis : request.device.axes) {
    if (axis.name == "z") continue;
    const JudgedLoop loop{axis, request.hand, request.speed_mps, 1 / request.rate_hz, request.device.delay_s};
    for (const VirtualLoad& total : load.at_ends()) {
      const double margin = loop.margin(request.judged, total);
      if (!worst.loop.axis.name.empty() && !(margin < worst.margin)) continue;
      worst.total = total;
      worst.loop = loop;
      worst.margin = margin;
    }
  }
  judge(worst, request, load);
  return worst;
}

// Of one scene: the layers that act together are tapped once.
class TapsAtEnd {
 public:
  TapsAtEnd(const schema::Scene& scene, const playback::PreparedScene& prepared, const DesignRequest& request,
            const core::ForceSetup& setup)
      : request_(request),
        hand_(request.hand.value_or(schema::Hand())),
        bench_(scene, prepared, request.device, setup, hand_) {}

  void simulate(JudgedLayer& layer) const {
    const auto& axes = request_.device.axes;
    const auto axis = std::ranges::find(axes, layer.loop.axis.name, &schema::DeviceAxis::name) - axes.begin();
    const auto at = bench_.stiffest({layer.acting, layer.x_m, layer.y_m}, static_cast<std::size_t>(axis));
    if (!at) return;
    layer.simulated = SimulatedLayers{bench_.worst(*at)};
    if (layer.total.damping_n_s_per_m <= 0 || layer.total.stiffness_n_per_m <= 0) return;
    const double limit = layer.loop.limit(request_.hand ? Holder::hand : Holder::nothing, layer.total);
    if (!(limit > 0) || std::isinf(limit)) return;
    const auto factor = bench_.resting_factor(*at, 1.2 * limit / layer.total.stiffness_n_per_m);
    layer.simulated->limit_n_per_m =
        factor ? *factor * layer.total.stiffness_n_per_m : std::numeric_limits<double>::infinity();
  }

 private:
  const DesignRequest& request_;
  const schema::Hand hand_;
  TapBench bench_;
};

using PlaceOfPatch = std::map<std::size_t, JudgedLayer>;

// `each` changes the places once for all patches that act there together.
void for_each_place(PlaceOfPatch& of_patch, const auto& each) {
  std::map<std::vector<std::size_t>, JudgedLayer> done;
  for (auto& [patch, layer] : of_patch) {
    if (const auto [found, fresh] = done.try_emplace(layer.acting, layer); fresh) each(found->second);
    layer = done.at(layer.acting);
  }
}

schema::Result<void> simulate_places(PlaceOfPatch& of_patch, const schema::Scene& scene,
                                     const std::string& where, const DesignRequest& request) {
  const auto setup = playback::force_setup_of(request.device, request.rate_hz);
  TACTO_TRY(setup);
  const schema::Scene ends[] = {with_sliders_at_ends(scene, false), with_sliders_at_ends(scene, true)};
  const auto least = playback::prepare_scene(ends[0], where, request.device, request.rate_hz, request.hand);
  TACTO_TRY(least);
  const auto most = playback::prepare_scene(ends[1], where, request.device, request.rate_hz, request.hand);
  TACTO_TRY(most);
  const TapsAtEnd taps[] = {{ends[0], *least, request, *setup}, {ends[1], *most, request, *setup}};
  for_each_place(of_patch, [&](JudgedLayer& layer) {
    const double most_damping = playback::load_of(scene.patches, layer.acting).most_damping_n_s_per_m;
    taps[layer.total.damping_n_s_per_m >= most_damping ? 1 : 0].simulate(layer);
    if (!layer.simulated || layer.simulated->tap.end != TapEnd::grows || layer.verdict == Stability::unstable)
      return;
    layer.verdict = Stability::unstable;
    layer.because = fmt::format("a simulated tap grows; {}", layer.because);
  });
  return {};
}

constexpr std::uint64_t kAdversarySeed = 33;

void search_places(PlaceOfPatch& of_patch, const DesignRequest& request) {
  std::map<std::pair<std::string, double>, double> found;  // the paths are those of axis and damper
  for_each_place(of_patch, [&](JudgedLayer& layer) {
    if (!layer.total.bodies.empty()) return;  // the paths are those of a hand with springs and dampers alone
    const std::pair key{layer.loop.axis.name, layer.total.damping_n_s_per_m};
    if (!found.contains(key))
      found[key] = playback::least_generating_stiffness(
          layer.loop.axis, layer.loop.timing(), layer.total.damping_n_s_per_m,
          request.speed_mps.value_or(std::numeric_limits<double>::infinity()), request.adversary_paths,
          kAdversarySeed);
    layer.generating_n_per_m = found[key];
  });
}

bool is_worse(const JudgedLayer& a, const JudgedLayer& b) {
  const auto rank = [](Stability verdict) {
    return verdict == Stability::unstable ? 0 : verdict == Stability::not_known ? 1 : 2;
  };
  return rank(a.verdict) != rank(b.verdict) ? rank(a.verdict) < rank(b.verdict) : a.margin < b.margin;
}

// In the order of Design::layers.
const schema::ForceLayer& layer_at(const schema::Scene& scene, std::size_t index) {
  std::size_t patch = 0;
  while (index >= scene.patches[patch].layers.size()) index -= scene.patches[patch++].layers.size();
  return scene.patches[patch].layers[index];
}

// Of layers that act at one place.
bool has_larger_share(const JudgedLayer& a, const JudgedLayer& b) {
  if (a.margin != b.margin || a.verdict != b.verdict) return false;
  return a.own.stiffness_n_per_m != b.own.stiffness_n_per_m
             ? a.own.stiffness_n_per_m > b.own.stiffness_n_per_m
             : a.own.damping_n_s_per_m > b.own.damping_n_s_per_m;
}

}  // namespace

double JudgedLoop::limit(Holder holder, double damping) const {
  switch (holder) {
    case Holder::nothing:
      if (damping > 0)
        return playback::stiffness_limit({axis.mass_kg, axis.viscous_n_s_per_m, 0}, timing(), damping);
      return playback::free_stiffness_limit(axis.mass_kg, axis.viscous_n_s_per_m, period_s,
                                            timing().delay_ticks);
    case Holder::hand:
      return playback::hand_stiffness_limit(axis, *hand, timing(), damping);
    case Holder::lumped:
      return playback::lumped_stiffness_limit(axis, *hand, timing(), damping);
    case Holder::any:
      return playback::passive_stiffness_limit(axis, timing(), damping);
    case Holder::slower:
      break;
  }
  return playback::passive_stiffness_limit(axis, timing(), damping, *speed_mps);
}

bool JudgedLoop::is_stable(Holder holder, const VirtualLoad& load) const {
  if (!is_computed_with_bodies(holder)) return false;
  const schema::Hand held = holder == Holder::hand ? *hand : schema::Hand();
  return playback::is_stable(
      {axis.mass_kg + held.mass_kg, axis.viscous_n_s_per_m + held.damping_n_s_per_m, held.stiffness_n_per_m},
      timing(), load);
}

double JudgedLoop::limit(Holder holder, const VirtualLoad& load) const {
  if (load.bodies.empty()) return limit(holder, load.damping_n_s_per_m);
  if (!is_computed_with_bodies(holder)) return NAN;
  VirtualLoad tried = load;
  return last_good(std::max(load.stiffness_n_per_m, 1.0), 1e-6, 1e9, [&](double stiffness) {
    tried.stiffness_n_per_m = stiffness;
    return is_stable(holder, tried);
  });
}

bool JudgedLoop::carries(Holder holder, const VirtualLoad& load) const {
  if (!load.bodies.empty()) return is_stable(holder, load);
  return is_nothing(load) || load.stiffness_n_per_m < limit(holder, load.damping_n_s_per_m);
}

double JudgedLoop::margin(Holder holder, const VirtualLoad& load) const {
  if (is_nothing(load)) return std::numeric_limits<double>::infinity();
  if (load.damping_n_s_per_m <= 0 && load.bodies.empty()) return limit(holder, 0) / load.stiffness_n_per_m;
  return last_good(1, 1e-6, 1e9, [&](double factor) {
    VirtualLoad grown = load;
    grown.stiffness_n_per_m *= factor;
    grown.damping_n_s_per_m *= factor;
    for (playback::CoupledBody& body : grown.bodies) {
      body.stiffness_n_per_m *= factor;
      body.damping_n_s_per_m *= factor;
    }
    return carries(holder, grown);
  });
}

double JudgedLoop::greatest_period_s(Holder holder, const VirtualLoad& load) const {
  const double shortest_s = std::max(1e-7, delay_s / kMostDelayTicks * kBoundaryStep);
  return last_good(period_s, shortest_s, 1e4, [&](double tried_s) {
    JudgedLoop other = *this;
    other.period_s = tried_s;
    return other.carries(holder, load);
  });
}

double JudgedLoop::largest_delay_s(Holder holder, const VirtualLoad& load) const {
  JudgedLoop other = *this;
  other.delay_s = 0;
  if (!other.carries(holder, load)) return -1;
  const double most_s = kMostDelayTicks * period_s / kBoundaryStep;
  return last_good(delay_s > 0 ? delay_s : period_s / 10, 1e-6 * period_s, most_s / kBoundaryStep,
                   [&](double tried_s) {
                     other.delay_s = tried_s;
                     return other.carries(holder, load);
                   });
}

std::string_view to_string(Stability verdict) {
  switch (verdict) {
    case Stability::stable:
      return "stable";
    case Stability::unstable:
      return "unstable";
    case Stability::not_known:
      return "not known";
    case Stability::not_reached:
      break;
  }
  return "not reached";
}

bool Design::is_unstable() const {
  return std::ranges::any_of(layers,
                             [](const JudgedLayer& layer) { return layer.verdict == Stability::unstable; });
}

std::vector<Holder> holders_of(const DesignRequest& request) {
  std::vector<Holder> all = {Holder::nothing};
  if (request.hand) all.push_back(Holder::hand);
  if (request.judged == Holder::lumped) all.push_back(Holder::lumped);
  all.push_back(Holder::any);
  if (request.speed_mps) all.push_back(Holder::slower);
  return all;
}

std::string holder_name(Holder holder, const DesignRequest& request) {
  switch (holder) {
    case Holder::nothing:
      return "nothing held";
    case Holder::hand:
      return "hand " + request.hand->name;
    case Holder::lumped:
      return fmt::format("hand {}, lumped", request.hand->name);
    case Holder::any:
      return "any passive hand";
    case Holder::slower:
      break;
  }
  return "any passive hand below " + schema::for_people(*request.speed_mps, schema::Dimension::speed);
}

schema::Result<Design> design_scene(const schema::Scene& scene, const std::string& where,
                                    const DesignRequest& request) {
  if (scene.patches.empty())
    return schema::fail(ErrorKind::unsuitable, "this scene has no force patches", where,
                        "stability is a question about springs and dampers on a force device");
  const double delay_ticks = request.device.delay_s * request.rate_hz;
  if (delay_ticks > kMostDelayTicks)
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("the delay of {:g} s is {:.4g} ticks at {:g} Hz: at most {:g} are computed",
                    request.device.delay_s, delay_ticks, request.rate_hz, kMostDelayTicks),
        request.device.name, "choose a lower --rate");
  Design design{request, {}, std::nullopt, {}, {}};
  PlaceOfPatch of_patch;
  for (const playback::ActingPatches& place : playback::acting_patches(scene.patches, request.device)) {
    const JudgedLayer judged = judged_place(request, place, playback::load_of(scene.patches, place.patches));
    for (const std::size_t i : place.patches)
      if (const auto [at, fresh] = of_patch.try_emplace(i, judged); !fresh && is_worse(judged, at->second))
        at->second = judged;
  }
  if (request.adversary_paths > 0) search_places(of_patch, request);
  if (request.simulate) {
    TACTO_TRY(simulate_places(of_patch, scene, where, request));
    design.simulated = fmt::format("tactograph sim:planar, device {}, hand {}", request.device.name,
                                   request.hand ? request.hand->name : "none");
  }
  for (std::size_t i = 0; i < scene.patches.size(); ++i)
    for (std::size_t j = 0; j < scene.patches[i].layers.size(); ++j) {
      const schema::ForceLayer& layer = scene.patches[i].layers[j];
      JudgedLayer judged;
      if (const auto found = of_patch.find(i); found != of_patch.end()) judged = found->second;
      judged.patch = scene.patches[i].name;
      judged.type = is_added(layer) ? "adaptive damper" : std::string(type_of(layer));
      judged.index = j;
      const playback::ActingLoad own = playback::load_of(layer);
      judged.own = {own.stiffness_n_per_m, own.most_damping_n_s_per_m, {}};
      for (const playback::ActingBody& body : own.bodies)
        judged.own = {body.most.stiffness_n_per_m, body.most.damping_n_s_per_m, {body.most}};
      design.layers.push_back(std::move(judged));
    }
  for (std::size_t i = 0; i < design.layers.size(); ++i) {
    const JudgedLayer& layer = design.layers[i];
    if (layer.verdict == Stability::not_reached || is_nothing(layer.own)) continue;
    if (!design.first || is_worse(layer, design.layers[*design.first]) ||
        has_larger_share(layer, design.layers[*design.first]))
      design.first = i;
  }
  if (!design.first) return design;
  const JudgedLayer& first = design.layers[*design.first];
  const bool computed = first.total.bodies.empty() || is_computed_with_bodies(request.judged);
  if (computed && !first.loop.carries(request.judged, first.total))
    design.remedies = remedies_for(first, layer_at(scene, *design.first), request);
  return design;
}

schema::ResultPicture z_width(const Design& design) {
  const DesignRequest& request = design.request;
  const JudgedLoop& loop = design.layers[*design.first].loop;
  schema::ResultPicture picture{
      "Largest stiffness along " + loop.axis.name, "virtual damping (N s/m)", "stiffness (N/m)", false, {}};
  std::vector<Holder> holders = holders_of(request);
  std::erase(holders, Holder::lumped);  // without a damper that is sampled it only grows
  for (const Holder holder : holders)
    picture.curves.push_back({holder_name(holder, request), {}, {}, is_proof(holder), false});
  // A sampled damper alone is unstable from 2 m / T on at the latest.
  const double most = 2 * loop.axis.mass_kg / loop.period_s + loop.axis.viscous_n_s_per_m;
  constexpr int kPoints = 150;
  double best = 0;
  for (int i = 0; i <= kPoints; ++i) {
    const double damping = most * i / kPoints;
    for (std::size_t j = 0; j < holders.size(); ++j) {
      picture.curves[j].x.push_back(damping);
      picture.curves[j].y.push_back(loop.limit(holders[j], damping));
    }
    const double free = picture.curves.front().y.back();  // of Holder::nothing
    if (best > 0 && free <= 0) break;
    best = std::max(best, free);
  }
  schema::ResultCurve layers{"layers", {}, {}, false, true};
  for (const JudgedLayer& layer : design.layers) {
    if (layer.verdict == Stability::not_reached) continue;
    layers.x.push_back(layer.total.damping_n_s_per_m);
    layers.y.push_back(layer.total.stiffness_n_per_m);
  }
  picture.curves.push_back(std::move(layers));
  return picture;
}

schema::ResultPicture worst_tap(const Design& design) {
  const JudgedLayer* worst = nullptr;
  for (const JudgedLayer& layer : design.layers) {
    const auto rank = [](const JudgedLayer& of) {
      return std::pair(of.simulated->tap.end, of.simulated->tap.rms_counts);
    };
    if (layer.simulated && (worst == nullptr || rank(layer) > rank(*worst))) worst = &layer;
  }
  const SimulatedTap& tap = worst->simulated->tap;
  schema::ResultPicture picture{
      fmt::format("Simulated tap on {} {} of patch '{}' along {}: {} and {}, {}", worst->type, worst->index,
                  worst->patch, worst->loop.axis.name,
                  schema::for_people(tap.push_n, schema::Dimension::force),
                  schema::for_people(tap.speed_mps, schema::Dimension::speed), to_string(tap.end)),
      "time (s)",
      "displacement (mm)",
      false,
      {{"", {}, {}, false, false}}};
  constexpr std::size_t kPieces = 500;  // of the time; of each the least and the largest place
  for (std::size_t i = 0; i < kPieces; ++i) {
    const std::size_t from = tap.path_m.size() * i / kPieces, to = tap.path_m.size() * (i + 1) / kPieces;
    if (from == to) continue;
    const auto [low, high] = std::ranges::minmax(std::span(tap.path_m).subspan(from, to - from));
    for (const double place_m : {low, high}) {
      picture.curves[0].x.push_back(static_cast<double>(from) / design.request.rate_hz);
      picture.curves[0].y.push_back(1e3 * place_m);
    }
  }
  return picture;
}

}  // namespace tacto::analysis
