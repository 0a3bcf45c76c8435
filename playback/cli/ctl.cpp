// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "data-schema/command/stop_signals.hpp"
#include "data-schema/control/control.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/report/terminal.hpp"
#include "playback/cli/play_options.hpp"
#include "playback/cli/play_reports.hpp"
#include "playback/cli/verbs.hpp"
#include "playback/control/control_connection.hpp"
#include "playback/control/control_socket.hpp"
#include "playback/host-loop/time_histogram.hpp"
#include "playback/player/scene_command.hpp"

namespace tacto::playback {

using cli::Report;
using schema::ControlFields;
using schema::ControlRequest;
using schema::ControlVerb;
using schema::Dimension;
using schema::Result;

namespace {

using schema::ControlFields;

using cli::Report;
using schema::ControlFields;
using schema::ControlRequest;
using schema::ControlVerb;
using schema::Result;

constexpr int kBeatMs = 250;
constexpr double kDeadManS = 2;  // eight heartbeats, because a busy computer delays some

Result<ControlFields> asked(ControlConnection& connection, ControlVerb verb) {
  ControlRequest request;
  request.verb = verb;
  return connection.ask(request);
}

Result<void> arm_while_connected(ControlConnection& connection) {
  ControlRequest request;
  request.verb = ControlVerb::arm;
  request.while_connected = true;
  request.dead_man_s = kDeadManS;
  const auto armed = connection.ask(request);
  TACTO_TRY(armed);
  return {};
}

bool goes_on(const ControlFields& status) {
  const std::string state = schema::control_text(status, "state");
  return state == "armed" || state == "playing";
}

Result<Report> report_of_end(ControlConnection& connection) {
  const auto status = asked(connection, ControlVerb::status);
  TACTO_TRY(status);
  constexpr std::array<std::string_view, 9> kTold = {
      "state", "why", "fault", "session", "played_s", "armed_s", "lost_ticks", "late_ticks", "drive_peak_v"};
  Report report;
  for (const auto& [name, value] : *status) {
    if (std::ranges::find(kTold, name) == kTold.end()) continue;
    if (const auto* text = std::get_if<std::string>(&value)) report.add(name, *text);
    if (const auto* number = std::get_if<double>(&value)) report.add(name, *number);
    if (const auto* count = std::get_if<std::int64_t>(&value)) report.add(name, *count);
  }
  const std::string state = schema::control_text(*status, "state");
  if (state == "fault" || state == "lost") report.ends_with(schema::ErrorKind::device);
  return report;
}

// Each request for a status also shows that this client is alive.
Result<void> watch_until_the_end(ControlConnection& connection, std::optional<double> time_s,
                                 const cli::StopSignals& signals,
                                 const std::function<void(const ControlFields&)>& show) {
  const auto begun = std::chrono::steady_clock::now();
  const auto over = [&] {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begun;
    return time_s && elapsed.count() >= *time_s;
  };
  while (!signals.stop_asked() && !over()) {
    const auto status = asked(connection, ControlVerb::status);
    TACTO_TRY(status);
    show(*status);
    if (!goes_on(*status)) return {};
    // No events come: this only waits, and a signal ends it.
    TACTO_TRY(connection.next_event(kBeatMs));
  }
  TACTO_TRY(asked(connection, ControlVerb::stop));
  const auto disarmed = asked(connection, ControlVerb::disarm);
  return disarmed ? Result<void>() : schema::forward_error(disarmed);
}

// Arms such that the drive falls if this process ends or stops (`while_connected`, `dead_man_s`), plays, and
// stays connected until it is interrupted, `time_s` is over, or the session ends in another way; then it
// stops the drive and disarms. `show` receives each status, four a second. Errors: as ask(); unsupported: a
// daemon without `while_connected`.
Result<Report> watched_play(ControlConnection& connection, std::optional<double> time_s,
                            const std::function<void(const ControlFields&)>& show) {
  const cli::StopSignals signals;
  TACTO_TRY(arm_while_connected(connection));
  TACTO_TRY(asked(connection, ControlVerb::play));
  TACTO_TRY(watch_until_the_end(connection, time_s, signals, show));
  return report_of_end(connection);
}

// Histogram of the lateness between the bounds of the status: one sign is 2 %; smaller parts above 0 show as
// a dot.
std::string lateness_bars(const ControlFields& fields) {
  std::string bars;
  double beyond_lower = 1;
  const auto add = [&](const std::string& name, double beyond_upper) {
    const double part = std::max(beyond_lower - beyond_upper, 0.0);
    const auto signs = static_cast<std::size_t>(50 * part);
    bars += fmt::format("  {:<8} {:7.3f} % {}\n", name, 100 * part,
                        signs > 0  ? std::string(signs, '#')
                        : part > 0 ? "."
                                   : "");
    beyond_lower = beyond_upper;
  };
  for (const double bound_s : kLateBoundsS)
    add(fmt::format("< {:g} us", 1e6 * bound_s), schema::control_number(fields, late_part_name(bound_s)));
  add("more", 0);
  return bars;
}

std::string lateness_lines(const ControlFields& fields) {
  const auto number = [&](std::string_view name) { return schema::control_number(fields, name); };
  if (!(number("wake_p99_s") > 0)) return {};
  return fmt::format("late by  p50 {:.1f}  p99 {:.1f}  p99.9 {:.1f} us   busy p99 {:.2f} us\n",
                     1e6 * number("wake_p50_s"), 1e6 * number("wake_p99_s"), 1e6 * number("wake_p999_s"),
                     1e6 * number("busy_p99_s")) +
         lateness_bars(fields) +
         fmt::format("edge to drive  p50 {:.2f}  p99 {:.2f} ms, looked ahead by {:.2f} ms\n",
                     1e3 * number("latency_p50_s"), 1e3 * number("latency_p99_s"),
                     1e3 * number("looked_ahead_s"));
}

// The count of limited ticks is known slightly earlier than what the limits removed.
std::string words_of_taken(const ControlFields& fields) {
  if (const std::string unknown = schema::control_text(fields, "limits_took"); !unknown.empty())
    return unknown;
  const double all_db = schema::control_number(fields, "limits_took_db", NAN);
  const double second_db = schema::control_number(fields, "limits_took_last_second_db", NAN);
  if (std::isnan(all_db)) return "not known yet";
  return fmt::format("{} in the last second, {:.1f} dB since arming",
                     std::isnan(second_db) ? "nothing" : fmt::format("{:.1f} dB", second_db), all_db);
}

// RMS relative to the unlimited drive; `tactograph session` reports it for each stroke.
std::string limits_line(const ControlFields& fields) {
  const std::string tells = schema::control_text(fields, "limits_in_db");
  if (tells.empty()) return {};
  return fmt::format("limits   removed {}   by stroke: {}\n", words_of_taken(fields), tells);
}

// Empty before a load.
std::string gain_words(const ControlFields& fields) {
  if (schema::control_text(fields, "loaded").empty()) return {};
  return fmt::format("   gain {:.4g} mm/N", 1e3 * schema::control_number(fields, "gain_m_per_n"));
}

std::string drive_line(const ControlFields& fields) {
  const auto number = [&](std::string_view name) { return schema::control_number(fields, name); };
  return fmt::format("drive    {:8.3f} V    rms {:.3f} V   peak {:.3f} V{}\n", number("drive_v"),
                     number("drive_rms_v"), number("drive_peak_v"), gain_words(fields));
}

// Of each axis, and the peak: force_x_n, ... Empty without forces.
std::string force_line(const ControlFields& fields) {
  std::string line;
  for (const auto& [name, value] : fields)
    if (const auto* force_n = std::get_if<double>(&value); force_n != nullptr && name.starts_with("force_"))
      line += fmt::format("   {} {:.3f} N", name.substr(6, name.size() - 8), *force_n);
  return line.empty() ? line : "force " + line + "\n";
}

// Of the drive; forces have none.
std::string band_words(const ControlFields& fields) {
  const double band_hz = schema::control_number(fields, "passes_to_hz", NAN);
  return std::isnan(band_hz) ? "" : fmt::format("   band up to {:.4g} Hz", band_hz);
}

// The lines for a `status`, the most important first.
std::string top_screen(const ControlFields& fields) {
  const auto number = [&](std::string_view name) { return schema::control_number(fields, name); };
  std::string text;
  const auto out = std::back_inserter(text);
  // `why` contains the fault, and from protocol 1.2 on also other causes of a state.
  const std::string why = schema::control_text(fields, "why");
  fmt::format_to(out, "{:<8} {}\n", schema::control_text(fields, "state"),
                 why.empty() ? schema::control_text(fields, "fault") : why);
  fmt::format_to(out, "period   {:8.1f} us   round trip {:.2f} ms{}\n", 1e6 * number("period_s"),
                 1e3 * number("round_trip_s"), band_words(fields));
  fmt::format_to(out, "finger   {:8.2f} mm   {:8.1f} mm/s\n", 1e3 * number("position_m"),
                 1e3 * number("speed_mps"));
  const std::string forces = force_line(fields);
  text += forces.empty() ? drive_line(fields) : forces;
  fmt::format_to(out, "ticks    {:8.0f}      late {:.0f}   lost {:.0f}   limited {:.0f}   energy {:.0f}",
                 number("ticks"), number("late_ticks"), number("lost_ticks"), number("limited_ticks"),
                 number("energy_limited_ticks"));
  fmt::format_to(out, "   gated {:.0f}   blind {:.0f}\n", number("gated_ticks"), number("blind_ticks"));
  return text + limits_line(fields) + lateness_lines(fields);
}

// The lines that fit into a terminal of so many rows, each cut to its columns; the last one without a
// newline, so that the terminal does not scroll.
std::string clipped_to(const std::string& text, std::size_t rows, std::size_t columns) {
  std::string clipped;
  for (std::size_t at = 0; at < text.size() && rows > 0; --rows) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    clipped += (clipped.empty() ? "" : "\n") + text.substr(at, std::min(end - at, columns));
    at = end + 1;
  }
  return clipped;
}

constexpr int kEventMs = 500;
constexpr std::array<std::string_view, 14> kCtlActions = {"hello",  "load",   "arm",   "play", "stop",
                                                          "disarm", "gain",   "set",   "move", "raise",
                                                          "mark",   "status", "watch", "top"};

struct CtlOptions {
  std::string socket = kUsualControlSocket, action, what, value;  // value: of set, move
  std::optional<schema::TextureEnds> ends;
  std::optional<double> over_s;  // of set, move
  std::optional<double> at_m, fade_s;
  std::optional<schema::Gain> gain;
  std::optional<double> time_s;
  bool save = false, watch = false;
  schema::PlaybackChoices choices;
};

// A field has the same name for people and programs; it ends in the unit.
void add_fields(Report& report, const ControlFields& fields) {
  for (const auto& [name, value] : fields) {
    if (name == "ok" || name == "id" || name == "event") continue;
    std::visit(
        [&, &key = name](const auto& plain) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(plain)>, std::vector<double>>)
            report.add(key, plain);
        },
        value);
  }
}

// The daemon may run in another folder, so it gets the full path of an existing file.
std::string full_name(const std::string& file) {
  std::error_code ignored;
  for (const char* ending : {"", ".texture.json", ".scene.json"})
    if (std::filesystem::is_regular_file(file + ending, ignored))
      return std::filesystem::absolute(file, ignored).string();
  return file;
}

void put_gain(ControlRequest& request, const schema::Gain& gain) {
  (gain.times_default ? request.times_default : request.gain_m_per_n) = gain.value;
}

Result<void> check_taken(const CtlOptions& o) {
  const auto refuse = [&](const std::string& what, const std::string& who) {
    return schema::fail(schema::ErrorKind::usage, fmt::format("'{}' does not accept '{}'", o.action, what),
                        "command line", who);
  };
  const bool load = o.action == "load", gain = o.action == "gain", set = o.action == "set",
             move = o.action == "move", raise = o.action == "raise", mark = o.action == "mark";
  if (!o.what.empty() && !load && !gain && !set && !move && !raise && !mark)
    return refuse(o.what, "only load, gain, set, move, raise and mark have an argument");
  if (!o.value.empty() && !set && !move) return refuse(o.value, "only set and move have a value");
  if (o.over_s && !set && !move) return refuse("--over", "only set and move accept it");
  const auto missing = [&](const char* what, const char* form) {
    return schema::fail(schema::ErrorKind::usage, fmt::format("{} has no {}", o.action, what), "command line",
                        form);
  };
  if (set && o.value.empty())
    return missing("value",
                   "write 'ctl set PATCH.LAYER.MEMBER VALUE', of a piece 'ctl set PIECE.MEMBER VALUE', with "
                   "a plain number");
  if (move && o.value.empty()) return missing("place", "write 'ctl move PATCH X,Y', as in 10mm,20mm");
  if (raise && o.what.empty()) return missing("patch", "write 'ctl raise PATCH'");
  if (mark && o.what.empty())
    return missing("text", "write 'ctl mark TEXT', for example 'ctl mark \"trial 1\"'");
  for (const auto& [option, given] : {std::pair{"--at", o.at_m.has_value()},
                                      {"--gain", o.gain.has_value()},
                                      {"--ends", o.ends.has_value()},
                                      {"--fade", o.fade_s.has_value()}})
    if (given && !load) return refuse(option, "only load accepts it");
  if (!load && o.choices != schema::PlaybackChoices{})
    return refuse("--interpolation or another playback choice", "only load accepts it");
  if (o.save && !gain) return refuse("--save", "only gain accepts it");
  if (o.watch && o.action != "play") return refuse("--watch", "only play accepts it");
  if (!o.time_s) return {};
  const bool stays = o.watch || o.action == "watch" || o.action == "top";
  if (!stays) return refuse("--time", "only watch, top and play --watch accept it");
  if (!(*o.time_s >= 0)) return refuse("--time below 0", "a time, as in 10s");
  return {};
}

Result<ControlRequest> request_of(const CtlOptions& o) {
  TACTO_TRY(check_taken(o));
  ControlRequest request;
  const auto index = std::ranges::find(kCtlActions, o.action) - kCtlActions.begin();
  request.verb = o.action == "top" ? ControlVerb::watch : static_cast<ControlVerb>(index);
  request.file = request.verb == ControlVerb::load ? full_name(o.what) : "";
  request.at_m = o.at_m;
  if (o.gain) put_gain(request, *o.gain);
  request.fade_s = o.fade_s;
  request.playback = o.choices;
  request.ends = o.ends;
  request.save = o.save;
  request.over_s = o.over_s;
  if (request.verb == ControlVerb::set) {
    const auto value = number_in_text(o.value);
    TACTO_TRY(value);
    request.number = o.what;
    request.value = *value;
  }
  if (request.verb == ControlVerb::move || request.verb == ControlVerb::raise) request.patch = o.what;
  if (request.verb == ControlVerb::mark) request.text = o.what;
  if (request.verb == ControlVerb::move) {
    const auto place = parse_place(o.value);
    TACTO_TRY(place);
    request.x_m = place->x_m, request.y_m = place->y_m;
  }
  if (request.verb != ControlVerb::gain) return request;
  const auto gain = schema::parse_gain(o.what);
  TACTO_TRY(gain);
  put_gain(request, *gain);
  return request;
}

// On a terminal the screen shows the newest status; in a file or pipe they follow each other.
void show_top(const ControlFields& fields) {
  winsize size{};
  if (isatty(STDOUT_FILENO) == 0)
    fmt::print("{}\n", top_screen(fields));
  else if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 && size.ws_col > 0)
    fmt::print("\033[H\033[2J{}", clipped_to(top_screen(fields), size.ws_row, size.ws_col));
  else
    fmt::print("\033[H\033[2J{}", top_screen(fields));
  std::fflush(stdout);
}

// On a terminal the screen of `top`; elsewhere a line on stderr for each change of state.
void show_played(const ControlFields& status, std::string& before) {
  if (isatty(STDOUT_FILENO) != 0) return show_top(status);
  const std::string state = schema::control_text(status, "state"), why = schema::control_text(status, "why");
  if (state != std::exchange(before, state))
    cli::write_message(fmt::format("{}{}{}\n", state, why.empty() ? "" : ": ", why));
}

void show_event(const schema::ControlReply& event, bool top) {
  if (top && event.event == "status") return show_top(event.fields);
  if (top) return;
  fmt::print("{}", schema::control_event_line(event.event, event.fields));
  std::fflush(stdout);
}

// Events come only while the device is armed; otherwise the status is requested.
Result<void> show_top_now(ControlConnection& connection) {
  ControlRequest request;
  request.verb = ControlVerb::status;
  const auto answer = connection.ask(request);
  TACTO_TRY(answer);
  show_top(*answer);
  return {};
}

// Runs until it is interrupted or the time is over. A connection that watches cannot send requests.
Result<Report> watch(ControlConnection& connection, const CtlOptions& o) {
  const cli::StopSignals signals;
  const auto begun = std::chrono::steady_clock::now();
  const auto elapsed_s = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  };
  while (!signals.stop_asked() && (!o.time_s || elapsed_s() < *o.time_s)) {
    const auto event = connection.next_event(kEventMs);
    TACTO_TRY(event);
    if (*event) show_event(**event, o.action == "top");
  }
  return Report();
}

Result<Report> run_ctl(const CtlOptions& o) {
  const auto request = request_of(o);
  TACTO_TRY(request);
  Report report;
  if (request->verb == ControlVerb::stop || request->verb == ControlVerb::disarm) {
    const auto answer = ControlConnection::ask_at_once(o.socket, *request);
    TACTO_TRY(answer);
    add_fields(report, *answer);
    return report;
  }
  auto connection = ControlConnection::open(o.socket);
  TACTO_TRY(connection);
  if (o.watch)
    return watched_play(*connection, o.time_s, [state = std::string()](const ControlFields& status) mutable {
      show_played(status, state);
    });
  if (o.action == "hello") {
    add_fields(report, connection->hello());
    return report;
  }
  if (o.action == "top") TACTO_TRY(show_top_now(*connection));
  const auto answer = connection->ask(*request);
  if (!answer && answer.error().where == "request#/text")
    return schema::fail(schema::ErrorKind::usage, answer.error().what, "TEXT", answer.error().remedy);
  TACTO_TRY(answer);
  if (request->verb == ControlVerb::watch) return watch(*connection, o);
  add_fields(report, *answer);
  return report;
}

cli::Action declare_ctl(CLI::App& app) {
  auto options = std::make_shared<CtlOptions>();
  CtlOptions& o = *options;
  app.add_option_function<std::string>(
         "action",
         [&o](const std::string& word) {
           const std::vector<std::string> words(kCtlActions.begin(), kCtlActions.end());
           o.action = kCtlActions[cli::choose("action", word, words)];
         },
         "load, arm, play, stop, disarm, gain, set, move, raise, mark, status; watch: events as lines of "
         "JSON; "
         "top: live figures")
      ->type_name(cli::words_of({kCtlActions.begin(), kCtlActions.end()}))
      ->required();
  app.add_option(
      "what", o.what,
      "load: a texture or scene; gain: as --gain; set: PATCH.LAYER.MEMBER or PIECE.MEMBER; move, raise: "
      "PATCH; mark: a text for the session");
  app.add_option(
      "value", o.value,
      "set: within the member's slider, in the unit of its name; move: the place X,Y of the patch's "
      "centre, as in 10mm,20mm");
  app.add_option("--socket", o.socket, "Socket of the daemon")->capture_default_str();
  cli::add_quantity(app, "--at", o.at_m, Dimension::length,
                    "load of a texture: encoder position of its position 0");
  cli::add_gain(app, o.gain, "load: ", kDefaultGain);
  declare_ends(app, o.ends, "load: ");
  cli::add_quantity(app, "--fade", o.fade_s, Dimension::time,
                    "load during playback: duration of the change of texture; default: 50ms");
  cli::add_quantity(app, "--over", o.over_s, Dimension::time,
                    "set, move: duration of the change; default: 10ms");
  declare_choices(app, o.choices, "load: ");
  app.add_flag("--save", o.save,
               "gain: also store it in the file of the scene or texture, with user and time");
  app.add_flag("--watch", o.watch,
               "play: arm, play and stay connected; the drive falls when this command ends, for any reason. "
               "Ctrl-C stops");
  cli::add_quantity(app, "--time", o.time_s, Dimension::time, "watch, top, play --watch: duration");
  return [options] { return run_ctl(*options); };
}

}  // namespace

const cli::Verb kCtlVerb{
    "ctl", "Control the daemon: load, arm, play, stop, gain, set, move, raise, mark, status, watch, top",
    "tactograph ctl load oak --at 10mm\n"
    "  tactograph ctl play --watch\n"
    "  tactograph ctl arm && tactograph ctl play\n"
    "  tactograph ctl gain 50%\n"
    "  tactograph ctl load cork --fade 200ms\n"
    "  tactograph ctl set bench.spring.stiffness_n_per_m 300\n"
    "  tactograph ctl move bench 10mm,20mm && tactograph ctl raise bench",
    declare_ctl};

}  // namespace tacto::playback
