// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "data-schema/report/progress.hpp"
#include "playback/cli/verbs.hpp"
#include "playback/session/session_replay.hpp"

namespace tacto::playback {

using cli::Report;
using schema::Result;

namespace {

struct ReplayVerbOptions {
  std::string session;
};

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
  cli::Progress progress("replaying");
  const auto outcome = replay_session(o.session, [&](double part) { progress.update(part); });
  TACTO_TRY(outcome);
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
  return [options] { return run_replay(*options); };
}

}  // namespace

const cli::Verb kReplayVerb{
    "replay", "Compute a session's drive or forces again, compare to the bit, and report the first mismatch",
    "tactograph replay first.session", declare_replay};

}  // namespace tacto::playback
