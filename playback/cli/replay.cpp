// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/height/height_map.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/version.hpp"
#include "data-schema/volume/volume.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"
#include "firmware-host/core/scene/volume.hpp"
#include "playback/cli/verbs.hpp"
#include "playback/session/session_replay.hpp"

namespace tacto::playback {

using cli::Report;
using schema::Result;

namespace {

struct ReplayVerbOptions {
  std::string session, volume, relief, output;
  schema::Existing existing = schema::Existing::keep;
};

// What a session has changed, as it was before and is after it.
struct ChangedPiece {
  schema::Volume volume, volume_after;
  schema::HeightMap map, map_after;
  std::vector<float> before_m;  // the heights of the map as they were rounded
  double least_m = 0;
  bool taken = false;
};

// The piece whose values before carving are those of the volume; they become those at the end of the session.
bool take_carved(const core::SceneKernel& kernel, schema::Volume& volume) {
  const core::SceneView &scene = kernel.scene(), now = kernel.scene_now();
  for (std::uint32_t i = 0; i < scene.layer_count; ++i) {
    if (scene.layers[i].kind != static_cast<std::uint16_t>(core::SceneLayerKind::volume)) continue;
    const auto& table = core::table_of<core::VolumeTable>(scene, scene.layers[i]);
    bool same = table.carve_n > 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      same = same && table.along[axis].samples == volume.samples[axis];
    if (!same || !std::ranges::equal(volume.stored, std::span(values_of(table), volume.stored.size())))
      continue;
    const auto& carved = core::table_of<core::VolumeTable>(now, now.layers[i]);
    std::copy_n(values_of(carved), volume.stored.size(), volume.stored.begin());
    return true;
  }
  return false;
}

std::span<const float> clay_heights(const core::ReliefPieceTable& table) {
  const core::ReliefTable& relief = relief_of(table);
  return {coefficients_of(relief, levels_of(relief)[0]), coefficient_count(relief)};
}

// The same of clay, whose heights are rounded to a unit of at most 2^-23 of the largest place. With the
// lowest place to which it can sink.
bool take_pressed(const core::SceneKernel& kernel, ChangedPiece& changed) {
  schema::HeightMap& map = changed.map_after;
  const core::SceneView &scene = kernel.scene(), now = kernel.scene_now();
  for (std::uint32_t i = 0; i < scene.layer_count; ++i) {
    if (scene.layers[i].kind != static_cast<std::uint16_t>(core::SceneLayerKind::relief)) continue;
    const auto& table = core::table_of<core::ReliefPieceTable>(scene, scene.layers[i]);
    const core::ReliefLevelTable& level = levels_of(relief_of(table))[0];
    if (!(table.clay.force_n > 0) || level.columns != map.columns || level.rows != map.rows) continue;
    const float rounding_m = 0x1p-23F * std::max(std::abs(table.clay.least_m), std::abs(table.clay.most_m));
    if (!std::ranges::equal(map.height_m, clay_heights(table),
                            [&](float a, float b) { return std::abs(a - b) <= rounding_m; }))
      continue;
    changed.least_m = double{table.clay.least_m};
    const auto before = clay_heights(table);
    changed.before_m.assign(before.begin(), before.end());
    const auto pressed = clay_heights(core::table_of<core::ReliefPieceTable>(now, now.layers[i]));
    map.height_m.assign(pressed.begin(), pressed.end());
    return true;
  }
  return false;
}

bool is_stl(const std::string& output) {
  return output.ends_with(".stl") || output.ends_with(".STL");
}

std::string output_path(const ReplayVerbOptions& o) {
  if (!o.volume.empty()) return schema::volume_path(o.output);
  return is_stl(o.output) ? o.output : schema::height_map_path(o.output);
}

Result<ChangedPiece> read_changed(const ReplayVerbOptions& o) {
  ChangedPiece changed;
  if (o.output.empty()) return changed;
  TACTO_TRY(schema::check_output_free(output_path(o), o.existing));
  if (!o.volume.empty()) {
    auto read = schema::read_volume(o.volume);
    TACTO_TRY(read);
    changed.volume = changed.volume_after = std::move(*read);
    return changed;
  }
  auto read = schema::read_height_map(o.relief);
  TACTO_TRY(read);
  changed.map = changed.map_after = std::move(*read);
  return changed;
}

template <class File>
void sign(const ReplayVerbOptions& o, const char* changed, File& file) {
  file.notes += fmt::format("{}{} in {}", file.notes.empty() ? "" : "; ", changed,
                            std::filesystem::path(schema::session_path(o.session)).filename().string());
  file.created = schema::creation_time();
  file.creator = kCreator;
}

Result<void> write_carved(const ReplayVerbOptions& o, ChangedPiece& changed, Report& report) {
  const std::string path = output_path(o);
  std::size_t values = 0;
  for (std::size_t i = 0; i < changed.volume.stored.size(); ++i)
    values += changed.volume_after.stored[i] != changed.volume.stored[i];
  sign(o, "carved", changed.volume_after);
  TACTO_TRY(schema::write_volume(path, changed.volume_after, o.existing));
  report.add("carved_values", values).add("files", std::vector{path});
  return {};
}

// The base of a solid is a pitch below the lowest place to which it can sink.
Result<void> write_pressed(const ReplayVerbOptions& o, ChangedPiece& changed, Report& report) {
  const std::string path = output_path(o);
  std::size_t heights = 0;
  double sunk_m = 0, lowest_m = 0, highest_m = 0;
  for (std::size_t i = 0; i < changed.map.height_m.size(); ++i) {
    const double rise_m = double{changed.map_after.height_m[i]} - double{changed.before_m[i]};
    heights += rise_m != 0;
    sunk_m -= rise_m, lowest_m = std::min(lowest_m, rise_m), highest_m = std::max(highest_m, rise_m);
  }
  sign(o, "pressed", changed.map_after);
  TACTO_TRY(is_stl(path) ? schema::write_height_stl(path, changed.map_after,
                                                    changed.least_m - changed.map.pitch_m, o.existing)
                         : schema::write_height_map(path, changed.map_after, o.existing));
  report.add("pressed_heights", heights)
      .add("deepest_m", -lowest_m)
      .add("highest_m", highest_m)
      .add("volume_lost_m3", sunk_m * changed.map.pitch_m * changed.map.pitch_m)
      .add("files", std::vector{path});
  return {};
}

// For an incomplete session neither "yes" nor "no" would be correct: the report states up to which tick it is
// the same.
void add_sameness(Report& report, const ReplayOutcome& outcome) {
  const bool yes = !outcome.first_difference;
  if (yes && outcome.damaged_at)
    report.add("same_to_the_bit_up_to_the_damage", yes);
  else if (yes && outcome.lost_at)
    report.add("same_to_the_bit_up_to_the_lost_tick", yes);
  else
    report.add("same_to_the_bit", yes);
}

Result<Report> run_replay(const ReplayVerbOptions& o) {
  if (!o.volume.empty() && !o.relief.empty())
    return schema::fail(schema::ErrorKind::usage, "--volume and --relief are given", "--relief",
                        "write one of them, then the other one");
  if ((o.volume.empty() && o.relief.empty()) != o.output.empty())
    return schema::fail(schema::ErrorKind::usage, "--output belongs to --volume or --relief",
                        o.output.empty() ? "--output" : "--volume",
                        "name the volume that was carved, or the height map of the clay, and the new file");
  auto changed = read_changed(o);
  TACTO_TRY(changed);
  const auto outcome = [&] {
    cli::Progress progress("replaying");
    return replay_session(
        o.session, [&](double part) { progress.update(part); }, {}, {},
        [&](const core::SceneKernel& kernel) {
          if (!o.volume.empty()) changed->taken = take_carved(kernel, changed->volume_after);
          if (!o.relief.empty()) changed->taken = take_pressed(kernel, *changed);
        });
  }();
  TACTO_TRY(outcome);
  if (!o.output.empty() && outcome->same() && !changed->taken)
    return o.relief.empty()
               ? schema::fail(schema::ErrorKind::unsuitable,
                              "this session carved no volume with these values", o.volume,
                              "name the volume of a piece with `carve`, as it was before the session")
               : schema::fail(schema::ErrorKind::unsuitable, "this session has no clay with these heights",
                              o.relief,
                              "name the height map of a piece with `clay`, as it was before the session");
  Report report;
  report.add("session", schema::session_path(o.session)).add("ticks_compared", outcome->ticks);
  add_sameness(report, *outcome);
  if (outcome->ending == schema::SessionEnding::unclosed)
    cli::warn("the session was never closed: its stored part was compared");
  if (outcome->damaged_at) {
    cli::warn(
        fmt::format("the session is damaged from byte {} on: the part before it was compared; later commands "
                    "may be missing in it",
                    *outcome->damaged_at));
    report.add("damaged_at_byte", *outcome->damaged_at).ends_with(schema::ErrorKind::malformed);
  }
  if (outcome->lost > 0) report.add("lost_ticks", outcome->lost);
  if (outcome->lost_at) {
    cli::warn(fmt::format("ticks are missing from tick {} on: the drive after them can't be replayed",
                          *outcome->lost_at));
    report.add("lost_at_tick", *outcome->lost_at);
    if (!outcome->damaged_at) report.ends_with(schema::ErrorKind::unsuitable);
  }
  if (changed->taken)
    TACTO_TRY(o.relief.empty() ? write_carved(o, *changed, report) : write_pressed(o, *changed, report));
  if (!outcome->first_difference) return report;
  const Difference& first = *outcome->first_difference;
  report.add("first_difference_tick", first.tick)
      .add("recorded_" + first.unit, double{first.recorded})
      .add("replayed_" + first.unit, double{first.replayed});
  if (!outcome->damaged_at) report.ends_with(schema::ErrorKind::unsuitable);
  return report;
}

cli::Action declare_replay(CLI::App& app) {
  auto options = std::make_shared<ReplayVerbOptions>();
  app.add_option("session", options->session, "NAME.session")->required();
  app.add_option("--volume", options->volume,
                 "The volume of a piece that was carved, NAME.volume.nc as before the session: with -o");
  app.add_option("--relief", options->relief,
                 "The relief of a piece of clay, NAME.height.nc as before the session: with -o");
  app.add_option(
      "-o,--output", options->output,
      "The volume or the relief after the session: NAME.volume.nc, NAME.height.nc, or a solid of the "
      "relief in millimetres, NAME.stl");
  cli::declare_force(app, options->existing);
  return [options] { return run_replay(*options); };
}

}  // namespace

const cli::Verb kReplayVerb{
    "replay", "Compute a session's drive or forces again, compare to the bit, and report the first mismatch",
    "tactograph replay first.session\n  tactograph replay drilled --volume bone -o drilled\n  "
    "tactograph replay bowl --relief block -o bowl.stl",
    declare_replay};

}  // namespace tacto::playback
