// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph trade: error and cost of each choice, measured on this machine.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/cli/compared_input.hpp"
#include "analysis/cli/results_output.hpp"
#include "analysis/cli/verbs.hpp"
#include "analysis/trade/measured_trade.hpp"
#include "analysis/trade/rows/pareto.hpp"
#include "analysis/trade/scene/scene_trade_page.hpp"
#include "data-schema/base/unknown_note.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/scene/scene.hpp"
#include "playback/model/identified_band.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/plane_render.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::Dimension;
using schema::ErrorKind;
using schema::Result;

// `trade` of a scene of force patches on a force device.

// For the help of the verb.
constexpr const char* kSceneTradeRule =
    "With --device: the choices are the octaves of noise, the filter of triangular and square grooves, the "
    "finest level of height maps and textures, and the rates of the device. Each has its largest error "
    "against the scene in double precision, the time of a tick, its memory, and the largest stable "
    "stiffness, as 'design' computes it. --max-error and --max-tick choose octaves and filters; the chosen "
    "scene is "
    "played, rendered and explained as any other. An error that cannot be promised is refused.";

struct SceneTradeOptions {
  std::string device, hand, path;
  std::optional<double> rate_hz, max_error_n, max_tick_s;
};

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

// --device, --hand, --rate, --finger-path, --max-error, --max-tick; `options` must outlive the parser.
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

// Errors: usage, if an option of a tray was given with --device, or one of those above without it.
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

struct TradeVerbOptions {
  std::string what, transducer = "wiertlewski2011";
  std::size_t stroke = 0;
  TradeHalves halves = TradeHalves::both;
  bool calibrate = false, unfit_transducer = false, implausible = false;
  schema::Existing existing = schema::Existing::keep;
  std::vector<std::string> outputs;
  SceneTradeOptions scene;
};

constexpr const char* kTradeTableEnding = ".trade.json";

// Each texture file of a scene once.
Result<std::vector<std::string>> textures_named(const std::string& what) {
  const auto files = schema::stored_files(what);
  if (!files || files->front().kind != schema::FileKind::scene) return std::vector{what};
  const auto scene = schema::read_scene(what);
  TACTO_TRY(scene);
  TACTO_TRY(schema::check_only_tray(*scene, files->front().path));
  if (const auto note = schema::unknown_note(files->front().path, *scene); !note.empty()) cli::warn(note);
  std::vector<std::string> names;
  for (const schema::Layer& layer : scene->layers)
    layer.visit([&](const schema::TextureLayer& texture) {
      const std::string name = schema::texture_in_scene(files->front().path, texture.texture);
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    });
  return names;
}

void add_speeds(Report& report, const TradeRow& row) {
  report.add("worst_speed_mps", row.worst_speed_mps());
  if (row.by_speed.size() == 1) return;
  for (const ErrorAtSpeed& each : row.by_speed)
    report.add(fmt::format("error_at_{:g}mmps_percent", 1e3 * each.speed_mps), 100 * each.error);
}

Report choice_row(const TradeHalf& half, const TradeRow& row, const Worth& worth) {
  Report report;
  report.add("half", half.name).add("choice_of", row.knob).add("choice", row.choice);
  report.add("error_percent", 100 * row.error);
  if (!row.by_speed.empty()) add_speeds(report, row);
  report.add("cost_ns", row.cost_ns).add("per", row.per);
  report.add("memory_kib", row.memory_bytes / 1024).add("latency_s", row.latency_s);
  report.add("worth_it", worth_words(worth));
  return report.add("note", row.note);
}

// Single choices only; pairs of them ("window x hop") are in the table.
std::string best_words(const TradeHalf& half) {
  std::string words;
  for (const PlainAnswer& answer : plain_answers(half.rows))
    if (answer.knee_row && answer.knob.find(" x ") == std::string::npos)
      words +=
          fmt::format("{}{}: {}", words.empty() ? "" : "; ", answer.knob, half.rows[*answer.knee_row].choice);
  return words.empty() ? "no best choice" : words;
}

Report trade_report(const Trade& trade) {
  Report report;
  report.add("texture", trade.texture).add("machine", trade.machine);
  if (!trade.simulated.empty()) report.add("simulated", trade.simulated);
  std::vector<Report> rows;
  std::vector<Report> answers;
  for (const TradeHalf& half : trade.halves) {
    report.add(half.name == "offline" ? "best_offline" : "best_real_time", best_words(half));
    const auto worth = worth_of(half.rows);
    for (std::size_t i = 0; i < half.rows.size(); ++i)
      rows.push_back(choice_row(half, half.rows[i], worth[i]));
    for (const PlainAnswer& answer : plain_answers(half.rows))
      answers.push_back(Report()
                            .add("half", half.name)
                            .add("choice_of", answer.knob)
                            .add("knee", answer.knee)
                            .add("never_worth_it", answer.never));
  }
  return report.add("answers", std::move(answers)).add("choices", std::move(rows));
}

std::vector<OutputKind> trade_outputs(const Trade& trade) {
  const auto figure = [&trade] { return pareto_figure(trade.halves.front(), trade); };
  const auto any = [](std::string_view) { return true; };
  return {{".csv", [](std::string_view line) { return line.starts_with(kTradeCsvHead); },
           [&trade]() -> Result<std::string> { return trade_csv(trade); }},
          {".svg", any, [figure] { return spatial::to_svg(figure()); }},
          {".png", any, [figure] { return spatial::to_png(figure()); }}};
}

schema::Results trade_results(const TradeVerbOptions& o, const Trade& trade) {
  schema::Results results;
  results.verb = "trade";
  results.inputs = {o.what, o.transducer};
  results.simulated = trade.simulated;
  results.figures = trade_figures(trade);
  results.pictures = trade_pictures(trade);
  return results;
}

Result<Trade> measured_on(const std::string& name, const TradeVerbOptions& o,
                          const schema::Transducer& transducer, const std::function<void(double)>& progress) {
  const auto input = compared_input(name, o.stroke);
  TACTO_TRY(input);
  auto trade = measure_trade(input->texture, transducer, o.halves, progress);
  if (!trade && trade.error().where == "the texture") trade.error().where = name;
  if (trade) trade->texture = input->name;
  return trade;
}

// Checks the transducer for the real-time half only, in the band of played_case(); the offline half does not
// use it.
Result<schema::Transducer> transducer_of(const TradeVerbOptions& o) {
  auto transducer = schema::read_transducer(
      o.transducer, o.implausible ? schema::Numbers::computable : schema::Numbers::plausible);
  if (!transducer || o.halves == TradeHalves::offline) return transducer;
  TACTO_TRY(schema::check_usable(*transducer, o.unfit_transducer));
  if (const auto beyond = playback::beyond_identified(*transducer, spatial::Band{})) cli::warn(*beyond);
  return transducer;
}

Result<Trade> measured_on_all(const TradeVerbOptions& o) {
  const auto names = textures_named(o.what);
  TACTO_TRY(names);
  const auto transducer = transducer_of(o);
  TACTO_TRY(transducer);
  cli::Progress progress("trade");
  const auto count = static_cast<double>(names->size());
  std::vector<Trade> trades;
  for (const std::string& name : *names) {
    const auto before = static_cast<double>(trades.size());
    auto trade =
        measured_on(name, o, *transducer, [&](double part) { progress.update((before + part) / count); });
    TACTO_TRY(trade);
    trades.push_back(std::move(*trade));
  }
  Trade worst = worst_trade(trades);
  if (trades.size() > 1)
    worst.texture = fmt::format("{} (the worst of its {} textures)", o.what, names->size());
  return worst;
}

Result<Report> measure(const TradeVerbOptions& o) {
  Trade trade;
  const auto kinds = trade_outputs(trade);
  TACTO_TRY(check_outputs(o.outputs, o.existing, kinds));
  auto measured = measured_on_all(o);
  TACTO_TRY(measured);
  trade = std::move(*measured);
  Report report = trade_report(trade);
  const auto written = write_outputs(
      o.outputs, o.existing, trade_results(o, trade), report, [&] { return trade_page(trade); }, kinds);
  TACTO_TRY(written);
  if (!o.outputs.empty()) report.add("written", o.outputs);
  return report;
}

Report table_report(const schema::TradeTable& table) {
  std::vector<Report> rows;
  for (const schema::MeasuredChoice& choice : table.choices)
    rows.push_back(Report()
                       .add("stage", choice.stage)
                       .add("choice", choice.name)
                       .add("cost_ns", choice.cost_ns)
                       .add("per", choice.per)
                       .add("error_percent_at_20_points", 100 * choice.error_at(20)));
  return Report().add("machine", table.machine).add("choices", std::move(rows));
}

Result<std::string> write_table(const TradeVerbOptions& o, const schema::TradeTable& table) {
  if (o.outputs.empty()) return schema::write_machine_trade_table(table);
  const auto text = schema::trade_table_json(table);
  TACTO_TRY(text);
  schema::PendingFiles files;
  TACTO_TRY(files.write(o.outputs.front(), *text));
  TACTO_TRY(files.commit(o.existing));
  return o.outputs.front();
}

Result<void> check_table_output(const TradeVerbOptions& o) {
  if (o.outputs.empty()) {
    const auto own = schema::machine_trade_path();
    return own ? Result<void>() : schema::forward_error(own);
  }
  const std::string& path = o.outputs.front();
  if (o.outputs.size() > 1 || !path.ends_with(kTradeTableEnding))
    return schema::fail(ErrorKind::usage, "is not a name for a table of measured choices", path,
                        "name one file NAME.trade.json, or none for this machine's own");
  const auto there =
      schema::is_file(path) ? schema::stored_files(path) : Result<std::vector<schema::StoredFile>>{};
  if (!schema::is_file(path) || (there && there->front().kind == schema::FileKind::trade))
    return schema::check_output_free(path, o.existing);
  return schema::fail(ErrorKind::usage, "is not a table of measured choices, and would be overwritten", path,
                      "choose another name");
}

Result<Report> calibrate(const TradeVerbOptions& o) {
  if (!o.what.empty())
    return schema::fail(ErrorKind::usage, "a machine is measured without a texture", o.what, "leave it out");
  if (o.halves != TradeHalves::both)
    return schema::fail(ErrorKind::usage, "a machine's table is of both halves", "--half", "leave it out");
  TACTO_TRY(check_table_output(o));
  cli::Progress progress("calibrating");
  const schema::TradeTable table = measure_trade_table([&](double part) { progress.update(part); });
  const auto path = write_table(o, table);
  TACTO_TRY(path);
  return table_report(table).add("written", *path);
}

Result<Report> run_trade(const TradeVerbOptions& o) {
  if (o.calibrate) return calibrate(o);
  if (o.what.empty())
    return schema::fail(ErrorKind::usage, "no texture is named", {},
                        "name one, or --calibrate for this machine's table");
  return measure(o);
}

cli::Action declare_trade(CLI::App& app) {
  auto options = std::make_shared<TradeVerbOptions>();
  app.add_option(
      "WHAT", options->what,
      "Texture, recording (its stroke) or scene (the worst of its textures; with --device its force "
      "patches)");
  app.add_option(
      "-o,--output", options->outputs,
      "Output: a page (.html), results for 'report' (.results.json), a table of all choices "
      "(.csv), or a picture of error against cost (.svg, .png; of both halves, that of the offline one); "
      "with --calibrate NAME.trade.json; with --device no picture, but the chosen scene "
      "(NAME.scene.json); may be repeated");
  app.add_option("--transducer", options->transducer, "A preset or NAME.transducer.json")
      ->capture_default_str();
  cli::declare_unfit_transducer(app, options->unfit_transducer);
  cli::declare_force(app, options->existing);
  app.add_flag("--implausible", options->implausible,
               "Accept a transducer file with impossible numbers, for example a mass of 1e-12 kg");
  app.add_option("--stroke", options->stroke, "Stroke of a recording that has several")
      ->check(cli::from_one());
  cli::add_choice<TradeHalves>(
      app, "--half", options->halves,
      {{"both", TradeHalves::both}, {"offline", TradeHalves::offline}, {"realtime", TradeHalves::real_time}},
      "From recording to spectrogram, from texture to drive, or both");
  app.add_flag("--calibrate", options->calibrate,
               "Measure and store this machine's table of choices, which --quality and --max-error use");
  declare_scene_trade(app, options->scene);
  app.footer(app.get_footer() + "\n" + kSceneTradeRule);
  return [options, &app]() -> Result<Report> {
    TACTO_TRY(check_trade_options(app));
    if (options->scene.device.empty()) return run_trade(*options);
    if (options->what.empty())
      return schema::fail(ErrorKind::usage, "no scene is named", {}, "name a scene with force patches");
    return run_scene_trade(options->what, options->scene, options->outputs, options->existing);
  };
}

}  // namespace

const cli::Verb kTradeVerb{
    "trade", "Measure error and cost of each choice between speed and accuracy, and report the best ones",
    "tactograph trade oak -o trade.html -o trade.csv\n"
    "  tactograph trade oak --half realtime -o realtime.svg\n"
    "  tactograph trade plane --device sandpaper-1990 -o trade.html\n"
    "  tactograph trade plane --device sandpaper-1990 --max-error 5mN -o quick.scene.json\n"
    "  tactograph trade --calibrate",
    declare_trade};

}  // namespace tacto::analysis
