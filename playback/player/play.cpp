// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/play.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <span>
#include <utility>
#include <variant>

#include "data-schema/files/files.hpp"
#include "firmware-host/link/wire_device.hpp"
#include "firmware-host/sim/planar/planar_device.hpp"
#include "playback/host-loop/locked_memory.hpp"
#include "playback/player/host_loop_client.hpp"
#include "playback/player/placed_textures.hpp"
#include "playback/player/player_device.hpp"
#include "playback/player/silent_play.hpp"
#include "playback/prepare/scene/acting_load.hpp"
#include "playback/session/session_limits.hpp"

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr int kUsualPriority = 50;  // as in the daemon
constexpr double kUsualS = 10, kPlayStepS = 0.01, kReleaseWaitS = 0.05;

double time_of(const PlayOptions& options) {
  if (options.time_s) return *options.time_s;
  return options.finger_path ? options.finger_path->duration_s() : kUsualS;
}

std::optional<double> rest_from(const std::optional<double>& path_s, double asked_s) {
  constexpr double kRounding = 1 + 1e-9;
  return path_s && asked_s > kRounding * *path_s ? path_s : std::nullopt;
}

Result<void> check_play_options(const std::optional<double>& time_s, const std::string& session) {
  if (time_s && !(*time_s > 0))
    return fail(ErrorKind::usage, fmt::format("the time {:g} s is not above 0", *time_s), {},
                "give a time above 0 s");
  return schema::check_stem(schema::stem_of("/" + session, ".session").substr(1));
}

Result<std::string> transducer_for(const PlayOptions& options, const firmware_host::Capabilities& about) {
  if (!options.transducer.empty()) return options.transducer;
  if (about.transducer) return about.transducer_file;
  return fail(ErrorKind::usage, "the device does not report its transducer", about.uri,
              "name it with --transducer");
}

Result<Program> program_for(const PlayOptions& options, const PlayerDevice& device,
                            const HostLoopClient& here, double metres_per_count) {
  const auto transducer = transducer_for(options, device.device->capabilities());
  TACTO_TRY(transducer);
  PrepareOptions prepare = options.prepare;
  prepare.metres_per_count = metres_per_count;
  const firmware_host::Client& plays = here ? *here.client : *device.client;
  prepare.most_samples = plays.description().welcome.profile_samples;
  if (here) prepare.loop_delay_s = here.loop->delay_s();
  return make_program(options.program, *transducer, prepare);
}

// Seconds of ticks since arming.
struct PlayTime {
  double from_s = 0, to_s = 0;
};

// Commands are sent between messages of ticks, at most this many, because a device holds 16 until a tick.
constexpr std::size_t kMostCommandsAtOnce = 8;

// Sends the commands that are due.
Result<void> follow_script(Player& player, double played_s, std::span<const TimedSceneCommand>& script) {
  for (std::size_t i = 0; i < kMostCommandsAtOnce; ++i) {
    if (script.empty() || script.front().time_s > played_s) return {};
    TACTO_TRY(player.change_scene(script.front().command));
    script = script.subspan(1);
  }
  return {};
}

using Steer = std::function<Result<bool>(Player& player, double played_s)>;

using Watch = std::function<void(Player& player, double played_s)>;

Result<void> run_until(Player& player, const PlayTime& time, std::span<const TimedSceneCommand> script,
                       const Steer& steer, const Watch& watch, const std::function<bool()>& stop_asked,
                       const std::function<void(double)>& progress) {
  while (player.armed_s() < time.to_s && !stop_asked()) {
    TACTO_TRY(follow_script(player, player.armed_s() - time.from_s, script));
    if (const auto done = player.step(kPlayStepS); !done) return done;
    if (player.state() == PlayerState::fault) break;
    if (watch) watch(player, player.armed_s() - time.from_s);
    if (steer) {
      const auto goes_on = steer(player, player.armed_s() - time.from_s);
      TACTO_TRY(goes_on);
      if (!*goes_on) break;
    }
    if (progress) progress(std::max(0.0, (player.armed_s() - time.from_s) / (time.to_s - time.from_s)));
  }
  return {};
}

// If this computer closes the loop, the path begins now and reaches the tray after the loop's delay.
PlayTime begin_path(const Player& player, const PlayerDevice& device, const HostLoopClient& here,
                    double time_s, bool waited) {
  if (!device.begin_path && !waited) return {0, time_s};
  if (device.begin_path) device.begin_path();
  const double from_s = player.armed_s() + (here ? here.loop->delay_s() : 0);
  return {from_s, from_s + time_s};
}

// The ramp is recorded in the session.
Result<void> ramp_down(Player& player) {
  if (const auto stopped = player.stop(); !stopped) return stopped;
  const double until_s = player.armed_s() + kReleaseWaitS;
  while (player.armed_s() < until_s)
    if (const auto done = player.step(kPlayStepS); !done) return done;
  return {};
}

PlayOutcome outcome_of(const Program& program) {
  const Prepared& made = program.prepared;
  PlayOutcome outcome;
  outcome.decision = program.decision;
  outcome.passes_to_hz = made.passes_to_hz;
  outcome.delay_s = made.delay_s;
  outcome.delay_left_s = made.delay_left_s;
  outcome.inverse_error_db = made.inverse_error_db;
  outcome.loop_period_m = made.loop_period_m, outcome.loop_seam_m = made.loop_seam_m;
  outcome.notes = made.notes;
  outcome.gain_m_per_n = program.gain_m_per_n;
  outcome.default_gain_m_per_n = program.default_gain_m_per_n;
  outcome.kept_gain = program.kept_gain;
  outcome.choices = choices_in(program.options);
  return outcome;
}

using SteadyClock = std::chrono::steady_clock;

// The device, loop and player of one playback.
struct Playing {
  const PlayerDevice& device;
  const HostLoopClient& here;
  Player& player;
  std::span<const TimedSceneCommand> script = {};
  std::optional<SteadyClock::time_point> begins_at = std::nullopt;
  Steer steer = {};
  Watch watch = {};
};

double seconds_to(SteadyClock::time_point when) {
  return std::chrono::duration<double>(when - SteadyClock::now()).count();
}

// Waits armed, as the device then has the texture; how much later than asked it is then.
Result<double> wait_for_begin(const Playing& playing, const std::function<bool()>& stop_asked) {
  if (!playing.begins_at || !playing.device.device->is_real_time()) return 0.0;
  for (double left_s = seconds_to(*playing.begins_at); left_s > 0 && !stop_asked();
       left_s = seconds_to(*playing.begins_at)) {
    TACTO_TRY(playing.player.step(std::min(left_s, kPlayStepS)));
    if (playing.player.state() == PlayerState::fault) break;
    if (playing.watch) playing.watch(playing.player, -left_s);
  }
  return std::max(0.0, -seconds_to(*playing.begins_at));
}

// Precondition: the program is loaded.
Result<void> play_through(const Playing& playing, const std::string& session,
                          const std::function<bool()>& stop_asked,
                          const std::function<void(double)>& progress, PlayOutcome& outcome) {
  Player& player = playing.player;
  outcome.device = playing.device.uri;
  outcome.real_time = playing.device.device->is_real_time();
  outcome.simulated = firmware_host::simulated_device(playing.device.client->description());
  TACTO_TRY(player.arm(session));
  const auto late_s = wait_for_begin(playing, stop_asked);
  TACTO_TRY(late_s);
  outcome.late_s = *late_s;
  if (player.state() != PlayerState::fault) {  // one while it waited is in the outcome, as one while it plays
    TACTO_TRY(player.play());
    const PlayTime time =
        begin_path(player, playing.device, playing.here, outcome.asked_s, playing.begins_at.has_value());
    TACTO_TRY(run_until(player, time, playing.script, playing.steer, playing.watch, stop_asked, progress));
  }
  outcome.status = player.status();
  if (player.state() != PlayerState::fault) TACTO_TRY(ramp_down(player));
  TACTO_TRY(player.disarm());
  outcome.status.ticks = player.status().ticks;  // all that the session has
  outcome.recorder = player.last_session();
  return {};
}

void tell_limits(const std::string& session, PlayOutcome& outcome) {
  const auto tally = tally_session(session);
  if (tally) outcome.limits = *tally;
  if (!tally) outcome.notes.push_back(schema::message(tally.error()));
}

// The loop needs a device that keeps time: emulated time as fast as possible is too fast for a real-time
// thread.
Result<HostLoopClient> loop_of(const PlayOptions& options, PlayerDevice& device,
                               PlayerOptions& player_options) {
  if (!options.loop_here) return HostLoopClient{};
  if (!device.device->is_real_time())
    return fail(ErrorKind::usage, "the loop on this computer needs a device that runs in real time",
                device.uri, "add paced=1 (-d sim:paced=1)");
  const HostLoopOptions loop{options.prepare.rate_hz, kUsualPriority, options.prepare.watchdog_ms};
  return close_loop_on_host(*device.client, device.uri, loop, player_options);
}

HostLoopFigures looped_by(const HostLoop& loop) {
  return {loop.latency(), loop.delay_s(), loop.status().missed_ticks};
}

Result<std::vector<TimedSceneCommand>> script_for(const std::string& file, const ForceProgram& forces,
                                                  double time_s) {
  if (file.empty()) return std::vector<TimedSceneCommand>();
  auto script = read_scene_script(file, forces);
  TACTO_TRY(script);
  if (script->back().time_s < time_s) return script;
  return fail(ErrorKind::malformed,
              fmt::format("its last command is at {:g} s, but the playback ends at {:g} s",
                          script->back().time_s, time_s),
              file, "play longer, with --time");
}

// Of each patch the first one.
void note_moves(const std::vector<TimedSceneCommand>& script, std::vector<std::string>& notes) {
  std::set<std::uint16_t> noted;
  for (const auto& [time_s, command] : script) {
    const auto* const move = std::get_if<wire::Move>(&command.message);
    if (move != nullptr && !command.note.empty() && noted.insert(move->patch).second)
      notes.push_back(fmt::format("from {:g} s on {}", time_s, command.note));
  }
}

}  // namespace

Result<PlayOutcome> play_once(const PlayOptions& options, const std::function<bool()>& stop_asked,
                              const std::function<void(double)>& progress) {
  TACTO_TRY(check_play_options(options.time_s, options.session));
  std::optional<FingerScript> script;
  // The emulated finger moves from the stream's beginning on. With this computer's loop that is before the
  // loop's delay is measured, so the finger waits; as it does for a beginning at a certain time.
  if (options.finger_path)
    script = FingerScript{*options.finger_path, options.path_repeated,
                          options.loop_here || options.begins_at.has_value()};
  auto device = open_player_device(options.device_uri, script, options.without_watchdog);
  TACTO_TRY(device);
  PlayerOptions player_options;
  player_options.full_queue = device->full_queue();
  player_options.follow_force = options.follow_force;
  if (options.without_watchdog)
    player_options.note = "--no-watchdog: the card keeps its last voltage if the program dies";
  const auto here = loop_of(options, *device, player_options);
  TACTO_TRY(here);
  const auto player = Player::make(*here ? *here->client : *device->client, device->uri, player_options);
  TACTO_TRY(player);
  TACTO_TRY((*player)->may_load(false));
  auto program = program_for(options, *device, *here, (*player)->metres_per_count());
  TACTO_TRY(program);
  PlayOutcome outcome = outcome_of(*program);
  const PlayableRange what = playable_range(*program);
  outcome.asked_s = time_of(options);
  if (options.finger_path && !options.path_repeated)
    outcome.rests_from_s = rest_from(options.finger_path->duration_s(), outcome.asked_s);
  TACTO_TRY((*player)->load(std::move(*program)));
  TACTO_TRY((*player)->gain(options.gain));
  if (device->device->is_real_time()) lock_memory();  // a real-time thread of this process may tick
  const Playing playing{*device, *here, **player, {}, options.begins_at, options.steer, options.watch};
  TACTO_TRY(play_through(playing, options.session, stop_asked, progress, outcome));
  if (*here) outcome.looped = looped_by(*here->loop);
  tell_limits(options.session, outcome);
  if (auto silence = note_of_silence(outcome.status.ticks, what))
    outcome.notes.push_back(std::move(*silence));
  else
    outcome.off_note = note_off_textures(outcome.status.ticks, what);
  return outcome;
}

bool plays_forces(const std::string& what, const std::string& device_uri) {
  if (firmware_host::is_planar(device_uri)) return true;
  if (!names_a_scene(what)) return false;
  const auto scene = schema::read_scene(what);
  return scene && (!scene->patches.empty() || !scene->pieces.empty());
}

Result<PlayOutcome> play_forces_once(const ForcePlayOptions& options, const std::function<bool()>& stop_asked,
                                     const std::function<void(double)>& progress) {
  TACTO_TRY(check_play_options(options.time_s, options.session));
  const auto device = open_force_device(options.device_uri, options.path);
  TACTO_TRY(device);
  firmware_host::Client& client = *device->player.client;
  auto program = make_force_program(options.program, device->about, device->hand, *client.description().axes);
  TACTO_TRY(program);
  PlayerOptions player_options;
  player_options.full_queue = device->player.full_queue();
  const auto player = Player::make(client, device->player.uri, player_options);
  TACTO_TRY(player);
  PlayOutcome outcome;
  outcome.notes = program->notes;
  outcome.held = program->held;
  outcome.not_judged = not_held_layers(program->scene.patches);
  outcome.asked_s = options.time_s.value_or(device->path_s.value_or(kUsualS));
  outcome.rests_from_s = rest_from(device->path_s, outcome.asked_s);
  const auto script = script_for(options.script, *program, outcome.asked_s);
  TACTO_TRY(script);
  note_moves(*script, outcome.notes);
  TACTO_TRY((*player)->load(std::move(*program)));
  const Playing playing{device->player, {}, **player, *script};
  TACTO_TRY(play_through(playing, options.session, stop_asked, progress, outcome));
  return outcome;
}

}  // namespace tacto::playback
