// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/command/output_options.hpp"
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
  std::string session, volume, output;
  schema::Existing existing = schema::Existing::keep;
};

// The piece whose values before carving are those of the volume; they become those at the end of the session.
bool take_carved(const core::SceneKernel& kernel, schema::Volume& volume) {
  const core::SceneView& scene = kernel.scene();
  for (std::uint32_t i = 0; i < scene.layer_count; ++i) {
    const std::int16_t* const carved = kernel.carved_values(i);
    if (carved == nullptr) continue;
    const auto& table = core::table_of<core::VolumeTable>(scene, scene.layers[i]);
    bool same = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      same = same && table.along[axis].samples == volume.samples[axis];
    if (!same || !std::ranges::equal(volume.stored, std::span(values_of(table), volume.stored.size())))
      continue;
    std::copy_n(carved, volume.stored.size(), volume.stored.begin());
    return true;
  }
  return false;
}

Result<void> write_carved(const ReplayVerbOptions& o, const schema::Volume& before, schema::Volume carved,
                          Report& report) {
  const std::string path = schema::volume_path(o.output);
  std::size_t values = 0;
  for (std::size_t i = 0; i < carved.stored.size(); ++i) values += carved.stored[i] != before.stored[i];
  carved.notes += fmt::format("{}carved in {}", carved.notes.empty() ? "" : "; ",
                              std::filesystem::path(schema::session_path(o.session)).filename().string());
  carved.created = schema::creation_time();
  carved.creator = kCreator;
  TACTO_TRY(schema::write_volume(path, carved, o.existing));
  report.add("carved_values", values).add("files", std::vector{path});
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
  if (o.volume.empty() != o.output.empty())
    return schema::fail(schema::ErrorKind::usage, "--volume and --output belong together",
                        o.volume.empty() ? "--output" : "--volume",
                        "name the volume that was carved, and the new file");
  schema::Volume before, carved;
  if (!o.volume.empty()) {
    TACTO_TRY(schema::check_output_free(schema::volume_path(o.output), o.existing));
    auto read = schema::read_volume(o.volume);
    TACTO_TRY(read);
    before = carved = std::move(*read);
  }
  bool taken = false;
  const auto outcome = [&] {
    cli::Progress progress("replaying");
    return replay_session(
        o.session, [&](double part) { progress.update(part); }, {}, {},
        [&](const core::SceneKernel& kernel) { taken = take_carved(kernel, carved); });
  }();
  TACTO_TRY(outcome);
  if (!o.volume.empty() && outcome->same() && !taken)
    return schema::fail(schema::ErrorKind::unsuitable, "this session carved no volume with these values",
                        o.volume, "name the volume of a piece with `carve`, as it was before the session");
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
  if (taken) TACTO_TRY(write_carved(o, before, std::move(carved), report));
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
  app.add_option("-o,--output", options->output,
                 "With --volume: the volume after the session, NAME.volume.nc");
  cli::declare_force(app, options->existing);
  return [options] { return run_replay(*options); };
}

}  // namespace

const cli::Verb kReplayVerb{
    "replay", "Compute a session's drive or forces again, compare to the bit, and report the first mismatch",
    "tactograph replay first.session\n  tactograph replay drilled --volume bone -o drilled", declare_replay};

}  // namespace tacto::playback
