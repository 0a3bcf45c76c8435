// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/scene_trade.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "analysis/cli/results_output.hpp"
#include "analysis/trade/scene/scene_trade_page.hpp"
#include "data-schema/base/unknown_note.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/report/progress.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/plane_render.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::Dimension;
using schema::ErrorKind;
using schema::Result;

constexpr const char* kSceneEnding = ".scene.json";

void warn_of_unknown(const std::string& name, const auto& document) {
  if (const std::string note = schema::unknown_note(name, document); !note.empty()) cli::warn(note);
}

Result<SceneTradeRequest> trade_request(const SceneTradeOptions& o) {
  for (const auto& [name, value] : {std::pair{"--max-error", o.max_error_n}, {"--max-tick", o.max_tick_s}})
    if (value && !(*value > 0)) return schema::fail(ErrorKind::usage, "has to be above zero", name);
  auto device = schema::read_device(o.device);
  TACTO_TRY(device);
  warn_of_unknown(o.device, *device);
  TACTO_TRY(playback::force_setup_of(*device, o.rate_hz));
  SceneTradeRequest request;
  request.design.rate_hz = o.rate_hz.value_or(device->rates_hz.back());
  request.design.device = std::move(*device);
  request.max_error_n = o.max_error_n;
  request.max_tick_s = o.max_tick_s;
  if (!o.path.empty()) {
    auto path = playback::read_axis_paths(o.path, playback::plane_axes_of(request.design.device));
    TACTO_TRY(path);
    request.path = std::move(*path);
  }
  if (o.hand.empty()) return request;
  auto hand = schema::read_hand(o.hand);
  TACTO_TRY(hand);
  warn_of_unknown(o.hand, *hand);
  request.design.hand = std::move(*hand);
  request.design.judged = Holder::hand;
  return request;
}

// The files of its layers are named from its folder.
Result<void> check_chosen_outputs(const std::vector<std::string>& outputs, const std::string& scene,
                                  const SceneTradeOptions& o) {
  for (const std::string& path : outputs) {
    if (!path.ends_with(kSceneEnding)) continue;
    if (!o.max_error_n && !o.max_tick_s)
      return schema::fail(ErrorKind::usage, "a scene is chosen for an error or a tick", path,
                          "give --max-error or --max-tick");
    if (std::filesystem::absolute(path).lexically_normal().parent_path() !=
        std::filesystem::absolute(scene).lexically_normal().parent_path())
      return schema::fail(ErrorKind::usage, "the files that a scene names are found from its folder", path,
                          fmt::format("write the chosen scene into the folder of {}", scene));
    if (schema::same_file(path, scene))
      return schema::fail(ErrorKind::usage, "would replace the scene that it is made from", path,
                          "choose another name");
    if (!schema::is_file(path)) continue;
    const auto there = schema::stored_files(path);
    if (!there || there->front().kind != schema::FileKind::scene)
      return schema::fail(ErrorKind::usage, "is not a scene, and would be overwritten", path,
                          "choose another name");
  }
  return {};
}

}  // namespace

void declare_scene_trade(CLI::App& app, SceneTradeOptions& o) {
  app.add_option(
      "--device", o.device,
      fmt::format("Of a scene with force patches: the force device that plays it, a preset ({}) or "
                  "NAME.device.json",
                  fmt::join(schema::device_preset_names(), ", ")));
  app.add_option("--hand", o.hand,
                 fmt::format("With --device: the hand for whose stability it is judged, a preset ({}) or "
                             "NAME.hand.json; default: nothing holds the device",
                             fmt::join(schema::hand_preset_names(), ", ")));
  cli::add_quantity(app, "--rate", o.rate_hz, Dimension::frequency,
                    "With --device: tick rate; default: the largest of the device");
  app.add_option("--finger-path", o.path,
                 "With --device: the path of the hand along which errors are measured, a CSV with time and a "
                 "column for each axis; default: strokes across each patch");
  cli::add_quantity(
      app, "--max-error", o.max_error_n, Dimension::force,
      "With --device: choose the cheapest layers whose forces differ by at most this from those "
      "of the scene in double precision, at any place and any speed up to 10 m/s");
  cli::add_quantity(app, "--max-tick", o.max_tick_s, Dimension::time,
                    "With --device: choose the layers that change least and need at most this time per tick "
                    "on this computer");
}

Result<void> check_trade_options(const CLI::App& app) {
  const bool has_device = app.get_option("--device")->count() > 0;
  for (const char* name :
       {"--transducer", "--unfit-transducer", "--implausible", "--stroke", "--half", "--calibrate"})
    if (has_device && app.get_option(name)->count() > 0)
      return schema::fail(ErrorKind::usage, "is an option for a tray, not for a force device", name,
                          "leave it out, or leave out --device");
  for (const char* name : {"--hand", "--rate", "--finger-path", "--max-error", "--max-tick"})
    if (!has_device && app.get_option(name)->count() > 0)
      return schema::fail(ErrorKind::usage, "is an option for a force device", name, "give --device");
  return {};
}

Result<Report> run_scene_trade(const std::string& scene, const SceneTradeOptions& o,
                               const std::vector<std::string>& outputs, schema::Existing existing) {
  SceneTrade trade;
  const std::vector<OutputKind> kinds = {
      {".csv", [](std::string_view beginning) { return beginning.starts_with(kSceneTradeCsvHead); },
       [&]() -> Result<std::string> { return scene_trade_csv(trade); }},
      {kSceneEnding, [](std::string_view /*its kind was checked*/) { return true; },
       [&] { return schema::scene_json(trade.chosen->scene, scene); }}};
  const std::string file = schema::scene_path(scene);
  TACTO_TRY(check_chosen_outputs(outputs, file, o));
  TACTO_TRY(check_outputs(outputs, existing, kinds));
  const auto request = trade_request(o);
  TACTO_TRY(request);
  const auto read = schema::read_scene(file);
  TACTO_TRY(read);
  warn_of_unknown(file, *read);
  cli::Progress progress("trade");
  auto traded = trade_scene(*read, file, *request, [&](double part) { progress.update(part); });
  TACTO_TRY(traded);
  trade = std::move(*traded);
  trade.scene = file;
  if (request->path && !(trade.largest_force_n > 0))
    cli::warn(fmt::format("{}: the path touches no patch", o.path));
  Report report = scene_trade_report(trade);
  if (outputs.empty()) return report;
  schema::Results results;
  results.verb = "trade";
  results.inputs = {scene, o.device};
  if (!o.hand.empty()) results.inputs.push_back(o.hand);
  results.device = trade.device;
  results.figures = scene_trade_figures(trade);
  results.pictures = scene_trade_pictures(trade);
  TACTO_TRY(write_outputs(
      outputs, existing, std::move(results), report, [&] { return scene_trade_page(trade); }, kinds));
  return report.add("written", outputs);
}

}  // namespace tacto::analysis
