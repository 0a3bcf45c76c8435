// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "data-schema/cli/stop_signals.hpp"
#include "playback/cli/choice_options.hpp"
#include "playback/cli/ends_option.hpp"
#include "playback/cli/verbs.hpp"
#include "playback/daemon/control_connection.hpp"
#include "playback/daemon/time_histogram.hpp"

namespace tacto::playback {

using cli::Report;
using schema::ControlFields;
using schema::ControlRequest;
using schema::ControlVerb;
using schema::Dimension;
using schema::Result;

namespace {

constexpr const char* kUsualSocket = "/run/tactographd/control";
constexpr int kEventMs = 500;
constexpr std::array<std::string_view, 10> kCtlActions = {"hello",  "load", "arm",    "play",  "stop",
                                                          "disarm", "gain", "status", "watch", "top"};

struct CtlOptions {
  std::string socket = kUsualSocket, action, what;
  std::optional<schema::TextureEnds> ends;
  std::optional<double> at_m, gain_m_per_n, fade_s;
  std::optional<double> time_s;
  bool save = false;
  schema::PlaybackChoices choices;
};

// What a field is for people and machines alike: its key says the unit.
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

// The daemon may run in another folder: what is here is named in full.
std::string full_name(const std::string& file) {
  std::error_code ignored;
  for (const char* ending : {"", ".texture.json", ".scene.json"})
    if (std::filesystem::is_regular_file(file + ending, ignored))
      return std::filesystem::absolute(file, ignored).string();
  return file;
}

Result<double> gain_in(const std::string& text) {
  const auto gain = schema::parse_quantity(text, Dimension::none);
  if (gain) return *gain;
  return schema::fail(schema::Fault::usage, fmt::format("'{}' is no gain", text), "gain",
                      "a factor, as in 0.5");
}

Result<ControlRequest> request_of(const CtlOptions& o) {
  if (!o.what.empty() && o.action != "load" && o.action != "gain")
    return schema::fail(schema::Fault::usage, fmt::format("'{}' takes no '{}'", o.action, o.what),
                        "command line", "only load and gain are told what");
  ControlRequest request;
  const auto index = std::ranges::find(kCtlActions, o.action) - kCtlActions.begin();
  request.verb = o.action == "top" ? ControlVerb::watch : static_cast<ControlVerb>(index);
  request.file = request.verb == ControlVerb::load ? full_name(o.what) : "";
  request.at_m = o.at_m;
  request.gain_m_per_n = o.gain_m_per_n;
  request.fade_s = o.fade_s;
  request.playback = o.choices;
  request.ends = o.ends;
  request.save = o.save;
  if (request.verb != ControlVerb::gain) return request;
  const auto gain = gain_in(o.what);
  if (!gain) return schema::forward_error(gain);
  request.gain = *gain;
  return request;
}

// The parts between the bounds that the status has, as bars: one sign is 2 %, and what is rare shows as a
// dot.
void show_lateness(const ControlFields& fields) {
  const auto number = [&](std::string_view name) { return schema::control_number(fields, name); };
  fmt::print("late by  p50 {:.1f}  p99 {:.1f}  p99.9 {:.1f} us   busy p99 {:.2f} us\n",
             1e6 * number("wake_p50_s"), 1e6 * number("wake_p99_s"), 1e6 * number("wake_p999_s"),
             1e6 * number("busy_p99_s"));
  double beyond_lower = 1;
  const auto show = [&](const std::string& name, double beyond_upper) {
    const double part = std::max(beyond_lower - beyond_upper, 0.0);
    const auto signs = static_cast<std::size_t>(50 * part);
    fmt::print("  {:<8} {:7.3f} % {}\n", name, 100 * part,
               signs > 0  ? std::string(signs, '#')
               : part > 0 ? "."
                          : "");
    beyond_lower = beyond_upper;
  };
  for (const double bound_s : kLateBoundsS)
    show(fmt::format("< {:g} us", 1e6 * bound_s), number(late_part_name(bound_s)));
  show("more", 0);
  fmt::print("edge to drive  p50 {:.2f}  p99 {:.2f} ms, looked ahead by {:.2f} ms\n",
             1e3 * number("latency_p50_s"), 1e3 * number("latency_p99_s"), 1e3 * number("looked_ahead_s"));
}

// A limited tick is counted a little before it is told what was taken of it.
std::string words_of_taken(const ControlFields& fields) {
  if (const std::string unknown = schema::control_text(fields, "limits_took"); !unknown.empty())
    return unknown;
  const double all_db = schema::control_number(fields, "limits_took_db", NAN);
  const double second_db = schema::control_number(fields, "limits_took_last_second_db", NAN);
  if (std::isnan(all_db)) return "not told yet";
  return fmt::format("{} in the last second, {:.1f} dB since arming",
                     std::isnan(second_db) ? "nothing" : fmt::format("{:.1f} dB", second_db), all_db);
}

// Of the wished drive, as RMS; by stroke the command tells it.
void show_limits(const ControlFields& fields) {
  const std::string tells = schema::control_text(fields, "limits_in_db");
  if (!tells.empty()) fmt::print("limits   took {}   by stroke: {}\n", words_of_taken(fields), tells);
}

void show_top(const ControlFields& fields) {
  const auto number = [&](std::string_view name) { return schema::control_number(fields, name); };
  fmt::print("\033[H\033[2J{:<8} {}\n", schema::control_text(fields, "state"),
             schema::control_text(fields, "fault"));
  fmt::print("period   {:8.1f} us   round trip {:.2f} ms   band up to {:.4g} Hz\n", 1e6 * number("period_s"),
             1e3 * number("round_trip_s"), number("passes_to_hz"));
  fmt::print("finger   {:8.2f} mm   {:8.1f} mm/s\n", 1e3 * number("position_m"), 1e3 * number("speed_mps"));
  fmt::print("drive    {:8.3f} V    rms {:.3f} V   peak {:.3f} V   gain {:g}\n", number("drive_v"),
             number("drive_rms_v"), number("drive_peak_v"), number("gain"));
  fmt::print(
      "ticks    {:8.0f}      late {:.0f}   lost {:.0f}   limited {:.0f}   energy {:.0f}   gated {:.0f}   "
      "blind "
      "{:.0f}\n",
      number("ticks"), number("late_ticks"), number("lost_ticks"), number("limited_ticks"),
      number("energy_limited_ticks"), number("gated_ticks"), number("blind_ticks"));
  show_limits(fields);
  if (number("wake_p99_s") > 0) show_lateness(fields);
  std::fflush(stdout);
}

void show_event(const schema::ControlReply& event, bool top) {
  if (top && event.event == "status") return show_top(event.fields);
  if (top) return;
  fmt::print("{}", schema::control_event_line(event.event, event.fields));
  std::fflush(stdout);
}

// Events come as long as something is armed: how it stands without one is asked.
Result<void> show_top_now(ControlConnection& connection) {
  ControlRequest request;
  request.verb = ControlVerb::status;
  const auto answer = connection.ask(request);
  if (!answer) return schema::forward_error(answer);
  show_top(*answer);
  return {};
}

// Until it is interrupted, or the time is over: nothing can be asked meanwhile.
Result<Report> watch(ControlConnection& connection, const CtlOptions& o) {
  const cli::StopSignals signals;
  const auto begun = std::chrono::steady_clock::now();
  const auto elapsed_s = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  };
  while (!signals.stop_asked() && (!o.time_s || elapsed_s() < *o.time_s)) {
    const auto event = connection.next_event(kEventMs);
    if (!event) return schema::forward_error(event);
    if (*event) show_event(**event, o.action == "top");
  }
  return Report();
}

Result<Report> run_ctl(const CtlOptions& o) {
  const auto request = request_of(o);
  if (!request) return schema::forward_error(request);
  auto connection = ControlConnection::open(o.socket);
  if (!connection) return schema::forward_error(connection);
  Report report;
  if (o.action == "hello") {
    add_fields(report, connection->hello());
    return report;
  }
  if (o.action == "top")
    if (const auto shown = show_top_now(*connection); !shown) return schema::forward_error(shown);
  const auto answer = connection->ask(*request);
  if (!answer) return schema::forward_error(answer);
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
         "load, arm, play, stop, disarm, gain, status; watch: events as lines of JSON; top: live figures")
      ->required();
  app.add_option("what", o.what, "load: a texture or scene; gain: a factor");
  app.add_option("--socket", o.socket, "The daemon's")->capture_default_str();
  cli::add_quantity(app, "--at", o.at_m, Dimension::length, "load of a texture: where its position 0 lies");
  cli::add_quantity(app, "--gain", o.gain_m_per_n, Dimension::compliance,
                    "load of a texture: displacement for force");
  declare_ends(app, o.ends, "load: ");
  cli::add_quantity(app, "--fade", o.fade_s, Dimension::time,
                    "load while one plays: how long the change takes, 50ms unless told");
  declare_choices(app, o.choices, "load: ");
  app.add_flag("--save", o.save, "gain: also into the file of the scene or texture, with who and when");
  cli::add_quantity(app, "--time", o.time_s, Dimension::time, "watch, top: how long");
  return [options] { return run_ctl(*options); };
}

}  // namespace

const cli::Verb kCtlVerb{"ctl", "Steer the daemon: load, arm, play, stop, gain, status, watch, top",
                         "tactograph ctl load oak --at 10mm\n"
                         "  tactograph ctl arm && tactograph ctl play\n"
                         "  tactograph ctl gain 0.5\n"
                         "  tactograph ctl load cork --fade 200ms",
                         declare_ctl};

}  // namespace tacto::playback
