// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "data-schema/base/quantity.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/report/choices_report.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/report/terminal.hpp"
#include "data-schema/texture/texture.hpp"
#include "firmware-host/link/hosted_board.hpp"
#include "playback/choose/budget_words.hpp"
#include "playback/cli/board_report.hpp"
#include "playback/cli/play_options.hpp"
#include "playback/cli/play_reports.hpp"
#include "playback/cli/scene_forces.hpp"
#include "playback/cli/verbs.hpp"
#include "playback/model/texture_lookup.hpp"
#include "playback/player/program.hpp"
#include "playback/render/at_speed.hpp"

namespace tacto::playback {

using cli::Report;
using schema::Dimension;
using schema::Result;

namespace {

// The memory that a program needs on a device, and what would make it fit.

// The request for a program; `options.most_samples` is the device's memory.
struct AskedProgram {
  ProgramRequest request;
  std::string transducer;
  PrepareOptions options;

  std::size_t room() const { return options.most_samples; }
};

constexpr std::size_t kRoomEnough = std::size_t{1} << 26;

Report item(std::string name, std::size_t count, std::size_t room, std::size_t bytes_each) {
  return Report()
      .add("item", std::move(name))
      .add("bytes", count * bytes_each)
      .add("room_bytes", room * bytes_each)
      .add("of_room_percent", 100 * static_cast<double>(count) / static_cast<double>(room));
}

struct Way {
  std::string words;
  std::size_t samples = 0;
  bool fits = false;
};

// The program for a device with memory for 2^26 samples (256 MB), sixteen times that of the loop on this
// computer. Errors: as make_program; if memory is not the cause, the same as without.
Result<Program> with_room_enough(const AskedProgram& asked) {
  PrepareOptions options = asked.options;
  options.most_samples = std::max(kRoomEnough, asked.room());
  return make_program(asked.request, asked.transducer, options);
}

// A way that fails for another reason than memory is not listed.
void add_way(std::vector<Way>& ways, std::string way, const AskedProgram& asked) {
  const auto program = with_room_enough(asked);
  if (!program) return;
  const std::size_t samples = program->prepared.samples.size();
  ways.push_back({std::move(way), samples, samples <= asked.room()});
}

void add_sinc(std::vector<Way>& ways, AskedProgram asked, const Program& program) {
  if (program.prepared.scale.interpolation == wire::Interpolation::sinc) return;
  asked.request.choices.interpolation = std::string(to_string(wire::Interpolation::sinc));
  add_way(ways, "interpolate by sinc (--interpolation sinc)", asked);
}

void add_host(std::vector<Way>& ways, const AskedProgram& asked, const Program& program) {
  const std::size_t samples = program.prepared.samples.size(), room = firmware_host::HostedProfile::kSamples;
  if (asked.room() >= room) return;
  ways.push_back({"let this computer close the loop (--loop host)", samples, samples <= room});
}

std::optional<std::size_t> samples_of_beginning(schema::Texture texture, int hundredths,
                                                const Program& program, PrepareOptions options) {
  std::vector<double>& values = texture.signal.values;
  values.resize(std::max<std::size_t>(2, values.size() * static_cast<std::size_t>(hundredths) / 100));
  options.most_samples = kRoomEnough;
  const auto made = prepare(texture, program.session.transducer, options);
  if (!made) return std::nullopt;
  return made->samples.size();
}

struct Beginning {
  int hundredths = 0;  // 0: none fits
  std::size_t samples = 0;
};

// By bisection, each cut prepared: the number of samples is not proportional to the length, because a short
// cut has shorter fades at its ends, whose content is finer.
Beginning longest_beginning(const schema::Texture& texture, std::size_t room, const Program& program,
                            const PrepareOptions& options) {
  Beginning longest;
  for (int too_long = 100; too_long - longest.hundredths > 1;) {
    const int middle = (longest.hundredths + too_long) / 2;
    const auto samples = samples_of_beginning(texture, middle, program, options);
    if (samples && *samples <= room)
      longest = {middle, *samples};
    else
      too_long = middle;
  }
  return longest;
}

// Returns whether at least a hundredth fits.
bool add_beginning(std::vector<Way>& ways, const AskedProgram& asked, const Program& program,
                   const PrepareOptions& options, const char* how) {
  const auto texture = schema::read_texture(program.session.textures.front().file);
  if (!texture) return false;
  const Beginning longest = longest_beginning(*texture, asked.room(), program, options);
  if (longest.hundredths == 0) return false;
  const double length_m = 0.01 * longest.hundredths * texture->signal.length_m();
  ways.push_back(
      {fmt::format("play its first {}{}", schema::length_for_people(length_m), how), longest.samples, true});
  return true;
}

void add_beginnings(std::vector<Way>& ways, const AskedProgram& asked, const Program& program) {
  if (program.session.textures.size() != 1) return;
  PrepareOptions options = program.options;
  if (add_beginning(ways, asked, program, options, "")) return;
  options.interpolation = wire::Interpolation::sinc;
  add_beginning(ways, asked, program, options, ", by sinc (--interpolation sinc)");
}

// The space between textures needs as many samples as a texture of that length.
void add_alone(std::vector<Way>& ways, const AskedProgram& asked, const Program& program) {
  if (program.session.textures.size() < 2) return;
  std::vector<std::string> seen;
  for (const schema::SessionTexture& texture : program.session.textures) {
    if (std::ranges::find(seen, texture.file) != seen.end()) continue;
    seen.push_back(texture.file);
    AskedProgram alone = asked;
    alone.request.file = texture.file;
    alone.request.at_m = texture.at_m;
    add_way(ways, "play only " + texture.file, alone);
  }
}

std::string words_of_fitting(const std::vector<Way>& ways) {
  std::string words;
  for (const Way& way : ways)
    if (way.fits) words += (words.empty() ? "" : ", or ") + way.words;
  return words;
}

std::vector<Report> rows_of(const std::vector<Way>& ways) {
  std::vector<Report> rows;
  for (const Way& way : ways)
    rows.push_back(Report().add("way", way.words).add("samples", way.samples).add("fits", way.fits));
  return rows;
}

// Adds `device_samples`, `needed_samples`, `fits` (`in_time`: a tick fits in its period), and `memory`: for
// each item its bytes and the device's memory for it.
void add_room(Report& report, const Prepared& made, std::size_t device_samples, bool in_time) {
  const std::size_t needed = made.samples.size();
  report.add("device_samples", device_samples).add("needed_samples", needed);
  report.add("fits", needed <= device_samples && in_time);
  std::vector<Report> items;
  for (std::uint8_t level = 0; level < made.scale.levels; ++level)
    items.push_back(item(fmt::format("samples of level {}", level + 1),
                         core::level_samples(made.scale, level), device_samples, sizeof(float)));
  items.push_back(item("samples of all levels", needed, device_samples, sizeof(float)));
  items.push_back(item("filter's taps", made.built.taps, wire::kMaxTaps, sizeof(float)));
  items.push_back(item("play operators of the hysteresis", made.built.play_operators, wire::kMaxPlays,
                       sizeof(wire::HysteresisPlay)));
  items.push_back(item("sections", made.built.sections, wire::kMaxSections, sizeof(wire::Section)));
  report.add("memory", std::move(items));
}

// Adds `ways_to_fit`, each with the number of samples, as prepared: interpolation by sinc, the longest
// beginning of a texture that fits (to a hundredth of it; by sinc if no other does), each texture of a scene
// by itself, the loop on this computer. Returns what to do, in words: the ways that fit, or that none does.
std::string add_ways_to_fit(Report& report, const AskedProgram& asked, const Program& program) {
  std::vector<Way> ways;
  add_sinc(ways, asked, program);
  add_beginnings(ways, asked, program);
  add_alone(ways, asked, program);
  const bool on_device = !words_of_fitting(ways).empty();
  add_host(ways, asked, program);
  report.add("ways_to_fit", rows_of(ways));
  const std::string fitting = words_of_fitting(ways);
  if (on_device) return fitting;
  return "no tested alternative fits on the device, neither sinc nor a part of the texture" +
         (fitting.empty() ? "" : "; " + fitting);
}

struct ExplainOptions {
  ProgramRequest program;
  std::optional<double> speed_mps;
  std::string transducer = "wiertlewski2011", device, hand;
  CLI::Option* rate = nullptr;
  std::size_t device_memory = 0;
  std::string board;
  PrepareOptions prepare;
  AskedBudget budget;

  /// Null without --board.
  const boards::Board* on() const { return boards::board_named(board.c_str()); }
};

std::vector<Report> rows_of_textures(const Program& program) {
  std::vector<Report> rows;
  for (const schema::SessionTexture& texture : program.session.textures) {
    Report row;
    row.add("texture", texture.file).add("at_m", texture.at_m);
    add_gain(row, texture.gain_m_per_n, texture.gain_m_per_n);
    rows.push_back(std::move(row.add("ends", std::string(schema::to_string(texture.ends)))));
  }
  return rows;
}

std::vector<Report> rows_of_levels(const Prepared& made) {
  std::vector<Report> rows;
  for (std::uint8_t level = 0; level < made.scale.levels; ++level) {
    const double passes_per_m = made.finest_per_m * std::exp2(-0.5 * level);
    const std::size_t samples = core::level_samples(made.scale, level);
    rows.push_back(Report()
                       .add("level", level + 1)
                       .add("passes_per_m", passes_per_m)
                       .add("up_to_mps", made.passes_to_hz / passes_per_m)
                       .add("pitch_m", std::ldexp(made.pitch_m, level / 2))
                       .add("samples", samples)
                       .add("bytes", samples * sizeof(float)));
  }
  return rows;
}

std::vector<Report> rows_of_left_out(const Prepared& made) {
  std::vector<Report> rows;
  for (const LeftOut& each : left_out_of(made))
    rows.push_back(Report().add("part", each.part).add("because", each.because));
  return rows;
}

void add_chain(Report& report, const Prepared& made) {
  report.add("filter_taps", made.built.taps).add("filter_delay_s", made.delay_s);
  report.add("inverse_error_db", made.inverse_error_db).add("passes_to_hz", made.passes_to_hz);
  report.add("hysteresis_plays", made.built.play_operators).add("sections", made.built.sections);
}

void add_guards(Report& report, const Prepared& made) {
  report.add("drive_limit_v", double{made.limits.drive_v})
      .add("slew_limit_v_per_s", double{made.limits.slew_v_per_s});
  report.add("energy_limits", made.built.energy_limits).add("touch_gates", made.built.touch_gates);
}

// The kernel has a fixed size; the memory to which it points is that of the textures.
void add_costs(Report& report, const Prepared& made, double tick_ns, const schema::FoundTradeTable& table) {
  report.add("sample_bytes", made.built.sample_bytes).add("kernel_bytes", sizeof(core::TickKernel));
  report.add("tick_s", 1e-9 * tick_ns).add("tick_of_period_percent", 1e-7 * tick_ns * made.rate_hz);
  report.add("by_table", table.origin);
}

Result<Report> explained(const ExplainOptions& o, const Program& program) {
  const Prepared& made = program.prepared;
  const auto table = schema::find_trade_table();
  TACTO_TRY(table);
  const auto tick_ns =
      tick_cost_ns(table->table, made.scale.interpolation, made.built.taps, made.play_operators.count > 0);
  TACTO_TRY(tick_ns);
  Report report;
  report.add("what", program.name()).add("transducer", program.session.transducer.name);
  report.add("rate_hz", made.rate_hz).add("length_m", program.length_m);
  add_kept_gain(report, program.kept_gain);
  report.add("textures", rows_of_textures(program)).add("texture_files_read", made.built.texture_files);
  add_loop(report, made.loop_period_m, made.loop_seam_m);
  if (program.scene_path.empty() && program.session.textures.front().ends == schema::TextureEnds::stop)
    report.add("fade_of_ends_m", fade_of(program.length_m));
  report.add("levels", rows_of_levels(made));
  cli::add_choices(report, choices_in(program.options));
  add_chain(report, made);
  add_guards(report, made);
  add_costs(report, made, *tick_ns, *table);
  report.add("left_out", rows_of_left_out(made));
  if (!made.notes.empty()) report.add("notes", made.notes);
  if (program.decision) add_decision(report, *program.decision, o.budget.options.explain);
  return report;
}

// The room of the device, and of a board the cost of a tick. A rate that is too high ends as a texture that
// is too large.
void add_device(Report& report, const ExplainOptions& o, std::size_t room, const Prepared& made) {
  const boards::Board* const board = o.on();
  if (board == nullptr) return add_room(report, made, room, true);
  const BoardCost cost = cost_on(*board, made);
  const auto fault = rate_fault(*board, cost, made.rate_hz);
  add_room(report, made, room, !fault);
  add_board_cost(report, *board, cost, made.rate_hz);
  if (!fault) return;
  cli::write_message(fmt::format("tactograph: {}\n", cli::on_one_line(schema::message(*fault))));
  report.ends_with(fault->kind);
}

// The error is the same as of verbs that stop at it; the table is printed in addition.
Result<Report> explained_without_room(const ExplainOptions& o, const AskedProgram& asked,
                                      schema::Error refused) {
  const auto program = with_room_enough(asked);
  if (!program || program->prepared.samples.size() <= asked.room()) return tl::unexpected(refused);
  auto report = explained(o, *program);
  if (!report) return report;
  add_device(*report, o, asked.room(), program->prepared);
  refused.remedy = add_ways_to_fit(*report, asked, *program);
  cli::write_message(fmt::format("tactograph: {}\n", cli::on_one_line(schema::message(refused))));
  return report->ends_with(refused.kind);
}

std::string reason_of(const AtSpeed& answer, const std::optional<SpeedRange>& range) {
  if (!answer.fits_limits())
    return fmt::format("the {} would need {:.0f} % of its limit", answer.tightest.name,
                       100 * answer.tightest.used());
  const std::string reason = fmt::format("{:.0f} % of the texture's power is in the band, less than {:g} %",
                                         answer.power_kept_percent, kLeastPowerPercent);
  if (!range) return reason;
  return reason + (answer.speed_mps < range->from_mps ? ": too slow" : ": too fast");
}

void add_speeds(Report& report, const std::optional<SpeedRange>& range) {
  if (!range) {
    report.add("playable_speeds", "none from 1 mm/s to 2 m/s");
    return;
  }
  report.add("smallest_speed_mps", range->from_mps).add("largest_speed_mps", range->to_mps);
}

// Whether a finger of that speed can feel it.
Result<Report> explained_at_speed(const Program& program, double speed_mps) {
  if (!(speed_mps > 0))
    return schema::fail(schema::ErrorKind::usage, "the speed must be above zero", "--speed");
  if (!program.scene_path.empty())
    return schema::fail(schema::ErrorKind::usage, "is a scene", program.scene_path,
                        "--speed takes one texture: name one of the scene");
  const auto texture = schema::read_texture(program.name());
  TACTO_TRY(texture);
  const schema::Transducer& transducer = program.session.transducer;
  const PreparedTexture played{*texture, transducer, program.prepared, program.options};
  const double gain_m_per_n = program.gain_m_per_n;
  const AtSpeed answer = at_speed(played, gain_m_per_n, speed_mps);
  const auto range = playable_speeds(played, gain_m_per_n, speed_mps);
  Report report;
  report.add("can_be_played", answer.can_be_played());
  if (!answer.can_be_played()) report.add("because", reason_of(answer, range));
  report.add("speed_mps", speed_mps);
  add_speeds(report, range);
  report.add("texture", program.name()).add("transducer", transducer.name);
  add_gain(report, gain_m_per_n, program.default_gain_m_per_n);
  if (const double largest = largest_gain_at(played, gain_m_per_n, speed_mps); largest != 0)
    report.add("largest_gain_m_per_n", largest)
        .add("largest_gain_times_default", largest / program.default_gain_m_per_n);
  report.add("rate_hz", program.options.rate_hz).add("tightest_limit", answer.tightest.name);
  return report.add("limit_used_percent", 100 * answer.tightest.used())
      .add("power_kept_percent", answer.power_kept_percent)
      .add("band", fmt::format("{:g}-{:g} Hz", program.options.band.low_hz, program.options.band.high_hz));
}

Result<Report> run_explain(ExplainOptions o) {
  const auto budget = o.budget.budget();
  TACTO_TRY(budget);
  o.program.budget = *budget;
  if (o.device_memory > 0) o.prepare.most_samples = o.device_memory;
  if (o.on() != nullptr) o.prepare.most_samples = o.on()->samples;
  o.program.any_displacement = o.speed_mps.has_value();  // the answer names the limit
  const AskedProgram asked{o.program, o.transducer, o.prepare};
  const auto program = make_program(asked.request, asked.transducer, asked.options);
  if (!program) return explained_without_room(o, asked, program.error());
  for (const std::string& note : program->prepared.notes) cli::warn(note);
  if (o.speed_mps) return explained_at_speed(*program, *o.speed_mps);
  auto report = explained(o, *program);
  if (report && (o.device_memory > 0 || o.on() != nullptr))
    add_device(*report, o, asked.room(), program->prepared);
  return report;
}

cli::Action declare_explain(CLI::App& app) {
  auto options = std::make_shared<ExplainOptions>();
  ExplainOptions& o = *options;
  app.add_option("what", o.program.file, "Texture or scene: stem or file name")->required();
  app.add_option("--transducer", o.transducer, "A preset or NAME.transducer.json")->capture_default_str();
  declare_force_device(app, o.device);
  app.add_option(
      "--hand", o.hand,
      fmt::format("With --device: the hand that holds it, a preset ({}) or NAME.hand.json. Filters and "
                  "added dampers are those for this hand; default: nothing holds it",
                  fmt::join(schema::hand_preset_names(), ", ")));
  cli::add_quantity(
      app, "--speed", o.speed_mps, Dimension::speed,
      "Judge the playback under a finger of this speed: whether the transducer can play the texture, the "
      "share "
      "of the nearest limit, the share of the texture's power in the band, the speeds at which it can be "
      "played, and the largest gain");
  cli::add_gain(app, o.program.gain, "Gain of a texture: ", kDefaultGain);
  cli::declare_unfit_transducer(app, o.program.unfit_transducer);
  cli::refuse_force(app);
  app.add_flag("--implausible", o.program.implausible,
               "Accept a transducer file with impossible numbers, for example a mass of 1e-12 kg");
  o.rate = cli::add_quantity(app, "--rate", o.prepare.rate_hz, Dimension::frequency,
                             "Tick rate; with --device: default its largest");
  cli::add_quantity(app, "--encoder-step", o.prepare.metres_per_count, Dimension::length,
                    "Length of one encoder count");
  CLI::Option* const memory =
      app.add_option("--device-memory", o.device_memory,
                     "Samples that the device holds; default: 2^24, the largest number that is prepared")
          ->check(cli::from_one());
  declare_board(app, o.board)->excludes(memory);
  declare_ends(app, o.program.ends);
  declare_choices(app, o.program.choices);
  app.add_flag_callback(
      "--keep-hysteresis", [&o] { o.prepare.undo_hysteresis = false; },
      "Do not invert the hysteresis of the transducer's file");
  declare_tick_budget(app, o.budget);
  return [options, &app]() -> Result<Report> {
    const ExplainOptions& asked = *options;
    if (asked.device.empty() && !asked.hand.empty())
      return schema::fail(schema::ErrorKind::usage, "--hand requires --device");
    if (asked.device.empty()) return run_explain(asked);
    TACTO_TRY(check_force_options(app, {"device", "hand", "rate", "device-memory", "board"}));
    const auto rate_hz = asked.rate->count() > 0 ? std::optional(asked.prepare.rate_hz) : std::nullopt;
    const auto bytes =
        asked.device_memory > 0 ? std::optional(asked.device_memory * sizeof(float)) : std::nullopt;
    return explain_forces(asked.program.file, asked.device, asked.hand, rate_hz, bytes, asked.on());
  };
}

}  // namespace

const cli::Verb kExplainVerb{
    "explain",
    "List what is built to play a texture or scene, what it costs in memory and time, "
    "and what was left out",
    "tactograph explain bench.scene.json\n"
    "  tactograph explain plane.scene.json --device sandpaper-1990\n"
    "  tactograph explain oak --board stm32f405 --interpolation sinc\n"
    "  tactograph explain oak --speed 150mm/s --transducer mine\n"
    "  tactograph explain oak --transducer mine --rate 10kHz --quality balanced --explain\n"
    "  tactograph explain oak --interpolation sinc --inverse magnitude --reconstruction butterworth3",
    declare_explain};

}  // namespace tacto::playback
