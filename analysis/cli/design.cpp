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
#include "playback/cli/scene_forces.hpp"
#include "playback/prepare/scene/acting_load.hpp"
#include "playback/prepare/scene/judged_piece.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/stability/free_limit.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::Dimension;
using schema::ErrorKind;
using schema::Result;

struct DesignVerbOptions {
  std::string scene, device, hand, table;
  std::optional<double> rate_hz, speed_mps;
  bool lumped = false, assume = false, z_width = false, simulate = false, hold_stable = false;
  std::size_t adversary_paths = 0;
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
    "hand. Layers that act at the same place add up, with the patches at the places and in the order of the "
    "scene ('ctl move' and 'ctl raise' can change both); a number with a slider counts at its worse end. The "
    "stiffness of grooves, noise, height maps, textures and fields is their largest one. A body or a lasso "
    "is a "
    "mass in the same loop; no proof and no lumped formula covers it, and more than four at a place are not "
    "known. "
    "A mover is a damper. A layer with `adaptive` adds a damper to its patch, which is a row of its own.\n"
    "The second table: the greatest period and the largest delay at which the place is stable; the damping "
    "that "
    "device and finger need together for each passive hand; the speed below which each hand is proved; the "
    "amplitude below which Coulomb friction stops a swing.\n"
    "With --simulate each layer has a column more: rests, oscillates or grows, with the RMS in counts of the "
    "encoder and in newtons. With --adversary it has the least stiffness at which a path generates energy.\n"
    "Exit code 9: unstable. The computed limit is passed, or a simulated tap grows; a tap that oscillates "
    "without growing and an adversary's path do not count.";

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
  request.simulate = o.simulate;
  request.adversary_paths = o.adversary_paths;
  request.judged = o.speed_mps ? Holder::slower : o.hand == kAnyHand ? Holder::any : Holder::nothing;
  if (o.hand.empty() || o.hand == kAnyHand) return request;
  auto hand = schema::read_hand(o.hand);
  TACTO_TRY(hand);
  warn_of_newer(o.hand, *hand);
  request.hand = std::move(*hand);
  request.judged = o.lumped ? Holder::lumped : Holder::hand;
  return request;
}

bool is_stable_free(const Design& design) {
  return std::ranges::all_of(design.layers, [](const JudgedLayer& layer) {
    return layer.verdict == Stability::not_reached || layer.loop.carries(Holder::nothing, layer.total);
  });
}

Report report_of(const DesignVerbOptions& o, const Design& design) {
  Report report = design_head(design);
  report.add("scene", schema::scene_path(o.scene));
  if (design.request.hand) report.add("stable_if_released", is_stable_free(design));
  DesignTables tables = design_tables(design);
  report.add("layers", std::move(tables.layers)).add("needs", std::move(tables.needs));
  if (!tables.remedies.empty()) report.add("remedies", std::move(tables.remedies));
  if (design.is_unstable()) report.ends_with(ErrorKind::unstable);
  return report;
}

// A scene that is refused for playback is judged without the dampers, and with the reason. With --hold-stable
// it is refused here, too.
Result<void> add_adaptive(schema::Scene& scene, const std::string& file, const DesignRequest& request,
                          bool hold_stable) {
  const auto added =
      playback::add_adaptive_damping(scene, file, request.device, request.rate_hz, request.hand);
  if (added || hold_stable) return added;
  cli::warn(schema::message(added.error()));
  for (schema::Patch& patch : scene.patches)
    for (schema::ForceLayer& layer : patch.layers) clear_adaptive(layer);
  return {};
}

// Pieces in space: the motion on their walls from tick to tick.
Result<Report> design_pieces(const DesignVerbOptions& o, const schema::Scene& scene, const std::string& file,
                             const DesignRequest& request) {
  if (request.judged != Holder::nothing && request.judged != Holder::hand)
    return schema::fail(ErrorKind::unsuitable, "pieces are judged by eigenvalues alone", file,
                        "leave --lumped, --speed and --hand any out");
  if (o.simulate || o.adversary_paths > 0 || o.hold_stable || o.z_width || !o.outputs.empty())
    return schema::fail(ErrorKind::unsuitable, "pieces are listed only", file,
                        "leave --simulate, --adversary, --hold-stable, --z-width and --output out");
  if (!(request.device.axes.front().mass_kg > 0))
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("the device '{}' does not state its mass and friction", request.device.name), o.device,
        "give them in its file");
  std::vector<Report> rows;
  bool unstable = false;
  for (std::size_t i = 0; i < scene.pieces.size(); ++i) {
    const schema::Piece& piece = scene.pieces[i];
    const playback::JudgedPiece judged =
        playback::judged_piece(scene, i, request.device, request.rate_hz, request.hand);
    const Stability verdict = judged.is_unstable()      ? Stability::unstable
                              : judged.unjudged.empty() ? Stability::stable
                                                        : Stability::not_known;
    unstable = unstable || judged.is_unstable();
    Report row;
    row.add("piece", piece.name).add("verdict", to_string(verdict));
    row.add("stiffness_n_per_m", judged.alone.stiffness_n_per_m)
        .add("damping_n_s_per_m", judged.alone.damping_n_s_per_m);
    if (!judged.with.empty()) row.add("adds_to", judged.with);
    if (judged.total.stiffness_n_per_m != judged.alone.stiffness_n_per_m ||
        judged.total.damping_n_s_per_m != judged.alone.damping_n_s_per_m)
      row.add("total_stiffness_n_per_m", judged.total.stiffness_n_per_m)
          .add("total_damping_n_s_per_m", judged.total.damping_n_s_per_m);
    if (!judged.unjudged.empty()) row.add("not_computed_with", judged.unjudged);
    row.add("limit_n_per_m", playback::stiffness_limit_of(request.device, request.rate_hz, request.hand,
                                                          judged.total.damping_n_s_per_m, true));
    // Until a motion is e times as small, or as large.
    if (judged.growth != 1)
      row.add(judged.growth < 1 ? "decay_time_s" : "growth_time_s",
              1 / (request.rate_hz * std::abs(std::log(judged.growth))));
    if (judged.growth_along > 0) {
      row.add("along_surface", to_string(judged.growth_along > 1 ? Stability::unstable : Stability::stable));
      if (!judged.along_with.empty()) row.add("along_with", judged.along_with);
      row.add("stiffness_along_n_per_m", judged.along.stiffness_n_per_m)
          .add("damping_along_n_s_per_m", judged.along.damping_n_s_per_m)
          .add("limit_along_n_per_m",
               playback::stiffness_limit_of(request.device, request.rate_hz, request.hand,
                                            judged.along.damping_n_s_per_m, true));
    }
    if (const double energy_j = playback::most_energy_j(piece, request.device); energy_j > 0)
      row.add("may_give_j", energy_j);
    rows.push_back(std::move(row));
  }
  Report report;
  report.add("scene", file).add("device", request.device.name);
  report.add("hand", request.hand ? request.hand->name : "nothing holds the device");
  report.add("rate_hz", request.rate_hz).add("pieces", std::move(rows));
  report.add(
      "assumed",
      scene.contact == schema::PieceContact::add
          ? "touched along an axis of the device; planes of the same direction add up, friction also with a "
            "second plane at a right angle, and pieces that may overlap in another way are not computed"
          : "each piece touched along an axis of the device; friction adds up with that of a second plane at "
            "a right angle; of pieces that hold the ghost together at another angle, only the sums of their "
            "dampings and of their frictions are looked at");
  if (unstable) report.ends_with(ErrorKind::unstable);
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
  if (!scene->pieces.empty()) {
    TACTO_TRY(playback::read_reliefs(*scene, file, request->rate_hz));
    return design_pieces(o, *scene, file, *request);
  }
  const double limit = playback::stiffness_limit_of(request->device, request->rate_hz, request->hand);
  TACTO_TRY(playback::set_filters(*scene, limit, file));
  TACTO_TRY(playback::read_reliefs(*scene, file, request->rate_hz));
  TACTO_TRY(add_adaptive(*scene, file, *request, o.hold_stable));
  std::vector<playback::HeldLayer> held;
  if (o.hold_stable) {
    auto scaled = playback::hold_stable(scene->patches, request->device, request->rate_hz, request->hand);
    TACTO_TRY(scaled);
    held = std::move(*scaled);
  }
  auto designed = design_scene(*scene, file, *request);
  TACTO_TRY(designed);
  design = std::move(*designed);
  Report report = report_of(o, design);
  if (scene->patches.size() > 1) report.add("assumed", kAssumedPlaces);
  if (o.hold_stable) playback::add_held(report, held, playback::not_held_layers(scene->patches));
  if (o.outputs.empty()) return report;
  schema::Results results;
  results.verb = "design";
  results.inputs = {o.scene, o.device};
  if (!o.hand.empty()) results.inputs.push_back(o.hand);
  results.device = design.request.device.name;
  results.figures = design_figures(design);
  results.simulated = design.simulated;
  if (o.z_width && design.first) results.pictures.push_back(z_width(design));
  if (std::ranges::any_of(design.layers,
                          [](const JudgedLayer& layer) { return layer.simulated.has_value(); }))
    results.pictures.push_back(worst_tap(design));
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
  app.add_option("SCENE", o.scene, "Scene with force patches, or with pieces in space: stem or file name");
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
  app.add_flag("--simulate", o.simulate,
               "Tap each layer on its stiffest place, with the device's kernel on the emulated device");
  app.add_option(
         "--adversary", o.adversary_paths,
         "Search N random closed paths of a hand for one on which springs and dampers generate energy")
      ->type_name("N")
      ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
  playback::declare_hold_stable(app, o.hold_stable);
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
    "  tactograph design plane --device sandpaper-1990 --speed 50mm/s --simulate --adversary 10000\n"
    "  tactograph design --table C",
    declare_design};

}  // namespace tacto::analysis
