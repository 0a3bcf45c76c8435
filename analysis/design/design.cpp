// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/design/design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "data-schema/base/quantity.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/stability/acting_patches.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::Patch;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The ends between which a slider moves the numbers of a layer.
struct LoadRange {
  double stiffness = 0, least_damping = 0, most_damping = 0;
  std::string unknown;  // a type whose stiffness is not computed
};

double upper_end(const schema::LayerNumber& number) {
  return number.slider ? number.slider->to : number.value;
}
double lower_end(const schema::LayerNumber& number) {
  return number.slider ? number.slider->from : number.value;
}

LoadRange load_range(const schema::ForceLayer& layer) {
  LoadRange range;
  layer.visit(
      [&](const schema::SpringLayer& spring) { range.stiffness = upper_end(spring.stiffness_n_per_m); },
      [&](const schema::DamperLayer& damper) {
        range.least_damping = lower_end(damper.damping_n_s_per_m);
        range.most_damping = upper_end(damper.damping_n_s_per_m);
      },
      [&](const auto& /*other*/) {
        range.stiffness = playback::local_stiffness_n_per_m(layer);
        if (!(range.stiffness > 0)) range.unknown = type_of(layer);
      });
  return range;
}

LoadRange load_range(const std::vector<Patch>& patches, const std::vector<std::size_t>& acting) {
  LoadRange sum;
  for (const std::size_t i : acting)
    for (const schema::ForceLayer& layer : patches[i].layers) {
      const LoadRange range = load_range(layer);
      sum.stiffness += range.stiffness;
      sum.least_damping += range.least_damping;
      sum.most_damping += range.most_damping;
      if (!range.unknown.empty()) sum.unknown = range.unknown;
    }
  return sum;
}

struct Judgement {
  Stability verdict = Stability::stable;
  std::string because;
};

Judgement judgement_of(const JudgedLoop& loop, const VirtualLoad& load, const DesignRequest& request) {
  const Holder judged = request.judged;
  if (judged != Holder::lumped && loop.carries(Holder::any, load))
    return {Stability::stable, "proved for each passive hand"};
  if (request.speed_mps && judged != Holder::lumped && loop.carries(Holder::slower, load))
    return {Stability::stable, "proved for " + holder_name(Holder::slower, request)};
  const Holder computed = is_proof(judged) ? Holder::nothing : judged;
  const std::string how = fmt::format("computed by eigenvalues, {}", holder_name(computed, request));
  if (!loop.carries(computed, load)) return {Stability::unstable, how};
  if (is_proof(judged)) return {Stability::not_known, "not proved for " + holder_name(judged, request)};
  return {Stability::stable, how};
}

// The layers that act together at a place, on the axis and at the end of the sliders nearest to the limit.
JudgedLayer judged_place(const DesignRequest& request, const playback::ActingPatches& place,
                         const LoadRange& range) {
  JudgedLayer worst;
  worst.margin = kInfinity;
  bool any = false;
  for (const schema::DeviceAxis& axis : request.device.axes) {
    if (axis.name == "z") continue;
    const JudgedLoop loop{axis, request.hand, request.speed_mps, 1 / request.rate_hz, request.device.delay_s};
    for (const double damping : {range.least_damping, range.most_damping}) {
      const VirtualLoad load{range.stiffness, damping};
      const double margin = loop.margin(request.judged, load);
      if (any && !(margin < worst.margin)) continue;
      any = true;
      worst.total = load;
      worst.loop = loop;
      worst.margin = margin;
    }
  }
  worst.x_m = place.x_m;
  worst.y_m = place.y_m;
  const Judgement judgement = judgement_of(worst.loop, worst.total, request);
  worst.verdict = judgement.verdict;
  worst.because = judgement.because;
  if (range.unknown.empty()) return worst;
  if (worst.verdict == Stability::unstable) {
    worst.because += fmt::format("; without the layer of type {}", range.unknown);
  } else {
    worst.verdict = Stability::not_known;
    worst.because = fmt::format("the stiffness of a layer of type {} is not computed", range.unknown);
  }
  return worst;
}

bool is_worse(const JudgedLayer& a, const JudgedLayer& b) {
  const auto rank = [](Stability verdict) {
    return verdict == Stability::unstable ? 0 : verdict == Stability::not_known ? 1 : 2;
  };
  return rank(a.verdict) != rank(b.verdict) ? rank(a.verdict) < rank(b.verdict) : a.margin < b.margin;
}

// Of layers that act at one place.
bool has_larger_share(const JudgedLayer& a, const JudgedLayer& b) {
  if (a.margin != b.margin || a.verdict != b.verdict) return false;
  return a.own.stiffness_n_per_m != b.own.stiffness_n_per_m
             ? a.own.stiffness_n_per_m > b.own.stiffness_n_per_m
             : a.own.damping_n_s_per_m > b.own.damping_n_s_per_m;
}

}  // namespace

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
  Design design{request, {}, std::nullopt, {}};
  std::map<std::size_t, JudgedLayer> of_patch;
  for (const playback::ActingPatches& place : playback::acting_patches(scene.patches, request.device)) {
    const JudgedLayer judged = judged_place(request, place, load_range(scene.patches, place.patches));
    for (const std::size_t i : place.patches)
      if (const auto [at, fresh] = of_patch.try_emplace(i, judged); !fresh && is_worse(judged, at->second))
        at->second = judged;
  }
  for (std::size_t i = 0; i < scene.patches.size(); ++i)
    for (std::size_t j = 0; j < scene.patches[i].layers.size(); ++j) {
      const schema::ForceLayer& layer = scene.patches[i].layers[j];
      JudgedLayer judged;
      if (const auto found = of_patch.find(i); found != of_patch.end()) judged = found->second;
      judged.patch = scene.patches[i].name;
      judged.type = type_of(layer);
      judged.index = j;
      const LoadRange own = load_range(layer);
      judged.own = {own.stiffness, own.most_damping};
      design.layers.push_back(std::move(judged));
    }
  for (std::size_t i = 0; i < design.layers.size(); ++i) {
    const JudgedLayer& layer = design.layers[i];
    if (layer.verdict == Stability::not_reached || layer.own.is_nothing()) continue;
    if (!design.first || is_worse(layer, design.layers[*design.first]) ||
        has_larger_share(layer, design.layers[*design.first]))
      design.first = i;
  }
  if (!design.first) return design;
  const JudgedLayer& first = design.layers[*design.first];
  if (!first.loop.carries(request.judged, first.total)) design.remedies = remedies_for(first, request);
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

}  // namespace tacto::analysis
