// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/scene/scene_trade.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ranges>

#include "analysis/trade/rows/played_speeds.hpp"
#include "analysis/trade/scene/scene_promise.hpp"
#include "data-schema/base/machine_words.hpp"
#include "data-schema/base/quantity.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/plane_render.hpp"

namespace tacto::analysis {
namespace {

using playback::PreparedScene;
using schema::Dimension;
using schema::ErrorKind;
using schema::for_people;
using schema::Result;

constexpr double kMostTradeTicks = 1 << 22;

// Those of the scene, as they were prepared (filters, curvatures), in its order.
std::vector<schema::Patch> prepared_patches(const schema::Scene& scene, const PreparedScene& prepared) {
  std::vector<schema::Patch> patches;
  for (const schema::Patch& patch : scene.patches)
    patches.push_back(*std::ranges::find(prepared.patches, patch.name, &schema::Patch::name));
  return patches;
}

void put_layer(std::vector<schema::Patch>& patches, const std::string& patch, std::size_t index,
               const schema::ForceLayer& layer) {
  std::ranges::find(patches, patch, &schema::Patch::name)->layers[index] = layer;
}

void leave_out_adaptive(schema::Scene& scene) {
  for (schema::Patch& patch : scene.patches)
    for (schema::ForceLayer& layer : patch.layers) clear_adaptive(layer);
}

// Appends the dampers that adaptive layers added to these patches, which are in the order of the scene, as
// layers of their own. Otherwise a softer layer would have a smaller damper. "20.76 N s/m in 'a'".
std::vector<std::string> fix_added_dampers(schema::Scene& scene, const std::vector<schema::Patch>& patches) {
  std::vector<std::string> fixed;
  for (std::size_t i = 0; i < patches.size(); ++i)
    for (const schema::ForceLayer& layer : patches[i].layers)
      layer.visit(
          [&](const schema::DamperLayer& damper) {
            if (!damper.added) return;
            scene.patches[i].layers.emplace_back(
                schema::DamperLayer{{damper.damping_n_s_per_m.value}, "", false, true});
            fixed.push_back(
                fmt::format("{:.4g} N s/m in '{}'", damper.damping_n_s_per_m.value, patches[i].name));
          },
          [](const auto& /*other*/) {});
  leave_out_adaptive(scene);
  return fixed;
}

// What a layer acts with, and its limit.
struct ActingLimit {
  double stiffness_n_per_m = NAN, limit_n_per_m = NAN;
  std::string verdict = std::string(to_string(Stability::not_reached));
};

ActingLimit limit_of(const Design& design, std::optional<std::size_t> layer) {
  if (!layer) return {};
  const JudgedLayer& judged = design.layers[*layer];
  if (judged.verdict == Stability::not_reached) return {};
  return {judged.total.stiffness_n_per_m, judged.loop.limit(design.request.judged, judged.total),
          std::string(to_string(judged.verdict))};
}

std::size_t flat_index(const std::vector<schema::Patch>& patches, std::size_t patch, std::size_t index) {
  for (std::size_t i = 0; i < patch; ++i) index += patches[i].layers.size();
  return index;
}

double memory_of(const PreparedScene& scene) {
  return static_cast<double>(scene.bytes() + scene.view().live_words() * sizeof(float) +
                             sizeof(core::SceneKernel));
}

// Of strokes_over(), one per patch: that of middle speed.
std::vector<AxisPaths> timed_strokes(const std::vector<schema::Patch>& patches,
                                     const schema::Device& device) {
  const auto all = strokes_over(patches, device);
  std::vector<AxisPaths> strokes;
  for (std::size_t i = kTradeSpeeds_mps.size() / 2; i < all.size(); i += kTradeSpeeds_mps.size())
    strokes.push_back(all[i]);
  return strokes;
}

// One scene on one device at one rate, with the forces of its reference along the paths.
class SceneBench {
 public:
  SceneBench(const schema::Scene& scene, PreparedScene prepared, const core::ForceSetup& setup,
             const schema::Device& device, const std::vector<AxisPaths>& paths)
      : prepared_(std::move(prepared)), patches_(prepared_patches(scene, prepared_)), setup_(setup) {
    for (const AxisPaths& path : paths) {
      counts_.push_back(path_counts(path, device, double{setup.rate_hz}));
      reference_.push_back(exact_forces(prepared_, device, double{setup.rate_hz}, counts_.back()));
      for (const auto& force_n : reference_.back()) forces_.add(force_n);
    }
    for (const AxisPaths& stroke : timed_strokes(patches_, device))
      timed_counts_.push_back(path_counts(stroke, device, double{setup.rate_hz}));
  }

  const PreparedScene& prepared() const { return prepared_; }
  const std::vector<schema::Patch>& patches() const { return patches_; }
  const ForceSizes& forces() const { return forces_; }
  // Of a scene on the same device, perhaps at a lower rate, along the paths' counts at that rate.
  ForceSizes error(const PreparedScene& scene, const core::ForceSetup& setup,
                   const std::vector<CountRows>& counts) const {
    ForceSizes sizes;
    for (std::size_t i = 0; i < counts.size(); ++i)
      add_differences(kernel_forces(scene, setup, counts[i]), reference_[i],
                      double{setup.rate_hz} / double{setup_.rate_hz}, sizes);
    return sizes;
  }
  ForceSizes error(const PreparedScene& scene) const { return error(scene, setup_, counts_); }
  // Along the stroke of middle speed across a patch, whatever path the errors are measured along.
  TimedScene timed(PreparedScene scene, std::size_t patch) const {
    return {std::move(scene), setup_, &timed_counts_[patch]};
  }
  // The largest of all patches.
  double tick_ns(const PreparedScene& scene) const {
    std::vector<TimedScene> scenes;
    for (std::size_t i = 0; i < patches_.size(); ++i) scenes.push_back(timed(scene, i));
    return std::ranges::max(tick_costs_ns(scenes));
  }

 private:
  PreparedScene prepared_;
  std::vector<schema::Patch> patches_;
  core::ForceSetup setup_;
  std::vector<CountRows> counts_, timed_counts_;  // of each path, of each patch
  std::vector<ForceRows> reference_;
  ForceSizes forces_;  // of the reference
};

// A row whose cost is not measured yet.
SceneTradeRow row_with(const std::string& knob, const std::string& choice, const ForceSizes& error,
                       const ForceSizes& reference, const PreparedScene& scene, const ActingLimit& limit) {
  SceneTradeRow row;
  row.row.knob = knob;
  row.row.choice = choice;
  row.row.per = "tick";
  row.row.error = reference.rms_n() > 0 ? error.rms_n() / reference.rms_n() : 0;
  row.row.memory_bytes = memory_of(scene);
  row.error_n = error.largest_n;
  row.error_rms_n = error.rms_n();
  row.stiffness_n_per_m = limit.stiffness_n_per_m;
  row.limit_n_per_m = limit.limit_n_per_m;
  row.verdict = limit.verdict;
  return row;
}

// Of a rate at which the scene cannot be prepared.
SceneTradeRow unknown_rate(const std::string& choice, const schema::Error& why) {
  SceneTradeRow row;
  row.row.knob = "rate";
  row.row.choice = choice;
  row.row.per = "ms";
  row.row.note = why.what;
  row.row.error = kNotMeasured;
  row.row.cost_ns = row.row.memory_bytes = row.error_n = row.error_rms_n = NAN;
  row.stiffness_n_per_m = row.limit_n_per_m = NAN;
  row.verdict = std::string(to_string(Stability::not_known));
  return row;
}

bool has_levels(const schema::ForceLayer& layer) {
  return layer.visit([](const schema::HeightMapLayer& /*map*/) { return true; },
                     [](const schema::TextureForceLayer& /*texture*/) { return true; },
                     [](const auto& /*other*/) { return false; });
}

// Without the first `left_out` levels. Each level is half an octave.
std::shared_ptr<const playback::Relief> coarser_relief(const playback::Relief& relief, std::size_t left_out) {
  playback::Relief coarser = relief;
  coarser.levels.erase(coarser.levels.begin(),
                       coarser.levels.begin() + static_cast<std::ptrdiff_t>(left_out));
  coarser.highest_per_m *= std::exp2(-0.5 * static_cast<double>(left_out));
  return std::make_shared<const playback::Relief>(std::move(coarser));
}

// The curvature of its first level alone: as the map whose samples are those of the level.
double curvature_of(const playback::Relief& relief, double width_m, double height_m) {
  const playback::ReliefLevel& level = relief.levels.front();
  const double pitch_m =
      relief.pitch_m * static_cast<double>(relief.columns) / static_cast<double>(level.columns);
  return playback::Relief{level.columns, level.rows, pitch_m, 0, 0, {level}}.curvature_per_m(width_m,
                                                                                             height_m);
}

class SceneTrader {
 public:
  SceneTrader(const schema::Scene& scene, const std::string& where, const SceneTradeRequest& request,
              SceneBench bench)
      : scene_(scene),
        where_(where),
        request_(request),
        bench_(std::move(bench)),
        promise_(bench_.patches(), request.design.device, bench_.prepared().reliefs,
                 layer_knobs(bench_.patches())) {
    trade_.device = request.design.device.name;
    trade_.hand = request.design.hand ? request.design.hand->name : "nothing holds the device";
    if (scene.patches.size() > 1) trade_.assumed = kAssumedPlaces;
    trade_.timed_along = fmt::format("a stroke across each patch at {:g} mm/s",
                                     1e3 * kTradeSpeeds_mps[kTradeSpeeds_mps.size() / 2]);
    trade_.machine = schema::machine_words();
    trade_.rate_hz = request.design.rate_hz;
    trade_.largest_force_n = bench_.forces().largest_n;
    trade_.rounding_n = promise_.error_n(promise_.unchanged());
    trade_.paths = request.path
                       ? "the given path"
                       : fmt::format("strokes across each patch at {:g} mm/s",
                                     fmt::join(kTradeSpeeds_mps |
                                                   std::views::transform([](double v) { return 1e3 * v; }),
                                               ", "));
  }

  Result<void> add_layers();
  Result<void> add_levels();
  Result<void> add_rates(const std::vector<AxisPaths>& paths);
  void measure_costs();
  Result<void> choose();
  SceneTrade finished();

 private:
  // The scene with these layers in the place of its own.
  PreparedScene changed_by(const ScenePromise::Places& places) const;
  Result<ActingLimit> limit_with(const std::vector<schema::Patch>& patches, std::size_t layer) const;
  Result<void> add_levels_of(std::size_t patch, std::size_t index);
  Result<void> add_rate(double rate_hz, const std::vector<AxisPaths>& paths, Result<PreparedScene> prepared,
                        const SceneBench& best);
  void add_timed(SceneTradeRow row, TimedScene timed);

  const schema::Scene& scene_;
  const std::string& where_;
  const SceneTradeRequest& request_;
  SceneBench bench_;
  ScenePromise promise_;
  SceneTrade trade_;
  std::vector<TimedScene> timed_;
  std::vector<std::size_t> timed_rows_;             // of each of timed_
  std::vector<std::unique_ptr<CountRows>> counts_;  // of other rates
  std::vector<std::string> files_;                  // whose levels are in the rows
};

void SceneTrader::add_timed(SceneTradeRow row, TimedScene timed) {
  timed_rows_.push_back(trade_.rows.size());
  trade_.rows.push_back(std::move(row));
  timed_.push_back(std::move(timed));
}

PreparedScene SceneTrader::changed_by(const ScenePromise::Places& places) const {
  std::vector<schema::Patch> patches = bench_.prepared().patches;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const LayerKnob& knob = promise_.knobs()[i];
    put_layer(patches, bench_.patches()[knob.patch].name, knob.index, knob.choices[places[i]].layer);
  }
  return bench_.prepared().with(std::move(patches));
}

Result<ActingLimit> SceneTrader::limit_with(const std::vector<schema::Patch>& patches,
                                            std::size_t layer) const {
  schema::Scene scene = scene_;
  scene.patches = patches;
  const auto design = design_scene(scene, where_, request_.design);
  TACTO_TRY(design);
  return limit_of(*design, layer);
}

Result<void> SceneTrader::add_layers() {
  for (std::size_t i = 0; i < promise_.knobs().size(); ++i) {
    const LayerKnob& knob = promise_.knobs()[i];
    for (std::size_t place = 0; place < knob.choices.size(); ++place) {
      ScenePromise::Places places = promise_.unchanged();
      places[i] = place;
      PreparedScene changed = changed_by(places);
      std::vector<schema::Patch> patches = bench_.patches();
      patches[knob.patch].layers[knob.index] = knob.choices[place].layer;
      const auto limit = limit_with(patches, flat_index(patches, knob.patch, knob.index));
      TACTO_TRY(limit);
      SceneTradeRow row = row_with(knob.name, knob.choices[place].choice, bench_.error(changed),
                                   bench_.forces(), changed, *limit);
      row.promised_n = promise_.error_n(places);
      if (place == 0) row.row.note = kAsItIs;
      add_timed(std::move(row), bench_.timed(std::move(changed), knob.patch));
    }
  }
  return {};
}

Result<void> SceneTrader::add_levels_of(std::size_t patch, std::size_t index) {
  const schema::ForceLayer& layer = bench_.patches()[patch].layers[index];
  const playback::Reliefs& reliefs = bench_.prepared().reliefs;
  const std::string file = schema::file_of(layer);
  const bool is_map = layer.visit([](const schema::HeightMapLayer& /*map*/) { return true; },
                                  [](const auto& /*texture*/) { return false; });
  const playback::Relief& whole = *(is_map ? reliefs.height_maps : reliefs.textures).at(file);
  for (const std::size_t left_out : {0, 1, 2, 4}) {
    if (left_out >= whole.levels.size()) break;
    const auto relief = coarser_relief(whole, left_out);
    PreparedScene changed = bench_.prepared();
    (is_map ? changed.reliefs.height_maps : changed.reliefs.textures)[file] = relief;
    changed = changed.with(changed.patches);
    std::vector<schema::Patch> patches = bench_.patches();
    for (schema::Patch& each : patches)
      for (schema::ForceLayer& of : each.layers)
        of.visit(
            [&](schema::HeightMapLayer& map) {
              if (left_out > 0 && map.file == file)
                map.curvature_per_m = curvature_of(*relief, each.width_m, each.height_m);
            },
            [&](schema::TextureForceLayer& texture) {
              if (left_out > 0 && texture.file == file)
                texture.steepest_n_per_m =
                    curvature_of(*relief, playback::length_across(each, texture.direction_deg.value), 0);
            },
            [](auto& /*other*/) {});
    const auto limit = limit_with(patches, flat_index(patches, patch, index));
    TACTO_TRY(limit);
    SceneTradeRow row =
        row_with(fmt::format("finest level of {} '{}'", type_of(layer), file),
                 left_out == 0 ? kAsItIs
                               : fmt::format("{:g} octave{} coarser", 0.5 * static_cast<double>(left_out),
                                             left_out > 2 ? "s" : ""),
                 bench_.error(changed), bench_.forces(), changed, *limit);
    if (left_out == 0)
      row.promised_n = trade_.rounding_n;
    else
      row.row.note = "measured only: no member of a scene has it; a map with fewer details does";
    add_timed(std::move(row), bench_.timed(std::move(changed), patch));
  }
  return {};
}

Result<void> SceneTrader::add_levels() {
  const auto& patches = bench_.patches();
  for (std::size_t i = 0; i < patches.size(); ++i)
    for (std::size_t j = 0; j < patches[i].layers.size(); ++j) {
      const schema::ForceLayer& layer = patches[i].layers[j];
      const std::string key = fmt::format("{} {}", type_of(layer), schema::file_of(layer));
      if (!has_levels(layer) || std::ranges::find(files_, key) != files_.end()) continue;
      files_.push_back(key);
      TACTO_TRY(add_levels_of(i, j));
    }
  return {};
}

Result<void> SceneTrader::add_rate(double rate_hz, const std::vector<AxisPaths>& paths,
                                   Result<PreparedScene> prepared, const SceneBench& best) {
  const schema::Device& device = request_.design.device;
  const std::string choice = for_people(rate_hz, Dimension::frequency);
  if (!prepared) {
    trade_.rows.push_back(unknown_rate(choice, prepared.error()));
    return {};
  }
  const auto setup = playback::force_setup_of(device, rate_hz);
  TACTO_TRY(setup);
  std::vector<CountRows> counts;
  for (const AxisPaths& path : paths) counts.push_back(path_counts(path, device, rate_hz));
  DesignRequest request = request_.design;
  request.rate_hz = rate_hz;
  schema::Scene scene = scene_;
  scene.patches = prepared_patches(scene_, *prepared);
  const auto design = design_scene(scene, where_, request);
  const ActingLimit limit = design ? limit_of(*design, design->first) : ActingLimit{NAN, NAN, "not known"};
  SceneTradeRow row =
      row_with("rate", choice, best.error(*prepared, *setup, counts), best.forces(), *prepared, limit);
  row.row.per = "ms";
  row.row.note = design ? "measured only: a force is held for a tick, so at the edge of a patch the error is "
                          "the whole force"
                        : design.error().what;
  const auto strokes = timed_strokes(scene_.patches, device);
  counts_.push_back(std::make_unique<CountRows>(path_counts(strokes[strokes.size() / 2], device, rate_hz)));
  add_timed(std::move(row), {std::move(*prepared), *setup, counts_.back().get()});
  return {};
}

// On a device with one rate there is no choice. The reference is that of the largest rate at which the scene
// can be prepared.
Result<void> SceneTrader::add_rates(const std::vector<AxisPaths>& paths) {
  const schema::Device& device = request_.design.device;
  if (device.rates_hz.size() < 2) return {};
  std::vector<Result<PreparedScene>> prepared;
  double most_hz = trade_.rate_hz;
  for (const double rate_hz : device.rates_hz) {
    prepared.push_back(playback::prepare_scene(scene_, where_, device, rate_hz, request_.design.hand));
    if (prepared.back()) most_hz = std::max(most_hz, rate_hz);
  }
  std::optional<SceneBench> finest;
  if (trade_.rate_hz < most_hz) {
    const auto setup = playback::force_setup_of(device, most_hz);
    TACTO_TRY(setup);
    const auto at = std::ranges::find(device.rates_hz, most_hz) - device.rates_hz.begin();
    finest.emplace(scene_, *prepared[static_cast<std::size_t>(at)], *setup, device, paths);
  }
  const SceneBench& best = finest ? *finest : bench_;
  for (std::size_t i = 0; i < prepared.size(); ++i)
    TACTO_TRY(add_rate(device.rates_hz[i], paths, std::move(prepared[i]), best));
  return {};
}

void SceneTrader::measure_costs() {
  const auto costs_ns = tick_costs_ns(timed_);
  for (std::size_t i = 0; i < costs_ns.size(); ++i) {
    TradeRow& row = trade_.rows[timed_rows_[i]].row;
    row.cost_ns = costs_ns[i] * (row.per == "ms" ? 1e-3 * double{timed_[i].setup.rate_hz} : 1);
  }
}

Result<void> SceneTrader::choose() {
  const auto asked_error = [&] { return for_people(*request_.max_error_n, Dimension::force); };
  if (request_.max_error_n && trade_.rounding_n > *request_.max_error_n)
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format(
            "an error of {} cannot be promised: the tick computes in single precision, whose rounding "
            "may be {} in this scene",
            asked_error(), for_people(trade_.rounding_n, Dimension::force)),
        "--max-error", "accept a larger error");
  std::vector<std::vector<double>> cost_ns;
  auto row = trade_.rows.begin();
  for (const LayerKnob& knob : promise_.knobs()) {
    cost_ns.emplace_back();
    for (std::size_t i = 0; i < knob.choices.size(); ++i) cost_ns.back().push_back((row++)->row.cost_ns);
  }
  double tick_s = NAN;  // of the last scene that was measured
  const auto is_enough = [&](const ScenePromise::Places& places) {
    tick_s = 1e-9 * bench_.tick_ns(changed_by(places));
    return request_.max_tick_s && tick_s <= *request_.max_tick_s;
  };
  const auto places = promise_.chosen(request_.max_error_n.value_or(INFINITY), cost_ns, is_enough);
  const PreparedScene changed = changed_by(places);
  SceneChoice choice{scene_,
                     {},
                     promise_.error_n(places),
                     bench_.error(changed).largest_n,
                     tick_s,
                     static_cast<std::size_t>(memory_of(changed)),
                     {}};
  if (request_.max_tick_s && tick_s > *request_.max_tick_s)
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("a tick of {} cannot be kept on this computer: the smallest scene {}has one of {}",
                    for_people(*request_.max_tick_s, Dimension::time),
                    request_.max_error_n ? "with an error of at most " + asked_error() + " " : "",
                    for_people(choice.tick_s, Dimension::time)),
        "--max-tick", "accept a longer tick or a larger error, or use fewer layers");
  std::vector<schema::Patch> patches = bench_.patches();
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] == 0) continue;
    const LayerKnob& knob = promise_.knobs()[i];
    const LayerChoice& chosen = knob.choices[places[i]];
    patches[knob.patch].layers[knob.index] = choice.scene.patches[knob.patch].layers[knob.index] =
        chosen.layer;
    choice.changed.push_back(fmt::format("{}: {}", knob.name, chosen.choice));
    chosen.layer.visit([&](const schema::GroovesLayer& /*grooves*/) { choice.is_for_loop = true; },
                       [](const auto& /*other*/) {});
  }
  if (!choice.changed.empty())
    if (const auto fixed = fix_added_dampers(choice.scene, bench_.patches()); !fixed.empty()) {
      choice.changed.push_back(fmt::format("added dampers are fixed: {}", fmt::join(fixed, ", ")));
      choice.is_for_loop = true;
    }
  schema::Scene scene = scene_;
  scene.patches = std::move(patches);
  const auto design = design_scene(scene, where_, request_.design);
  TACTO_TRY(design);
  choice.verdict = limit_of(*design, design->first).verdict;
  trade_.chosen = std::move(choice);
  return {};
}

SceneTrade SceneTrader::finished() {
  const auto& patches = bench_.patches();
  for (std::size_t i = 0; i < patches.size(); ++i)
    for (std::size_t j = 0; j < patches[i].layers.size(); ++j) {
      const schema::ForceLayer& layer = patches[i].layers[j];
      const bool has_knob = std::ranges::any_of(
          promise_.knobs(), [&](const LayerKnob& knob) { return knob.patch == i && knob.index == j; });
      if (!has_knob && schema::file_of(layer).empty() && !schema::is_added(layer))
        trade_.without_choice.push_back(fmt::format("{} {} of '{}'", type_of(layer), j, patches[i].name));
    }
  trade_.not_promised = static_cast<std::size_t>(std::ranges::count_if(
      trade_.rows, [](const SceneTradeRow& row) { return std::isnan(row.promised_n); }));
  return std::move(trade_);
}

Result<void> check_path(const SceneTradeRequest& request) {
  if (!request.path) return {};
  const schema::Device& device = request.design.device;
  TACTO_TRY(playback::check_travel(device, *request.path, "path"));
  const double ticks = request.path->front().duration_s() * device.rates_hz.back();
  if (ticks <= kMostTradeTicks) return {};
  return schema::fail(ErrorKind::unsuitable,
                      fmt::format("the path has {:.3g} ticks at {}", ticks,
                                  for_people(device.rates_hz.back(), Dimension::frequency)),
                      "path", fmt::format("at most {:g} are measured", kMostTradeTicks));
}

}  // namespace

Result<SceneTrade> trade_scene(const schema::Scene& scene, const std::string& where,
                               const SceneTradeRequest& request,
                               const std::function<void(double)>& progress) {
  const DesignRequest& design = request.design;
  TACTO_TRY(schema::check_only_plane(scene, where));
  TACTO_TRY(check_path(request));
  const auto setup = playback::force_setup_of(design.device, design.rate_hz);
  TACTO_TRY(setup);
  auto prepared = playback::prepare_scene(scene, where, design.device, design.rate_hz, design.hand);
  TACTO_TRY(prepared);
  const std::vector<AxisPaths> paths =
      request.path ? std::vector<AxisPaths>{*request.path} : strokes_over(scene.patches, design.device);
  SceneTrader trader(scene, where, request,
                     SceneBench(scene, std::move(*prepared), *setup, design.device, paths));
  progress(0.2);
  TACTO_TRY(trader.add_layers());
  progress(0.5);
  TACTO_TRY(trader.add_levels());
  progress(0.7);
  TACTO_TRY(trader.add_rates(paths));
  progress(0.9);
  trader.measure_costs();
  if (request.max_error_n || request.max_tick_s) TACTO_TRY(trader.choose());
  return trader.finished();
}

}  // namespace tacto::analysis
