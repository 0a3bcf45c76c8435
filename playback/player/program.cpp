// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/unknown_note.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/version.hpp"
#include "firmware-host/core/firmware/drive_supervisor.hpp"
#include "firmware-host/core/kernel/profile.hpp"
#include "playback/player/placed_textures.hpp"
#include "playback/prepare/displacement_limit.hpp"

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

std::string transducer_sum(const std::string& name) {
  for (const std::string& path : {name, name + ".transducer.json"})
    if (schema::is_file(path)) return schema::sha256_of_file(path).value_or("");
  return {};
}

void describe(schema::SessionHeader& session, const Prepared& prepared, const PrepareOptions& options) {
  session.created = schema::creation_time();
  session.creator = kCreator;
  session.build = __VERSION__;
  session.rate_hz = options.rate_hz;
  session.metres_per_count = options.metres_per_count;
  session.inverse = to_string(options.inverse);
  session.choices = choices_in(options);
  session.delay_s = prepared.delay_left_s;
  session.loop_delay_s = options.loop_delay_s;
  session.low_hz = options.band.low_hz;
  session.high_hz = prepared.passes_to_hz;
}

// Writes the choice of the budget into the options.
Result<std::optional<TickDecision>> decided(const std::vector<PlacedTexture>& textures,
                                            const schema::Transducer& transducer, const TickBudget& budget,
                                            PrepareOptions& options) {
  if (!budget.asked()) return std::nullopt;
  const auto table = schema::find_trade_table();
  TACTO_TRY(table);
  auto decision = decide(textures, transducer, options, budget, *table);
  TACTO_TRY(decision);
  options = decision->chosen.in(options);
  return std::move(*decision);
}

// Adds notes before those of prepare().
void add_notes(Program& program, const PlacedTextures& laid, const std::string& transducer) {
  std::vector<std::string> first = laid.notes();
  first.push_back(schema::unknown_note(transducer, program.session.transducer));
  std::erase(first, "");
  std::vector<std::string>& notes = program.prepared.notes;
  notes.insert(notes.begin(), first.begin(), first.end());
}

void name_files(Program& program, const PlacedTextures& laid) {
  program.session.textures = laid.rows();
  program.session.textures.front().seam_m = program.prepared.loop_seam_m;
  if (program.scene_path.empty()) return;
  program.session.scene_file = full_path(program.scene_path);
  program.session.scene_sha256 = schema::sha256_of_file(program.scene_path).value_or("");
}

// Beyond it the kernel reads zero.
Result<void> check_place(const PlacedTextures& laid, double farthest_m) {
  const double at_m = std::max(std::abs(laid.start_m()), std::abs(laid.end_m()));
  if (at_m < farthest_m) return {};
  return fail(ErrorKind::usage, fmt::format("is up to {:g} m from the encoder's zero", at_m),
              laid.rows().front().file,
              fmt::format("place it within {:.4g} m (--at, or at_m in the scene)", farthest_m));
}

// An error of a single texture names its file, one of several textures the scene.
schema::Error naming_the_file(schema::Error error, const PlacedTextures& laid,
                              const std::string& scene_path) {
  if (laid.rows().size() == 1 && error.where.starts_with("texture"))
    error.where = laid.rows().front().file + error.where.substr(std::string_view("texture").size());
  if (error.where == "texture") error.where = scene_path;
  return error;
}

// Choices that were named are kept, even if others are cheaper.
TickBudget budget_of(const ProgramRequest& request, const schema::PlaybackChoices& choices) {
  TickBudget budget = request.budget;
  budget.keep_inverse = budget.keep_inverse || choices.inverse.has_value();
  budget.keep_reading = budget.keep_reading || choices.interpolation.has_value();
  return budget;
}

// A request must be consistent by itself. A scene or a configuration may have details for a choice that only
// some requests name.
Result<PrepareOptions> options_of(const ProgramRequest& request, const schema::PlaybackChoices& choices,
                                  const PrepareOptions& options) {
  TACTO_TRY(check_consistent(request.choices, choices));
  return with_choices(options, choices);
}

Result<void> prepare_placed(Program& program, const PlacedTextures& laid, const TickBudget& budget) {
  PrepareOptions& options = program.options;
  const schema::Transducer& transducer = program.session.transducer;
  options.gain_m_per_n = laid.gain();
  options.ends = laid.ends();
  if (const auto soft = check_onset(options.onset_s); !soft) return soft;
  auto decision = decided(laid.placed(), transducer, budget, options);
  TACTO_TRY(decision);
  program.decision = std::move(*decision);
  auto prepared = prepare(laid.placed(), transducer, options);
  if (!prepared) return tl::unexpected(naming_the_file(prepared.error(), laid, program.scene_path));
  program.reach_m = std::abs(options.metres_per_count) * core::reach_counts(prepared->scale);
  if (const auto near = check_place(laid, program.reach_m); !near) return near;
  program.prepared = std::move(*prepared);
  program.prepared.built.texture_files = laid.file_count();
  program.tray_peak_m = tray_peak_m(program.prepared, transducer, options);
  program.gain_m_per_n = laid.signed_gain();
  program.default_gain_m_per_n = laid.default_gain();
  program.start_m = laid.start_m();
  program.length_m = laid.end_m() - laid.start_m();
  return {};
}

}  // namespace

Result<void> check_onset(double onset_s) {
  if (onset_s <= double{core::kLongestOnsetS}) return {};
  return fail(ErrorKind::usage, fmt::format("an onset of {:g} s is out of range", onset_s), {},
              fmt::format("choose from 0 s to {:g} s (--onset, or onset_s in the daemon's configuration)",
                          double{core::kLongestOnsetS}));
}

Result<Program> make_program(const ProgramRequest& request, const std::string& transducer_name,
                             PrepareOptions options) {
  Program program;
  const auto laid = place_textures(request);
  TACTO_TRY(laid);
  program.kept_gain = laid->kept_gain();
  program.scene_path = laid->scene_path();
  const schema::PlaybackChoices choices = request.choices.over(laid->choices().over(request.defaults));
  const auto chosen = options_of(request, choices, options);
  TACTO_TRY(chosen);
  const auto transducer = schema::read_transducer(
      transducer_name, request.implausible ? schema::Numbers::computable : schema::Numbers::plausible);
  TACTO_TRY(transducer);
  TACTO_TRY(schema::check_usable(*transducer, request.unfit_transducer));
  program.session.transducer = *transducer;
  program.session.transducer_sha256 = transducer_sum(transducer_name);
  program.options = *chosen;
  const auto made = prepare_placed(program, *laid, budget_of(request, choices));
  TACTO_TRY(made);
  add_notes(program, *laid, transducer_name);
  if (request.any_displacement) program.tray_peak_m = 0;
  name_files(program, *laid);
  describe(program.session, program.prepared, program.options);
  TACTO_TRY(schema::session_program_text(program.session));
  return program;
}

}  // namespace tacto::playback
