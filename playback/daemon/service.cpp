// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/control/control.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/scene/scene.hpp"
#include "data-schema/version.hpp"
#include "firmware-host/sim/planar/planar_device.hpp"
#include "playback/control/stay_watch.hpp"
#include "playback/host-loop/host_loop.hpp"
#include "playback/host-loop/locked_memory.hpp"
#include "playback/model/gain_sign.hpp"
#include "playback/player/flight_recorder.hpp"
#include "playback/player/play.hpp"
#include "playback/player/player.hpp"
#include "playback/player/program.hpp"
#include "playback/player/served_folder.hpp"
#include "playback/player/session_name.hpp"

namespace tacto::playback {

using schema::ControlFields;
using schema::ControlRequest;
using schema::ControlVerb;
using schema::ErrorKind;
using schema::fail;
using schema::Result;
namespace fs = std::filesystem;

namespace {

// `not_recorded`: ticks that are missing in the session; they are counted as lost.
void add_ticks(ControlFields& fields, const TickView& view, std::uint64_t not_recorded) {
  const auto count = [](std::uint64_t n) { return static_cast<std::int64_t>(n); };
  fields.emplace_back("ticks", count(view.ticks()));
  fields.emplace_back("lost_ticks", count(view.lost() + not_recorded));
  fields.emplace_back("late_ticks", count(view.late()));
  fields.emplace_back("limited_ticks", count(view.limited()));
  fields.emplace_back("energy_limited_ticks", count(view.energy_limited()));
  fields.emplace_back("gated_ticks", count(view.gated()));
  fields.emplace_back("blind_ticks", count(view.blind()));
  fields.emplace_back("played_s", view.playing_s());
  fields.emplace_back("armed_s", view.span_s());
  fields.emplace_back("device_s", 1e-9 * static_cast<double>(view.last().time_ns));
  fields.emplace_back("encoder_count", std::int64_t{view.last().encoder});
  fields.emplace_back("position_m", view.position_m());
  fields.emplace_back("speed_mps", view.speed_mps());
  fields.emplace_back("drive_v", double{view.last().drive_v});
  fields.emplace_back("drive_rms_v", view.drive_rms_v());
  fields.emplace_back("drive_peak_v", view.drive_peak_v());
}

// Of a scene of forces: place and force of each axis.
void add_forces(ControlFields& fields, const TickView& view, const schema::SessionForces& forces) {
  for (std::size_t i = 0; i < forces.axes.size(); ++i) {
    const schema::DeviceAxis& axis = forces.axes[i];
    fields.emplace_back(axis.name + "_m", view.last().counts[i] * axis.encoder_step_m);
    fields.emplace_back("force_" + axis.name + "_n", double{view.last().force_n[i]});
  }
  fields.emplace_back("force_peak_n", view.force_peak_n());
}

// If the device's flags report limited ticks: what the limits removed, in dB, live, or why it is unknown;
// and the command that reports it for each stroke.
void add_limits(ControlFields& fields, const PlayerStatus& status) {
  if (status.ticks.limited() + status.ticks.energy_limited() == 0) return;
  const LimitsTook& took = status.limits;
  if (took.db) fields.emplace_back("limits_took_db", *took.db);
  if (took.last_second_db) fields.emplace_back("limits_took_last_second_db", *took.last_second_db);
  if (!took.unknown.empty()) fields.emplace_back("limits_took", "unknown: " + took.unknown);
  if (!status.session.empty()) fields.emplace_back("limits_in_db", "tactograph session " + status.session);
}

// The clients that have to stay, if requested.
void add_stay(ControlFields& fields, const StayRules& rules) {
  if (rules.client) fields.emplace_back("while_connected", true);
  if (rules.dead_man_s) fields.emplace_back("dead_man_s", *rules.dead_man_s);
}

void add_recorder(ControlFields& fields, const RecorderCounts& counts) {
  fields.emplace_back("recorded_ticks", static_cast<std::int64_t>(counts.ticks));
  fields.emplace_back("recorder_lost_ticks", static_cast<std::int64_t>(counts.lost()));
  if (!counts.failure.empty()) fields.emplace_back("recorder_failure", counts.failure);
}

void add_loop(ControlFields& fields, const HostLoopStatus& loop) {
  fields.emplace_back("wake_p50_s", loop.wake_p50_s);
  fields.emplace_back("wake_p99_s", loop.wake_p99_s);
  fields.emplace_back("wake_p999_s", loop.wake_p999_s);
  fields.emplace_back("busy_p99_s", loop.busy_p99_s);
  for (std::size_t i = 0; i < kLateBoundsS.size(); ++i)
    fields.emplace_back(late_part_name(kLateBoundsS[i]), loop.late_parts[i]);
  fields.emplace_back("looked_ahead_s", loop.looked_ahead_s);
  fields.emplace_back("latency_p50_s", loop.latency.p50_s);
  fields.emplace_back("latency_p99_s", loop.latency.p99_s);
  fields.emplace_back("missed_ticks", static_cast<std::int64_t>(loop.missed_ticks));
  fields.emplace_back("stale_drives", static_cast<std::int64_t>(loop.stale_drives));
  fields.emplace_back("trimmed_drives", static_cast<std::int64_t>(loop.trimmed_drives));
  fields.emplace_back("real_time", loop.real_time);
  if (!loop.device_fault.empty()) fields.emplace_back("device_fault", loop.device_fault);
}

constexpr double kStatusEveryS = 0.1, kTicksEveryS = 0.02;
constexpr double kLeastSaved = 1e-6;  // of a gain; one below it, or above its inverse, is a mistake
constexpr double kObeyedS = 0.2, kLookS = 0.01;  // a device's ticks come every 10 ms, and a ramp takes 20 ms

// An emulated device follows the clock, so that clients can watch and control it.
std::string paced(const std::string& uri) {
  if (!uri.starts_with("sim:") || uri.find("paced=") != std::string::npos) return uri;
  return uri + (uri == "sim:" ? "paced=1" : ",paced=1");
}

void add_decision(ControlFields& fields, const TickDecision& decision) {
  fields.emplace_back("chosen", words_of(decision.chosen));
  fields.emplace_back(decision.promised ? "guaranteed_error" : "least_error", decision.chosen.error);
  fields.emplace_back("tick_s", 1e-9 * decision.chosen.tick_ns);
  fields.emplace_back("by_table", decision.table);
  for (std::size_t i = 0; i < decision.reasons.size(); ++i)
    fields.emplace_back(fmt::format("why_{}", i + 1), decision.reasons[i]);
}

void add_choices(ControlFields& fields, const schema::PlaybackChoices& choices) {
  for (const auto& [name, member] : schema::kChosenWords)
    if (choices.*member) fields.emplace_back(name, *(choices.*member));
  for (const auto& [name, member] : schema::kChosenNumbers)
    if (choices.*member) fields.emplace_back(name, *(choices.*member));
}

void add_loop(ControlFields& fields, double period_m, double seam_m) {
  if (!(period_m > 0)) return;
  fields.emplace_back("loop_period_m", period_m);
  fields.emplace_back("loop_seam_m", seam_m);
}

void add_inversion(ControlFields& fields, double gain) {
  tell_inversion(gain, [&](const char* key, bool value) { fields.emplace_back(key, value); });
}

std::optional<schema::Gain> gain_of(const ControlRequest& request) {
  if (request.times_default) return schema::Gain{*request.times_default, true};
  return request.gain_m_per_n ? std::optional(schema::Gain{*request.gain_m_per_n, false}) : std::nullopt;
}

ControlFields fields_of(const std::string& file, const Program& program) {
  const Prepared& made = program.prepared;
  ControlFields fields{{"file", file},
                       {"length_m", program.length_m},
                       {"gain_m_per_n", program.gain_m_per_n},
                       {"rate_hz", made.rate_hz},
                       {"passes_to_hz", made.passes_to_hz},
                       {"delay_s", made.delay_s},
                       {"delay_left_s", made.delay_left_s},
                       {"inverse_error_db", made.inverse_error_db}};
  fields.emplace_back("default_gain_m_per_n", program.default_gain_m_per_n);
  add_inversion(fields, program.gain_m_per_n);
  add_loop(fields, made.loop_period_m, made.loop_seam_m);
  if (program.kept_gain) {
    fields.emplace_back("gain_set_by", program.kept_gain->who);
    fields.emplace_back("gain_set_on", program.kept_gain->when);
  }
  add_choices(fields, choices_in(program.options));
  if (program.decision) add_decision(fields, *program.decision);
  for (std::size_t i = 0; i < made.notes.size(); ++i)
    fields.emplace_back(fmt::format("note_{}", i + 1), made.notes[i]);
  return fields;
}

}  // namespace

Result<std::unique_ptr<Service>> Service::open(const schema::DaemonConfig& config, Publish publish) {
  std::unique_ptr<Service> service(new Service(config, std::move(publish)));
  std::error_code failed;
  fs::create_directories(config.sessions, failed);
  if (failed) return fail(ErrorKind::cannot_write, "can't be made: " + failed.message(), config.sessions);
  if (!config.files.empty() && !fs::is_directory(config.files, failed))
    return fail(ErrorKind::not_found, "this folder does not exist", config.files,
                "name an existing folder in files, or omit files");
  TACTO_TRY(schema::read_transducer(config.transducer));
  TACTO_TRY(service->connect());
  return service;
}

Result<PlayerDevice> Service::open_device() {
  const std::string uri = paced(config_.device);
  if (firmware_host::is_planar(uri)) {
    auto opened = open_force_device(uri, config_.finger_path, true);
    TACTO_TRY(opened);
    force_device_ = std::move(opened->about), force_hand_ = std::move(opened->hand);
    return std::move(opened->player);
  }
  const auto script = read_finger_script(config_.finger_path);
  TACTO_TRY(script);
  auto opened = open_player_device(uri, *script);
  TACTO_TRY(opened);
  if (const auto& about = opened->client->description(); about.axes) force_device_ = device_of(about);
  return opened;
}

Result<void> Service::connect() {
  player_.reset();
  here_.client.reset();
  here_.loop.reset();
  device_ = {};
  force_device_.reset();
  auto device = open_device();
  TACTO_TRY(device);
  PlayerOptions player_options;
  player_options.heartbeat_s = 1e-3 * config_.watchdog_ms / 4;
  player_options.tell_limits = true;
  player_options.most_late = 1e-2 * config_.most_late_percent;
  device_ = std::move(*device);
  player_options.full_queue = device_.full_queue();
  if (config_.loop == "host") {
    const HostLoopOptions loop{config_.rate_hz, config_.real_time_priority,
                               static_cast<std::uint16_t>(config_.watchdog_ms)};
    auto here = close_loop_on_host(*device_.client, device_.uri, loop, player_options);
    TACTO_TRY(here);
    here_ = std::move(*here);
  }
  auto player = Player::make(client(), device_.uri, player_options);
  TACTO_TRY(player);
  player_ = std::move(*player);
  player_->listen([this](PlayerState state, const std::string& why, double device_s) {
    why_ = why;
    publish_("state", {{"state", std::string(to_string(state))}, {"why", why}, {"device_s", device_s}});
  });
  player_->listen_to_ticks([this](const schema::SessionTick& tick) { ticks_.take(tick); });
  return {};
}

PrepareOptions Service::options() {
  PrepareOptions options;
  options.rate_hz = config_.rate_hz;
  options.metres_per_count = player_->metres_per_count();
  options.undo_hysteresis = config_.undo_hysteresis;
  options.onset_s = config_.onset_s;
  options.watchdog_ms = static_cast<std::uint16_t>(config_.watchdog_ms);
  options.jump_mps = config_.most_speed_mps;
  options.most_samples = client().description().welcome.profile_samples;
  if (here_) options.loop_delay_s = here_.loop->delay_s();
  return options;
}

// During playback the filter cannot change, because the device has one filter for both textures.
TickBudget Service::budget() const {
  TickBudget budget{config_.budget, config_.max_tick_ns, false, false, {}};
  if (player_->state() != PlayerState::idle) budget.filter = filter_;
  return budget;
}

std::string Service::resolved(const std::string& file) const {
  return config_.files.empty() ? file : (fs::path(config_.files) / file).string();
}

// For clients with another working folder.
std::string Service::full_name(const std::string& file) const {
  std::error_code ignored;
  return fs::absolute(resolved(file), ignored).lexically_normal().string();
}

Result<void> Service::may_begin(const char* what) const {
  if (!loader_.target()) return {};
  return fail(ErrorKind::usage, fmt::format("can't {} while a texture is being prepared", what),
              load_request_.file, "wait for the answer to that load");
}

// A lost device may be connected again, so a load searches for it.
Result<void> Service::begin_load(const ControlRequest& request) {
  if (const auto may = may_begin("load"); !may) return may;
  if (player_->state() == PlayerState::lost)
    if (const auto connected = connect(); !connected) return connected;
  load_request_ = request;
  const auto file =
      request.by_tcp ? served_file(config_.files, request.file) : Result<std::string>(resolved(request.file));
  TACTO_TRY(file);
  const bool forces = force_device_ && plays_forces(*file, device_.uri);
  if (const auto may = player_->may_load(forces); !may) return may;
  if (forces) return begin_load_of_forces(request);
  ProgramRequest target{resolved(request.file), request.at_m, request.ends, gain_of(request)};
  target.only_in = request.by_tcp ? std::optional(config_.files) : std::nullopt;
  if (request.by_tcp) target.file = request.file;
  target.budget = budget();
  target.choices = request.playback;
  target.defaults = config_.playback;
  const bool idle = player_->state() == PlayerState::idle;
  loader_.begin(
      [target, transducer = config_.transducer, options = options()]() -> Result<AnyProgram> {
        return make_program(target, transducer, options);
      },
      idle ? ProgramLoader::Beside::nothing : ProgramLoader::Beside::playing);
  return {};
}

Result<void> Service::begin_load_of_forces(const ControlRequest& request) {
  if (request.at_m || request.ends || gain_of(request) || request.fade_s ||
      request.playback != schema::PlaybackChoices{})
    return fail(ErrorKind::usage, "a scene of forces has no place, ends, gain, fade or playback choices",
                request.file, "send only its file");
  ForceRequest target{request.by_tcp ? request.file : resolved(request.file),
                      {},
                      config_.onset_s,
                      static_cast<std::uint16_t>(config_.watchdog_ms),
                      {}};
  if (request.by_tcp) target.only_in = config_.files;
  loader_.begin([target, device = *force_device_, hand = force_hand_, own = *client().description().axes]()
                    -> Result<AnyProgram> { return make_force_program(target, device, hand, own); },
                ProgramLoader::Beside::nothing);
  return {};
}

std::optional<Result<ControlFields>> Service::finished_load() {
  auto program = loader_.take();
  if (!program) return std::nullopt;
  if (!*program) return schema::forward_error(*program);
  if (auto* const forces = std::get_if<ForceProgram>(&**program)) return load(std::move(*forces));
  return load(std::get<Program>(std::move(**program)));
}

Result<ControlFields> Service::load(Program program) {
  const std::string& file = load_request_.file;
  ControlFields fields = fields_of(file, program);
  const std::string scene_path = program.scene_path;
  const double passes_to_hz = program.prepared.passes_to_hz;
  const double gain_m_per_n = program.gain_m_per_n, default_m_per_n = program.default_gain_m_per_n;
  const double period_m = program.prepared.loop_period_m, seam_m = program.prepared.loop_seam_m;
  const double start_m = program.start_m, length_m = program.length_m;
  const schema::SessionTexture alone = program.session.textures.front();
  const auto filter = program.decision ? std::optional(program.decision->chosen.inverse) : std::nullopt;
  const bool changes = player_->state() != PlayerState::idle;
  const double fade_s = load_request_.fade_s.value_or(kUsualFadeS);
  TACTO_TRY(player_->load(std::move(program), fade_s));
  loaded_ = full_name(file);
  passes_to_hz_ = passes_to_hz;
  loaded_gain_m_per_n_ = gain_m_per_n, default_gain_m_per_n_ = default_m_per_n;
  loop_period_m_ = period_m, loop_seam_m_ = seam_m;
  start_m_ = start_m, length_m_ = length_m;
  scene_path_ = scene_path;
  alone_ = alone;
  filter_ = filter;
  saved_gain_ = default_m_per_n / gain_m_per_n;
  fields.emplace_back("changed", changes);
  if (changes) fields.emplace_back("fade_s", fade_s);
  if (!changes) TACTO_TRY(player_->gain(1));
  publish_idle_status();
  return fields;
}

Result<ControlFields> Service::load(ForceProgram forces) {
  ControlFields fields{{"file", load_request_.file},
                       {"rate_hz", forces.session.rate_hz},
                       {forces.scene.pieces.empty() ? "patches" : "pieces",
                        static_cast<std::int64_t>(forces.scene.patches.size() + forces.scene.pieces.size())},
                       {"block_bytes", static_cast<std::int64_t>(forces.scene.bytes())}};
  for (std::size_t i = 0; i < forces.notes.size(); ++i)
    fields.emplace_back(fmt::format("note_{}", i + 1), forces.notes[i]);
  TACTO_TRY(player_->load(std::move(forces)));
  loaded_ = full_name(load_request_.file);
  loop_period_m_ = loop_seam_m_ = 0;
  filter_.reset();
  publish_idle_status();
  return fields;
}

std::string Service::next_session() const {
  return dated_session((fs::path(config_.sessions) / "").string());
}

Result<ControlFields> Service::arm(const ControlRequest& request) {
  TACTO_TRY(may_begin("arm"));
  const std::string path = next_session();
  TACTO_TRY(player_->arm(path));
  reported_lost_.reset();
  if (here_) missed_before_ = here_.loop->status().missed_ticks;
  lock_memory();  // includes memory allocated since the daemon's start
  stay_.begin(playback::stay_rules(request, config_.dead_man_s));
  ControlFields fields{{"state", std::string(to_string(player_->state()))}, {"session", path}};
  add_stay(fields, stay_.rules());
  return fields;
}

void Service::stay(const LinesReceived& heard, double passed_s) {
  const PlayerState state = player_->state();
  if (state != PlayerState::armed && state != PlayerState::playing) return;
  const auto why = stay_.why_to_fall(heard, passed_s);
  if (!why) return;
  if (state == PlayerState::playing) (void)done(player_->stop(*why), PlayerState::armed);
  (void)disarm(*why);
}

// Published when losses begin, and at the end with their total.
void Service::report_losses(const RecorderCounts& counts, bool last) {
  const bool wrong = counts.lost() > 0 || !counts.failure.empty();
  if (!wrong || (reported_lost_ && (!last || *reported_lost_ == counts.lost()))) return;
  reported_lost_ = counts.lost();
  const double device_s = 1e-9 * static_cast<double>(player_->status().ticks.last().time_ns);
  publish_("recorder", {{"lost_ticks", static_cast<std::int64_t>(counts.lost())},
                        {"why", counts.failure.empty() ? "the queue to the disk was full" : counts.failure},
                        {"device_s", device_s}});
}

Result<ControlFields> Service::disarm(const std::string& why) {
  const bool recorded = player_->recorded().has_value();
  const auto disarmed = player_->disarm(why);
  if (disarmed) stay_.end();
  if (recorded && !player_->recorded()) report_losses(player_->last_session(), true);
  publish_ticks(true);
  return done(disarmed, PlayerState::idle);
}

// In idle no status is published by time.
void Service::publish_idle_status() {
  if (player_->state() == PlayerState::idle) publish_("status", status());
}

double Service::rate_hz() const {
  const auto& forces = player_->forces();
  return forces ? forces->session.rate_hz : config_.rate_hz;
}

void Service::publish_ticks(bool last) {
  for (const ControlFields& fields : ticks_.take_events(rate_hz(), last)) publish_("ticks", fields);
}

// Stores G_psi with the user and the date: the gains that were loaded, times the factor. Saving again does
// not multiply the factor again.
Result<void> Service::save_gain(double factor, const std::string& who) {
  if (loaded_.empty())
    return fail(ErrorKind::usage, "no texture or scene is loaded whose file could store the gain", {},
                "load one first");
  if (!(std::abs(factor) >= kLeastSaved && std::abs(factor) <= 1 / kLeastSaved))
    return fail(ErrorKind::usage,
                fmt::format("with a factor of {:g} the layers' own gains could not be recovered", factor),
                loaded_, fmt::format("save a factor from {:g} to {:g}", kLeastSaved, 1 / kLeastSaved));
  if (!scene_path_.empty()) return save_scene_gain(factor, who);
  return schema::write_playback_gain(alone_.file,
                                     {alone_.gain_m_per_n * factor, who, schema::creation_time()});
}

Result<void> Service::save_scene_gain(double factor, const std::string& who) {
  auto scene = schema::read_scene(scene_path_);
  TACTO_TRY(scene);
  for (schema::Layer& layer : scene->layers)
    layer.visit([&](schema::TextureLayer& texture) {
      texture.gain_m_per_n *= factor / saved_gain_;
      texture.gain_set_by = who;
      texture.gain_set_on = schema::creation_time();
    });
  auto written = schema::write_scene(scene_path_, *scene);
  if (written) saved_gain_ = factor;
  return written;
}

// The requested gain as a factor of the loaded one.
Result<double> Service::factor_of(const ControlRequest& request) const {
  if (request.gain) return *request.gain;
  if (loaded_.empty())
    return fail(ErrorKind::usage, "no texture or scene is loaded to which the gain could belong", {},
                "load one first");
  if (request.gain_m_per_n && !scene_path_.empty())
    return fail(ErrorKind::usage, "a scene defines the gains of its textures", loaded_,
                "give a factor, as in 2x");
  return gain_of(request)->m_per_n(default_gain_m_per_n_) / loaded_gain_m_per_n_;
}

// A gain that is refused changes neither the file nor the playback.
Result<ControlFields> Service::gain(const ControlRequest& request) {
  const auto factor = factor_of(request);
  TACTO_TRY(factor);
  TACTO_TRY(player_->may_gain(*factor));
  if (request.save) TACTO_TRY(save_gain(*factor, request.asked_by));
  TACTO_TRY(player_->gain(*factor));
  const double device_s = 1e-9 * static_cast<double>(player_->status().ticks.last().time_ns);
  publish_("gain", {{"gain", *factor}, {"device_s", device_s}});
  publish_idle_status();
  ControlFields fields{{"gain", *factor}, {"saved", request.save}};
  add_present_gain(fields, *factor);
  return fields;
}

Result<ControlFields> Service::set(const ControlRequest& request) {
  TACTO_TRY(require_forces());
  const double over_s = request.over_s.value_or(kUsualRampS);
  const auto command = set_command(request.number, *request.value, over_s, *player_->forces());
  TACTO_TRY(command);
  return change_scene(*command, "set",
                      {{"number", request.number}, {"value", *request.value}, {"over_s", over_s}});
}

Result<ControlFields> Service::move(const ControlRequest& request) {
  TACTO_TRY(require_forces());
  const double over_s = request.over_s.value_or(kUsualRampS);
  const auto command = move_command(request.patch, {*request.x_m, *request.y_m}, over_s, *player_->forces());
  TACTO_TRY(command);
  return change_scene(
      *command, "move",
      {{"patch", request.patch}, {"x_m", *request.x_m}, {"y_m", *request.y_m}, {"over_s", over_s}});
}

Result<ControlFields> Service::raise(const ControlRequest& request) {
  TACTO_TRY(require_forces());
  const auto command = raise_command(request.patch, player_->forces()->scene);
  TACTO_TRY(command);
  return change_scene(*command, "raise", {{"patch", request.patch}});
}

Result<ControlFields> Service::mark(const ControlRequest& request) {
  const auto tick = player_->mark(request.text);
  TACTO_TRY(tick);
  const double device_s = 1e-9 * static_cast<double>(player_->status().ticks.last().time_ns);
  const ControlFields fields{
      {"text", request.text}, {"tick", static_cast<std::int64_t>(*tick)}, {"device_s", device_s}};
  publish_("mark", fields);
  return fields;
}

Result<void> Service::require_forces() const {
  if (player_->forces()) return {};
  return fail(ErrorKind::usage, "no scene of forces is loaded", {}, "load one first");
}

Result<ControlFields> Service::change_scene(const SceneCommand& command, const char* event,
                                            ControlFields fields) {
  TACTO_TRY(player_->change_scene(command));
  ControlFields published = fields;
  published.emplace_back("device_s", 1e-9 * static_cast<double>(player_->status().ticks.last().time_ns));
  publish_(event, published);
  if (!command.note.empty()) fields.emplace_back("note_1", command.note);
  return fields;
}

void Service::add_present_gain(ControlFields& fields, double factor) const {
  if (!loaded_.empty()) {
    fields.emplace_back("gain_m_per_n", factor * loaded_gain_m_per_n_);
    if (default_gain_m_per_n_ != 0)
      fields.emplace_back("gain_times_default", factor * loaded_gain_m_per_n_ / default_gain_m_per_n_);
  }
  add_inversion(fields, factor * loaded_gain_m_per_n_);
}

// The answer gives the new state, once the device's ticks report it.
Result<ControlFields> Service::done(const Result<void>& result, PlayerState target) {
  TACTO_TRY(result);
  const double until_s = client().transport().now_s() + kObeyedS;
  const auto waits = [&] {
    const PlayerState state = player_->state();
    return state != target && state != PlayerState::lost && client().transport().now_s() < until_s;
  };
  while (waits()) TACTO_TRY(player_->step(kLookS));
  return ControlFields{{"state", std::string(to_string(player_->state()))}};
}

ControlFields Service::hello() const {
  const wire::Welcome& about = device_.client->description().welcome;
  return {{"version", std::string(schema::kControlVersion)},
          {"daemon", std::string(kCreator)},
          {"device", device_.uri},
          {"device_name", std::string(about.name)},
          {"serial", std::string(about.serial)},
          {"transducer", config_.transducer},
          {"loop", config_.loop},
          {"rate_hz", config_.rate_hz}};
}

ControlFields Service::status() const {
  const PlayerStatus status = player_->status();
  const auto& forces = player_->forces();
  ControlFields fields{{"state", std::string(to_string(status.state))}};
  if (!forces) fields.emplace_back("gain", status.gain);
  if (!forces) add_present_gain(fields, status.gain);
  if (!status.fault.empty()) fields.emplace_back("fault", status.fault);
  if (!why_.empty()) fields.emplace_back("why", why_);
  if (status.state != PlayerState::idle) add_stay(fields, stay_.rules());
  if (!loaded_.empty()) fields.emplace_back("loaded", loaded_);
  if (!loaded_.empty() && !forces) {
    fields.emplace_back("passes_to_hz", passes_to_hz_);
    fields.emplace_back("start_m", start_m_);
    fields.emplace_back("length_m", length_m_);
  }
  add_loop(fields, loop_period_m_, loop_seam_m_);
  if (!status.session.empty()) fields.emplace_back("session", status.session);
  fields.emplace_back("round_trip_s", status.round_trip_s);
  add_ticks(fields, status.ticks, status.recorder ? status.recorder->lost() : 0);
  if (forces)
    add_forces(fields, status.ticks, *forces->session.forces);
  else
    add_limits(fields, status);
  if (status.recorder) add_recorder(fields, *status.recorder);
  fields.emplace_back("period_s", 1 / rate_hz());
  if (here_) {
    HostLoopStatus loop = here_.loop->status();
    loop.missed_ticks -= missed_before_;
    add_loop(fields, loop);
  }
  return fields;
}

std::optional<Result<ControlFields>> Service::handle(const ControlRequest& request) {
  switch (request.verb) {
    case ControlVerb::hello:
      return hello();
    case ControlVerb::load:
      TACTO_TRY(begin_load(request));
      return std::nullopt;
    case ControlVerb::arm:
      return arm(request);
    case ControlVerb::play:
      return done(player_->play(), PlayerState::playing);
    case ControlVerb::stop:
      return done(player_->stop(), PlayerState::armed);
    case ControlVerb::disarm:
      return disarm();
    case ControlVerb::gain:
      return gain(request);
    case ControlVerb::set:
      return set(request);
    case ControlVerb::move:
      return move(request);
    case ControlVerb::raise:
      return raise(request);
    case ControlVerb::mark:
      return mark(request);
    case ControlVerb::status:
    case ControlVerb::watch:
      return status();
  }
  return fail(ErrorKind::internal, "a request without an answer", "request");
}

bool Service::step(double timeout_s) {
  const PlayerState state = player_->state();
  if (state == PlayerState::idle || state == PlayerState::lost) return false;
  (void)player_->step(timeout_s);  // a lost device is reported as a state
  if (const double now_s = client().transport().now_s(); now_s >= next_status_s_) {
    next_status_s_ = now_s + kStatusEveryS;
    if (const auto counts = player_->recorded()) report_losses(*counts, false);
    publish_("status", status());
  }
  if (const double now_s = client().transport().now_s(); now_s >= next_ticks_s_) {
    next_ticks_s_ = now_s + kTicksEveryS;
    publish_ticks(player_->state() == PlayerState::lost);
  }
  return true;
}

void Service::end() {
  (void)player_->stop();
  (void)disarm();
}

}  // namespace tacto::playback
