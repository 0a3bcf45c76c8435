// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/cli/scene_forces.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "data-schema/base/unknown_note.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/files/files.hpp"
#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/core/scene/grooves.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/cli/board_report.hpp"
#include "playback/player/placed_textures.hpp"
#include "playback/prepare/relief/groove_series.hpp"
#include "playback/prepare/scene/acting_load.hpp"
#include "playback/prepare/scene/body_motion.hpp"
#include "playback/prepare/scene/contact_transient.hpp"
#include "playback/prepare/scene/judged_piece.hpp"
#include "playback/prepare/scene/piece_block.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/prepare/scene/slide_table.hpp"
#include "playback/render/plane_render.hpp"

namespace tacto::playback {

using cli::Report;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr int kCostTicks = 500, kCostRuns = 5;

struct SceneOnDevice {
  std::string file;
  schema::Device device;
  PreparedScene scene;
  core::ForceSetup setup;
  std::vector<HeldLayer> held;  // with --hold-stable
};

void warn_of_newer(const std::string& name, const auto& document) {
  if (const std::string note = schema::unknown_note(name, document); !note.empty()) cli::warn(note);
}

Result<SceneOnDevice> scene_on_device(const std::string& scene_name, const std::string& device_name,
                                      std::optional<double> rate_hz, const std::optional<schema::Hand>& hand,
                                      bool held_stable = false) {
  if (!names_a_scene(scene_name))
    return fail(ErrorKind::unsuitable, "is a texture; a force device plays the force patches of a scene",
                scene_name, "name a scene, or give --transducer instead of --device");
  const std::string file = schema::scene_path(scene_name);
  const auto scene = schema::read_scene(file);
  TACTO_TRY(scene);
  auto device = schema::read_device(device_name);
  TACTO_TRY(device);
  const auto setup = force_setup_of(*device, rate_hz);
  TACTO_TRY(setup);
  auto prepared = prepare_scene(*scene, file, *device, double{setup->rate_hz}, hand);
  TACTO_TRY(prepared);
  std::vector<HeldLayer> held;
  if (held_stable) {
    auto scaled = hold_stable(*prepared, *device, double{setup->rate_hz}, hand);
    TACTO_TRY(scaled);
    held = std::move(*scaled);
  }
  warn_of_newer(file, *scene);
  warn_of_newer(device_name, *device);
  if (!scene->layers.empty())
    cli::warn(fmt::format("{}: its {} layers of a tray are left out", file, scene->layers.size()));
  for (const std::string& note : limits_of_device(*prepared, *device, *setup, hand)) cli::warn(note);
  return SceneOnDevice{file, std::move(*device), std::move(*prepared), *setup, std::move(held)};
}

Result<std::optional<schema::Hand>> hand_of(const std::string& name) {
  if (name.empty()) return std::optional<schema::Hand>();
  auto hand = schema::read_hand(name);
  TACTO_TRY(hand);
  warn_of_newer(name, *hand);
  return std::optional(std::move(*hand));
}

bool is_force_table(std::string_view beginning) {
  const auto header = beginning.substr(0, beginning.find('\n'));
  return header.starts_with("time_s,") && header.find("force_") != std::string_view::npos;
}

std::vector<const PlaneAxisRun*> axes_with_force(const PlaneRendering& rendering) {
  std::vector<const PlaneAxisRun*> axes;
  for (const PlaneAxisRun& axis : rendering.axes)
    if (axis.name != "z" || rendering.in_space) axes.push_back(&axis);
  return axes;
}

std::string table_of(const PlaneRendering& rendering) {
  const auto axes = axes_with_force(rendering);
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "time_s");
  for (const PlaneAxisRun* axis : axes) fmt::format_to(out, ",{}_m", axis->name);
  for (const PlaneAxisRun* axis : axes) fmt::format_to(out, ",force_{}_n", axis->name);
  for (const PlaneAxisRun* axis : axes)
    if (!axis->hand_m.empty()) fmt::format_to(out, ",hand_{}_m", axis->name);
  for (const SlideRun& slide : rendering.slides) fmt::format_to(out, ",slide_{}_m", slide.piece);
  fmt::format_to(out, "\n");
  for (std::size_t i = 0; i < rendering.time_s.size(); ++i) {
    fmt::format_to(out, "{}", rendering.time_s[i]);
    for (const PlaneAxisRun* axis : axes) fmt::format_to(out, ",{}", axis->place_m[i]);
    for (const PlaneAxisRun* axis : axes) fmt::format_to(out, ",{}", axis->force_n[i]);
    for (const PlaneAxisRun* axis : axes)
      if (!axis->hand_m.empty()) fmt::format_to(out, ",{}", axis->hand_m[i]);
    for (const SlideRun& slide : rendering.slides) fmt::format_to(out, ",{}", slide.place_m[i]);
    fmt::format_to(out, "\n");
  }
  return fmt::to_string(text);
}

std::vector<Report> rows_of_axes(const PlaneRendering& rendering, const schema::Device& device) {
  std::vector<Report> rows;
  for (std::size_t i = 0; i < rendering.axes.size(); ++i) {
    const PlaneAxisRun& axis = rendering.axes[i];
    double square = 0, peak_n = 0;
    for (const double force_n : axis.force_n) {
      square += force_n * force_n;
      peak_n = std::max(peak_n, std::abs(force_n));
    }
    rows.push_back(Report()
                       .add("axis", axis.name)
                       .add("force_rms_n", std::sqrt(square / static_cast<double>(axis.force_n.size())))
                       .add("force_peak_n", peak_n)
                       .add("peak_limit_n", device.axes[i].peak_force_n)
                       .add("encoder_step_m", device.axes[i].encoder_step_m));
  }
  return rows;
}

Report report_of(const ForceRendering& asked, const schema::Device& device, const PlaneRendering& r) {
  Report report;
  report.add("forces", asked.output).add("device", device.name);
  report.add("hand", asked.hand.empty() ? "none: the path is imposed" : asked.hand).add("rate_hz", r.rate_hz);
  report.add("ticks", r.time_s.size()).add("duration_s", r.time_s.back() - r.time_s.front());
  report.add("axes", rows_of_axes(r, device)).add("force_peak_n", r.largest_force_n);
  report.add("peak_limited_ticks", r.limits.amplitude)
      .add("slew_limited_ticks", r.limits.slew)
      .add("rms_limited_ticks", r.limits.energy);
  if (r.in_space) report.add("other_side_ticks", r.other_side_ticks);
  return report.add("largest_rounding_n", r.largest_rounding_n).add("delay_s", device.delay_s);
}

// The time of a tick on this computer, with the hand in motion around a place: the shortest mean of several
// runs.
double tick_cost_s(const core::SceneView& scene, const core::ForceSetup& setup,
                   const std::array<double, 3>& place_m) {
  core::SceneKernel kernel;
  std::vector<float> live(scene.live_words());
  kernel.set(scene, setup, live.data());
  double shortest_s = INFINITY;
  for (int run = 0; run < kCostRuns; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    for (int tick = 0; tick < kCostTicks; ++tick) {
      std::int32_t counts[core::kMostAxes] = {};
      for (std::uint32_t i = 0; i < setup.axis_count; ++i) {
        const core::ForceAxis& axis = setup.axes[i];
        const double centre_m = place_m[static_cast<std::size_t>(axis.along)];
        counts[i] = static_cast<std::int32_t>(centre_m / double{axis.metres_per_count}) + tick;
      }
      kernel.tick(counts, true);
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    shortest_s = std::min(shortest_s, took.count() / kCostTicks);
  }
  return shortest_s;
}

double tick_cost_s(const core::SceneView& scene, const core::ForceSetup& setup, const schema::Patch& patch) {
  return tick_cost_s(scene, setup, {patch.x_m, patch.y_m, 0});
}

// In the solid at the place of the piece, which the hand reaches from outside in the first tick.
double tick_cost_s(const core::SceneView& scene, const core::ForceSetup& setup, const schema::Piece& piece) {
  return tick_cost_s(scene, setup, {piece.x_m, piece.y_m, piece.z_m});
}

// The scene of this layer alone.
double layer_cost_s(const SceneOnDevice& on, schema::Patch patch, const schema::ForceLayer& layer) {
  patch.layers = {layer};
  const PreparedScene alone = on.scene.with({patch});
  return tick_cost_s(alone.view(), on.setup, patch);
}

void add_grooves(Report& row, const schema::GroovesLayer& grooves, double rate_hz) {
  const double period_m = grooves.period_m.value;
  const auto amplitudes = groove_amplitudes(grooves.profile, grooves.filter_m->value / period_m);
  row.add("filter_m", grooves.filter_m->value).add("harmonics", amplitudes.size());
  row.add("whole_to_mps", core::kWholePerTick * rate_hz * period_m / static_cast<double>(amplitudes.size()));
  row.add("zero_from_mps", core::kZeroPerTick * rate_hz * period_m);
}

void add_noise(Report& row, const schema::NoiseLayer& noise, double rate_hz) {
  const double cell_m = noise.period_m.value / core::kNoiseCycles;  // of the highest frequency of an octave
  row.add("octaves", noise.octaves.value);
  row.add("whole_to_mps", core::kWholePerTick * rate_hz * cell_m / std::exp2(noise.octaves.value - 1));
  row.add("zero_from_mps", core::kZeroPerTick * rate_hz * cell_m);
}

void add_height_map(Report& row, const Relief& relief, double rate_hz) {
  row.add("columns", relief.columns).add("rows", relief.rows).add("levels", relief.levels.size());
  if (!(relief.highest_per_m > 0)) return;
  row.add("shortest_period_m", 1 / relief.highest_per_m);
  if (relief.samples_per_period > 0) row.add("samples_per_period", relief.samples_per_period);
  row.add("whole_to_mps", relief.whole_to_mps(rate_hz)).add("zero_from_mps", relief.zero_from_mps(rate_hz));
}

Report row_of_layer(const SceneOnDevice& on, const schema::Patch& patch, std::size_t index) {
  const schema::ForceLayer& layer = patch.layers[index];
  Report row;
  row.add("patch", patch.name).add("layer", index).add("type", type_of(layer));
  row.add("bytes", on.scene.layer_bytes(patch, layer)).add("alone_tick_s", layer_cost_s(on, patch, layer));
  if (const double stiffness = local_stiffness_n_per_m(layer); stiffness > 0)
    row.add("stiffness_n_per_m", stiffness);
  if (is_adaptive(layer)) row.add("adaptive", true);
  const auto at_limit = [&](const char* key, double gain) {
    if (gain > 0) row.add(key, on.device.peak_force_n / gain);
  };
  layer.visit(
      [&](const schema::SpringLayer& spring) {
        at_limit("force_limit_at_displacement_m", largest_value(spring.stiffness_n_per_m));
      },
      [&](const schema::DamperLayer& damper) {
        if (damper.two_ticks) row.add("two_ticks", true);
        if (damper.added) row.add("added_damping_n_s_per_m", damper.damping_n_s_per_m.value);
        at_limit("force_limit_at_speed_mps", largest_value(damper.damping_n_s_per_m));
      },
      [&](const schema::GroovesLayer& grooves) { add_grooves(row, grooves, double{on.setup.rate_hz}); },
      [&](const schema::HeightMapLayer& map) {
        add_height_map(row, on.scene.reliefs.of(map), double{on.setup.rate_hz});
      },
      [&](const schema::TextureForceLayer& texture) {
        add_height_map(row, on.scene.reliefs.of(texture), double{on.setup.rate_hz});
      },
      [&](const schema::ForceMapLayer& map) {
        add_height_map(row, on.scene.reliefs.of(map).x, double{on.setup.rate_hz});
        row.add("curl_n_per_m", load_of(layer).curl_n_per_m);
      },
      [&](const schema::FieldLayer& field) { row.add("atoms", on.scene.reliefs.of(field).size()); },
      [&](const schema::NoiseLayer& noise) { add_noise(row, noise, double{on.setup.rate_hz}); },
      [&](const schema::BodyLayer& body) {
        at_limit("force_limit_at_displacement_m", largest_value(body.stiffness_n_per_m));
        row.add("stiffest_coupling_n_per_m", stiffest_coupling_n_per_m(layer, on.scene.steps.tick_s));
      },
      [&](const schema::LassoLayer& /*lasso*/) {
        row.add("stiffest_coupling_n_per_m", stiffest_coupling_n_per_m(layer, on.scene.steps.tick_s));
      },
      [&](const schema::MoverLayer& mover) {
        at_limit("force_limit_at_speed_mps", largest_value(mover.damping_n_s_per_m));
      },
      [](const auto& /*other*/) {});
  return row;
}

std::vector<Report> rows_of_layers(const SceneOnDevice& on) {
  std::vector<Report> rows;
  for (const schema::Patch& patch : on.scene.patches)
    for (std::size_t i = 0; i < patch.layers.size(); ++i) rows.push_back(row_of_layer(on, patch, i));
  return rows;
}

void add_texture(Report& row, const schema::Piece& piece, const SceneOnDevice& on) {
  const schema::PieceTexture& texture = *piece.texture;
  const double gain = std::abs(piece.texture_gain), rate_hz = double{on.setup.rate_hz};
  row.add("texture", to_string(texture.type)).add("texture_gain", piece.texture_gain);
  if (texture.type == schema::PieceTextureType::sine) {
    const double u_per_m = 1 / texture.periods_m[0], v_per_m = 1 / texture.periods_m[1];
    row.add("texture_peak_n", gain * texture.amplitude_n)
        .add("texture_whole_to_mps", core::kWholePerTick * rate_hz / std::hypot(u_per_m, v_per_m))
        .add("texture_zero_from_mps", core::kZeroPerTick * rate_hz / std::min(u_per_m, v_per_m));
    return;
  }
  const bool bump = texture.type != schema::PieceTextureType::recording;
  row.add(bump ? "texture_peak_of_normal_force" : "texture_peak_n", gain * texture.largest);
  row.add("texture_stiffness_n_per_m", texture_stiffness_n_per_m(piece, on.device));
  const Relief& relief = on.scene.reliefs.of(texture);
  if (!(relief.highest_per_m > 0)) return;
  row.add("texture_whole_to_mps", relief.whole_to_mps(rate_hz));
  row.add("texture_zero_from_mps", relief.zero_from_mps(rate_hz));
}

// A hand that is deeper than the radius under a hill slides off it.
void add_relief(Report& row, const schema::PieceRelief& relief, const SceneOnDevice& on) {
  const Relief& surface = on.scene.reliefs.of(relief);
  row.add("relief", relief.file).add("columns", surface.columns).add("rows", surface.rows);
  row.add("steepest_slope", relief.largest);
  if (relief.steepest > 0) row.add("sharpest_radius_m", 1 / relief.steepest);
  if (!(surface.highest_per_m > 0)) return;
  row.add("shortest_period_m", 1 / surface.highest_per_m);
  row.add("half_rate_at_mps", 0.5 * double{on.setup.rate_hz} / surface.highest_per_m);
}

Result<Report> row_of_piece(const SceneOnDevice& on, const schema::Piece& piece) {
  schema::Scene one;
  one.pieces = {piece};
  one.point_radius_m = on.scene.point_radius_m;
  one.contact = on.scene.contact;
  one.tool_m = on.scene.tool_m;
  const auto alone = prepare_pieces(one, on.file, on.device, double{on.setup.rate_hz}, std::nullopt);
  TACTO_TRY(alone);
  Report row;
  row.add("piece", piece.name).add("shape", to_string(piece.shape));
  row.add("bytes", alone->bytes() - sizeof(core::SceneHeader) - sizeof(core::ScenePatch));
  row.add("alone_tick_s", tick_cost_s(alone->view(), on.setup, piece));
  row.add("stiffness_n_per_m", piece.stiffness_n_per_m);
  if (piece.damping_n_s_per_m > 0) row.add("damping_n_s_per_m", piece.damping_n_s_per_m);
  if (piece.stiffness_n_per_m > 0 && piece.travel.empty())
    row.add("force_limit_at_displacement_m", on.device.peak_force_n / piece.stiffness_n_per_m);
  if (!piece.travel.empty()) {
    double click_n = 0;
    for (std::size_t i = 1; i < piece.travel.size(); ++i)
      if (piece.travel[i].depth_m == piece.travel[i - 1].depth_m)
        click_n = std::max(click_n, piece.travel[i - 1].force_n - piece.travel[i].force_n);
    row.add("travel_m", piece.travel.back().depth_m)
        .add("travel_end_n", piece.travel.back().force_n)
        .add("steepest_n_per_m", steepest_spring_n_per_m(piece));
    if (click_n > 0) row.add("click_n", click_n);
  }
  if (piece.shape == schema::PieceShape::volume)
    row.add("values", on.scene.reliefs.volumes.at(piece.volume)->stored.size())
        .add("steepest_n_per_m", steepest_spring_n_per_m(alone->pieces.front()));
  for (const schema::PieceNumber& number : schema::kWallNumbers) {
    const bool rubs = number.value == &schema::Piece::static_friction ||
                      number.value == &schema::Piece::kinetic_friction ||
                      number.value == &schema::Piece::viscous_n_s_per_m;
    if (rubs && piece.*number.value > 0) row.add(number.name, piece.*number.value);
  }
  if (piece.texture) add_texture(row, piece, on);
  if (piece.slide)
    row.add("slide_from_m", piece.slide->from_m)
        .add("slide_to_m", piece.slide->to_m)
        .add("slide_stiffest_n_per_m", stiffest_slide_n_per_m(piece, on.scene.steps.tick_s));
  if (schema::is_raised(piece)) add_relief(row, *piece.relief, on);
  if (piece.clay)
    row.add("clay_force_n", piece.clay->force_n)
        .add("clay_sink_m_per_tick", 2 * piece.clay->half_m)
        .add("clay_lowest_m", piece.clay->least_m);
  if (const double energy_j = most_energy_j(piece, on.device); energy_j > 0) row.add("may_give_j", energy_j);
  if (piece.arrest_mass_kg > 0)
    row.add("arrest_in_one_tick_to_mps",
            on.device.peak_force_n / (piece.arrest_mass_kg * double{on.setup.rate_hz}));
  if (const auto transient = transient_of(piece)) {
    row.add("transient_peak_n_s_per_m", transient_peak_n_s_per_m(*transient));
    row.add("transient_stops_kg", transient_stops_kg(*transient));
    row.add("transient_whole_to_mps", transient_whole_to_mps(piece, on.device, double{on.setup.rate_hz}));
  }
  if (piece.hand_surface) {
    const SlowSurface slow = slow_surface(*piece.hand_surface);
    row.add("model_stiffness_n_per_m", slow.stiffness_n_per_m);
    row.add("model_damping_n_s_per_m", slow.damping_n_s_per_m);
  }
  return row;
}

Result<std::vector<Report>> rows_of_pieces(const SceneOnDevice& on) {
  std::vector<Report> rows;
  for (const schema::Piece& piece : on.scene.pieces) {
    auto row = row_of_piece(on, piece);
    TACTO_TRY(row);
    rows.push_back(std::move(*row));
  }
  return rows;
}

// What keeps the scene from fitting; empty: it fits. `too_slow`: in words, or empty.
void add_fit(Report& report, const PreparedScene& scene, std::optional<std::size_t> room,
             const std::string& too_slow) {
  const std::size_t bytes = scene.room_bytes();
  const bool small = !room || bytes <= *room;
  report.add("fits", small && too_slow.empty());
  if (!room && !(scene.meshes.empty() && scene.reliefs.volumes.empty()))
    report.add("memory", "not compared: --device-memory or --board gives the room of the device");
  if (!small) {
    const std::string remedy = scene.remedy_for(*room);
    report.add("because", fmt::format("the scene needs {} bytes, the device has {}{}{}", bytes, *room,
                                      remedy.empty() ? "" : ": ", remedy));
  }
  if (!too_slow.empty()) report.add("because", too_slow);
}

// The firmware as it is built has no axes, so what is compared is its core, with a board.cpp that has them.
void add_fit_on(Report& report, const PreparedScene& scene, const boards::Board& board, double rate_hz) {
  const std::size_t room = core::SceneUpload(nullptr, board.samples).most_bytes();
  const auto cost = cost_on(board, scene.view());
  const auto fault = cost ? rate_fault(board, *cost, rate_hz) : std::nullopt;
  add_fit(report, scene, room, fault ? fault->what : "");
  report.add("device_bytes", room);
  if (cost)
    add_board_cost(report, board, *cost, rate_hz);
  else
    report.add("board", board.name)
        .add("board_tick_by", "not estimated: the instruction counts do not include pieces in space");
  report.add("board_firmware",
             "drives a tray; forces need a board.cpp with axes (firmware-host/boards/README.md)");
}

}  // namespace

void declare_force_device(CLI::App& app, std::string& device) {
  app.add_option(
      "--device", device,
      fmt::format("Of a scene with force patches: the force device that plays it, a preset ({}) or "
                  "NAME.device.json",
                  fmt::join(schema::device_preset_names(), ", ")));
}

void declare_hand(CLI::App& app, std::string& hand) {
  app.add_option("--hand", hand,
                 fmt::format("With --device: an emulated hand that holds the device, a preset ({}) or "
                             "NAME.hand.json. The path is then the place to which the person moves the hand; "
                             "without a hand the device moves along the path, whatever the force",
                             fmt::join(schema::hand_preset_names(), ", ")));
}

void declare_hold_stable(CLI::App& app, bool& hold_stable) {
  app.add_flag(
      "--hold-stable", hold_stable,
      fmt::format("Of a scene of forces: where layers that act together are beyond the computed limit of "
                  "the device, or of the device in the hand that holds it, scale their stiffness and its "
                  "sliders to the limit divided by {:g}, and list them. Places to which patches are moved "
                  "later are not considered",
                  kStableMargin));
}

void add_held(Report& report, const std::vector<HeldLayer>& held, const std::vector<std::string>& unknown) {
  if (!unknown.empty()) report.add("not_judged", unknown);
  if (held.empty()) {
    report.add("held_stable", unknown.empty() ? "no layer is beyond the limit"
                                              : "no layer that was judged is beyond the limit");
    return;
  }
  std::vector<Report> rows;
  for (const HeldLayer& layer : held)
    rows.push_back(Report()
                       .add("patch", layer.patch)
                       .add("layer", layer.index)
                       .add("type", layer.type)
                       .add("from_n_per_m", layer.from_n_per_m)
                       .add("to_n_per_m", layer.to_n_per_m));
  report.add("held_stable", std::move(rows)).add("held_margin", kStableMargin);
}

Result<void> check_force_options(const CLI::App& app, std::initializer_list<std::string_view> names) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0 || option->get_positional() || option->check_lname("json")) continue;
    const auto known = [&](const std::string& name) { return std::ranges::find(names, name) != names.end(); };
    if (std::ranges::any_of(option->get_lnames(), known)) continue;
    return fail(ErrorKind::usage, option->get_name() + " is an option for a tray, not for a force device", {},
                fmt::format("with --device the options are --{}", fmt::join(names, ", --")));
  }
  return {};
}

Result<Report> render_forces(const ForceRendering& asked) {
  TACTO_TRY(cli::check_ending(asked.output, {".csv"}, "the forces are a CSV table: NAME.csv"));
  TACTO_TRY(schema::check_table_free(asked.output, asked.existing, is_force_table));
  const auto hand = hand_of(asked.hand);
  TACTO_TRY(hand);
  const auto on = scene_on_device(asked.scene, asked.device, asked.rate_hz, *hand, asked.hold_stable);
  TACTO_TRY(on);
  const auto paths = read_axis_paths(asked.path, path_axes_of(on->device, asked.path));
  TACTO_TRY(paths);
  const auto rendering = render_plane(on->scene, on->device, asked.rate_hz, *paths, *hand);
  TACTO_TRY(rendering);
  schema::PendingFiles files;
  TACTO_TRY(files.write(asked.output, table_of(*rendering)));
  TACTO_TRY(files.commit(asked.existing));
  Report report = report_of(asked, on->device, *rendering);
  if (asked.hold_stable) add_held(report, on->held, not_held_layers(on->scene.patches));
  return report;
}

Result<Report> explain_forces(const std::string& scene, const std::string& device,
                              const std::string& hand_name, std::optional<double> rate_hz,
                              std::optional<std::size_t> device_bytes, const boards::Board* board) {
  const auto hand = hand_of(hand_name);
  TACTO_TRY(hand);
  const auto on = scene_on_device(scene, device, rate_hz, *hand);
  TACTO_TRY(on);
  const core::SceneView view = on->scene.view();
  double tick_s = 0;
  for (const schema::Patch& patch : on->scene.patches)
    tick_s = std::max(tick_s, tick_cost_s(view, on->setup, patch));
  for (const schema::Piece& piece : on->scene.pieces)
    tick_s = std::max(tick_s, tick_cost_s(view, on->setup, piece));
  const auto pieces = rows_of_pieces(*on);
  TACTO_TRY(pieces);
  const double rate = double{on->setup.rate_hz};
  Report report;
  report.add("scene", schema::scene_path(scene)).add("device", on->device.name);
  report.add("hand", *hand ? (*hand)->name : "nothing holds the device").add("rate_hz", rate);
  if (board != nullptr)
    add_fit_on(report, on->scene, *board, rate);
  else
    add_fit(report, on->scene, device_bytes,
            tick_s * rate > 1 ? "a tick takes longer than the period of the device" : "");
  if (pieces->empty())
    report.add("layers", rows_of_layers(*on));
  else
    report.add("contact", to_string(on->scene.contact)).add("pieces", *pieces);
  report.add("block_bytes", on->scene.bytes())
      .add("live_bytes", view.live_words() * sizeof(float))
      .add("kernel_bytes", sizeof(core::SceneKernel))
      .add("stiffness_limit_n_per_m", on->scene.stiffness_limit_n_per_m);
  report.add("tick_s", tick_s).add("tick_of_period_percent", 100 * tick_s * rate);
  report.add("measured_on", "this computer");
  if (!view.needs_speed)
    report.add(
        "left_out",
        std::vector{Report().add("part", "speed of the hand").add("because", "no layer depends on it")});
  return report;
}

}  // namespace tacto::playback
