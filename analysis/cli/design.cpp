// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph design: is a scene stable on a force device, and what makes it so.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "analysis/cli/results_output.hpp"
#include "analysis/cli/verbs.hpp"
#include "analysis/design/design_page.hpp"
#include "data-schema/base/unknown_note.hpp"
#include "data-schema/command/output_options.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/stability/free_limit.hpp"
#include "playback/stability/passive_limit.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::Dimension;
using schema::ErrorKind;
using schema::Result;

struct DesignVerbOptions {
  std::string scene, device, hand, table;
  std::optional<double> rate_hz, speed_mps;
  bool lumped = false, assume = false, z_width = false;
  std::vector<std::string> outputs;
  schema::Existing existing = schema::Existing::keep;
};

constexpr const char* kAnyHand = "any";

constexpr const char* kDesignRule =
    "What is judged, and what each verdict rests on:\n"
    "  without --hand   the device with nothing held: eigenvalues (computed)\n"
    "  --hand NAME      this hand; only the virtual springs and dampers are sampled: eigenvalues (computed)\n"
    "  --lumped         with --hand: the hand's stiffness as part of the sampled spring (Minsky 1990)\n"
    "  --hand any       each passive hand (proved)\n"
    "  --speed V        each passive hand below this speed (proved)\n"
    "All of these limits are in the table. A layer that is proved for each passive hand is stable with any "
    "hand. "
    "Layers that act at the same place add up; a number with a slider counts at its worse end. Layers other "
    "than "
    "springs and dampers are reported as not known. Exit code 9: unstable.";

void warn_of_newer(const std::string& name, const auto& document) {
  if (const std::string note = schema::unknown_note(name, document); !note.empty()) cli::warn(note);
}

Result<schema::Device> device_of(const DesignVerbOptions& o) {
  std::vector<schema::AssumedNumber> assumed;
  auto device = schema::read_device(o.device, o.assume ? &assumed : nullptr);
  TACTO_TRY(device);
  warn_of_newer(o.device, *device);
  for (const auto& [place, member, value] : assumed)
    cli::warn(fmt::format("{}#/{}: {} is missing; assumed: {:g}", o.device, place, member, value));
  return device;
}

Result<void> check_combination(const DesignVerbOptions& o) {
  const bool known_hand = !o.hand.empty() && o.hand != kAnyHand;
  if (o.lumped && !known_hand)
    return schema::fail(ErrorKind::usage, "needs the numbers of a hand", "--lumped", "give --hand NAME");
  if (o.speed_mps && !(*o.speed_mps > 0))
    return schema::fail(ErrorKind::usage, "the speed must be above zero", "--speed");
  return {};
}

Result<DesignRequest> request_of(const DesignVerbOptions& o) {
  TACTO_TRY(check_combination(o));
  auto device = device_of(o);
  TACTO_TRY(device);
  const auto setup = playback::force_setup_of(*device, o.rate_hz);
  TACTO_TRY(setup);
  DesignRequest request;
  request.rate_hz = o.rate_hz.value_or(device->rates_hz.back());
  request.device = std::move(*device);
  request.speed_mps = o.speed_mps;
  request.judged = o.speed_mps ? Holder::slower : o.hand == kAnyHand ? Holder::any : Holder::nothing;
  if (o.hand.empty() || o.hand == kAnyHand) return request;
  auto hand = schema::read_hand(o.hand);
  TACTO_TRY(hand);
  warn_of_newer(o.hand, *hand);
  request.hand = std::move(*hand);
  request.judged = o.lumped ? Holder::lumped : Holder::hand;
  return request;
}

// What is infinite is left out.
void add_finite(Report& row, const char* key, double value) {
  if (std::isfinite(value)) row.add(key, value);
}

Report row_of_layer(const JudgedLayer& layer, const DesignRequest& request) {
  Report row;
  for (const auto& [key, value] : layer_fields(layer, request))
    if (const auto* number = std::get_if<double>(&value); number == nullptr)
      row.add(key, std::get<std::string>(value));
    else if (key == "layer")
      row.add(key, layer.index);
    else
      add_finite(row, key.c_str(), *number);
  return row;
}

Report needs_of_layer(const JudgedLayer& layer, const DesignRequest& request) {
  const auto& [stiffness, damping] = layer.total;
  const JudgedLoop& loop = layer.loop;
  const auto timing = loop.timing();
  Report row;
  row.add("patch", layer.patch).add("layer", layer.index).add("x_m", layer.x_m).add("y_m", layer.y_m);
  if (const double period_s = loop.greatest_period_s(request.judged, layer.total); period_s > 0)
    add_finite(row, "greatest_period_s", period_s);
  if (const double delay_s = loop.largest_delay_s(request.judged, layer.total); delay_s >= 0)
    add_finite(row, "largest_delay_s", delay_s);
  row.add("any_hand_needs_n_s_per_m", playback::passive_damping_needed(timing, stiffness, damping));
  add_finite(row, "passive_below_mps",
             playback::largest_passive_speed_mps(loop.axis, timing, stiffness, damping));
  add_finite(row, "friction_stops_below_m",
             playback::friction_basin_m(loop.axis, timing, stiffness, damping));
  return row;
}

bool is_stable_free(const Design& design) {
  return std::ranges::all_of(design.layers, [](const JudgedLayer& layer) {
    return layer.verdict == Stability::not_reached || layer.loop.carries(Holder::nothing, layer.total);
  });
}

Report report_of(const DesignVerbOptions& o, const Design& design) {
  const DesignRequest& request = design.request;
  Report report;
  report.add("verdict", design_verdict(design)).add("scene", schema::scene_path(o.scene));
  report.add("device", request.device.name).add("judged", holder_name(request.judged, request));
  report.add("rate_hz", request.rate_hz).add("delay_s", request.device.delay_s);
  if (request.hand) report.add("stable_if_released", is_stable_free(design));
  std::vector<Report> layers, needs, remedies;
  for (const JudgedLayer& layer : design.layers) {
    layers.push_back(row_of_layer(layer, request));
    if (layer.verdict != Stability::not_reached) needs.push_back(needs_of_layer(layer, request));
  }
  report.add("layers", std::move(layers)).add("needs", std::move(needs));
  for (const Remedy& remedy : design.remedies) {
    Report row;
    row.add("change", remedy.change).add("now", remedy.now).add("needed", remedy.needed);
    if (remedy.limit_n_per_m) row.add("limit_n_per_m", *remedy.limit_n_per_m);
    remedies.push_back(std::move(row));
  }
  if (!remedies.empty()) report.add("remedies", std::move(remedies));
  if (design.is_unstable()) report.ends_with(ErrorKind::unstable);
  return report;
}

Result<Report> run_design(const DesignVerbOptions& o) {
  Design design;
  const std::vector<OutputKind> kinds = {
      {".csv", [](std::string_view beginning) { return beginning.starts_with(kDesignCsvHead); },
       [&design]() -> Result<std::string> { return design_csv(design); }}};
  TACTO_TRY(check_outputs(o.outputs, o.existing, kinds));
  auto request = request_of(o);
  TACTO_TRY(request);
  const std::string file = schema::scene_path(o.scene);
  auto scene = schema::read_scene(file);
  TACTO_TRY(scene);
  warn_of_newer(file, *scene);
  const double limit = playback::stiffness_limit_of(request->device, request->rate_hz, request->hand);
  TACTO_TRY(playback::set_filters(*scene, limit, file));
  TACTO_TRY(playback::read_reliefs(*scene, file, request->rate_hz));
  auto designed = design_scene(*scene, file, *request);
  TACTO_TRY(designed);
  design = std::move(*designed);
  Report report = report_of(o, design);
  if (o.outputs.empty()) return report;
  schema::Results results;
  results.verb = "design";
  results.inputs = {o.scene, o.device};
  if (!o.hand.empty()) results.inputs.push_back(o.hand);
  results.device = design.request.device.name;
  results.figures = design_figures(design);
  if (o.z_width && design.first) results.pictures = {z_width(design)};
  const auto pictures = results.pictures;
  TACTO_TRY(write_outputs(
      o.outputs, o.existing, std::move(results), report,
      [&] { return design_page(design, o.scene, pictures); }, kinds));
  return report.add("written", o.outputs);
}

// K T / B of the free device.
Result<Report> table_of_c() {
  std::vector<Report> rows;
  for (const double ratio : {0.01, 0.03, 0.1, 0.3, 1.0, 2.0, 3.0, 3.72, 5.0, 10.0}) {
    Report row;
    row.add("b_t_by_mass", ratio);
    for (const double delay : {0.0, 0.5, 1.0, 2.0, 5.0})
      row.add(fmt::format("delay_{:g}", delay), playback::free_stiffness_limit(1, ratio, 1, delay) / ratio);
    rows.push_back(std::move(row));
  }
  return Report()
      .add("c", "K T / B, below which a sampled spring is stable; the delay is in ticks")
      .add("rows", std::move(rows));
}

cli::Action declare_design(CLI::App& app) {
  auto options = std::make_shared<DesignVerbOptions>();
  DesignVerbOptions& o = *options;
  app.add_option("SCENE", o.scene, "Scene with force patches: stem or file name");
  app.add_option("--device", o.device,
                 fmt::format("The force device that plays it, a preset ({}) or NAME.device.json",
                             fmt::join(schema::device_preset_names(), ", ")));
  app.add_option(
      "--hand", o.hand,
      fmt::format("The hand that holds the device: a preset ({}), NAME.hand.json, or any for each passive "
                  "hand; default: nothing holds it",
                  fmt::join(schema::hand_preset_names(), ", ")));
  cli::add_quantity(app, "--rate", o.rate_hz, Dimension::frequency,
                    "Tick rate; default: the largest of the device");
  cli::add_quantity(app, "--speed", o.speed_mps, Dimension::speed,
                    "Each passive hand that is slower than this");
  app.add_flag("--lumped", o.lumped, "With --hand NAME: judge by the formula of Minsky 1990");
  app.add_flag("--assume", o.assume,
               "Assume what the device's file leaves out of mass, friction and encoder step, and list it");
  app.add_flag("--z-width", o.z_width, "Draw each limit over virtual damping, in the page and the results");
  app.add_option("--table", o.table,
                 "Instead of a scene: C = K T / B of a free device over B T / M and delay")
      ->type_name("C")
      ->check(CLI::IsMember({"C"}));
  app.add_option(
      "-o,--output", o.outputs,
      "Output: a page (.html), a table of the layers (.csv) or results for 'report' (.results.json); may "
      "be repeated");
  cli::declare_force(app, o.existing);
  app.footer(app.get_footer() + "\n" + kDesignRule);
  return [options]() -> Result<Report> {
    if (!options->table.empty() && options->scene.empty() && options->outputs.empty()) return table_of_c();
    if (!options->table.empty())
      return schema::fail(ErrorKind::usage, "the table needs no scene and writes no file", "--table",
                          "give it alone");
    if (options->scene.empty() || options->device.empty())
      return schema::fail(ErrorKind::usage, "a scene and a device are needed", {},
                          "give SCENE and --device, or --table C");
    return run_design(*options);
  };
}

}  // namespace

const cli::Verb kDesignVerb{
    "design",
    "Compute whether a scene is stable on a force device, which layer is not, and what would make it stable",
    "tactograph design plane --device sandpaper-1990 --hand minsky-radial -o design.html --z-width\n"
    "  tactograph design plane --device sandpaper-1990 --hand any --rate 1kHz\n"
    "  tactograph design plane --device sandpaper-1990 --speed 50mm/s\n"
    "  tactograph design --table C",
    declare_design};

}  // namespace tacto::analysis
