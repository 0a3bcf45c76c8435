// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/player.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>
#include <variant>

#include "firmware-host/core/firmware/drive_supervisor.hpp"
#include "firmware-host/link/wire_device.hpp"
#include "firmware-host/link/wire_fields.hpp"
#include "firmware-host/link/wire_words.hpp"
#include "playback/prepare/displacement_limit.hpp"
#include "playback/prepare/texture_change.hpp"
#include "playback/prepare/upload.hpp"

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr double kIdleWaitS = 1, kIdleStepS = 0.01;
constexpr double kBehindS = 0.05;  // how far the device may be ahead of the ticks received

std::int64_t steady_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

PlayerState state_of(std::uint32_t flags) {
  if ((flags & wire::kTickFault) != 0) return PlayerState::fault;
  return (flags & wire::kTickPlaying) != 0 ? PlayerState::playing : PlayerState::armed;
}

bool runs(PlayerState state) {
  return state == PlayerState::armed || state == PlayerState::playing;
}

bool has_drive(const firmware_host::Description& about) {
  return (about.welcome.features & wire::kFeatureDrive) != 0;
}

Result<double> encoder_step(const firmware_host::Description& about, const std::string& uri) {
  if (!has_drive(about)) return double{about.axes->axes[0].metres_per_count};
  for (const wire::Channel& channel : about.channels)
    if (std::strcmp(channel.quantity, "position") == 0 && std::isfinite(channel.scale) && channel.scale != 0)
      return channel.scale;
  return fail(ErrorKind::device, "the device does not report its encoder step", uri,
              "it has no channel of the quantity position");
}

// A device reports no file names, so they are added here.
schema::Error naming(schema::Error error, const Program& program) {
  error.where = fmt::format("{}, on {}", program.name(), error.where);
  return error;
}

// Checks the displacement at a factor on the program's gains.
Result<void> within_reach(const Program& program, double peak_m, double factor) {
  const schema::Transducer& transducer = program.session.transducer;
  auto near = check_displacement(peak_m, factor, program.prepared.gain_m_per_n, program.default_gain_m_per_n,
                                 transducer);
  if (!near) near.error().remedy += rate_as_cause(program.prepared, transducer, program.options);
  return near;
}

}  // namespace

schema::SessionTick session_tick(const wire::Ticks& message, std::uint8_t i) {
  schema::SessionTick row;
  row.encoder = message.ticks[i].encoder;
  row.drive_v = message.ticks[i].drive_v;
  row.flags = message.ticks[i].flags;
  return row;
}

schema::SessionTick session_tick(const wire::AxisTicks& message, std::uint8_t i) {
  const wire::AxisTick& tick = message.ticks[i];
  schema::SessionTick row;
  row.encoder = tick.counts[0];
  row.flags = tick.flags;
  row.axes = message.axes;
  std::copy_n(tick.counts, message.axes, row.counts.begin());
  std::copy_n(tick.force_n, message.axes, row.force_n.begin());
  return row;
}

std::string_view to_string(PlayerState state) {
  constexpr std::string_view kWords[] = {"idle", "armed", "playing", "fault", "lost"};
  return kWords[static_cast<std::size_t>(state)];
}

Player::Player(firmware_host::Client& client, std::string uri, const PlayerOptions& options, double metres)
    : client_(client),
      uri_(std::move(uri)),
      options_(options),
      metres_per_count_(metres),
      tray_(client, options.follow_force) {
  client_.listen([this](std::span<const std::uint8_t> frame) { keep(frame); });
}

Player::~Player() {
  client_.listen({});
}

Result<std::unique_ptr<Player>> Player::make(firmware_host::Client& client, std::string uri,
                                             const PlayerOptions& options) {
  if (!has_drive(client.description()) && !client.description().axes)
    return fail(ErrorKind::device, "the device has no output", uri);
  const auto step = encoder_step(client.description(), uri);
  TACTO_TRY(step);
  return std::unique_ptr<Player>(new Player(client, std::move(uri), options, *step));
}

Result<void> Player::require(bool allowed, const char* what, const char* remedy) const {
  if (allowed) return {};
  const std::string why = fmt::format("can't {} in the state {}", what, to_string(state_));
  return fail(ErrorKind::usage, why, uri_, remedy);
}

// Each command that the device accepted is part of the session, except for those of the samples' stream.
void Player::keep(std::span<const std::uint8_t> frame) {
  if (TraySamples::streams(frame)) return;
  if (recorder_) recorder_->command({view_.expected(), steady_ns(), {frame.begin(), frame.end()}});
}

// Sends a command during playback, and processes the ticks and faults that came before its answer.
template <class Message>
Result<void> Player::steer(const Message& message) {
  const auto done = client_.command(message);
  take_ticks();
  take_faults();
  return done;
}

Result<void> Player::may_load(bool forces) const {
  const firmware_host::Description& about = client_.description();
  if (forces && !about.axes)
    return fail(ErrorKind::unsuitable, "this device has no axes with forces", uri_,
                "play the scene on a force device, for example sim:planar");
  if (!forces && !has_drive(about))
    return fail(ErrorKind::unsuitable, "this device has forces, but no tray", uri_,
                "play a scene with force patches on it");
  if (forces || forces_) return require(state_ == PlayerState::idle, "load", "disarm first");
  return require(state_ == PlayerState::idle || runs(state_), "load", "disarm first");
}

Result<void> Player::load(Program program, double fade_s) {
  TACTO_TRY(may_load(false));
  const double factor = runs(state_) ? gain_ : 1;
  TACTO_TRY(within_reach(program, program.tray_peak_m, factor));
  const wire::Welcome& about = client_.description().welcome;
  wire::Limits& limits = program.prepared.limits;
  limits.drive_v = std::min(limits.drive_v, about.drive_limit_v);
  limits.slew_v_per_s = std::min(limits.slew_v_per_s, about.slew_limit_v_per_s);
  if (runs(state_)) return change(std::move(program), fade_s);
  if (auto fits = check_upload(client_, program.prepared); !fits)
    return tl::unexpected(naming(fits.error(), program));
  program_ = std::move(program);
  forces_.reset();
  return {};
}

Result<void> Player::load(ForceProgram forces) {
  TACTO_TRY(may_load(true));
  forces_ = std::move(forces);
  program_.reset();
  gain_ = 1;
  return {};
}

Result<void> Player::may_change(const Program& program, double fade_s) const {
  if (!(fade_s >= 0 && fade_s <= double{core::kLongestFadeS}))
    return fail(ErrorKind::usage, fmt::format("the fade is {:g} s", fade_s), uri_,
                fmt::format("use 0 s to {:g} s", double{core::kLongestFadeS}));
  if (view_.expected() < faded_at_)
    return fail(ErrorKind::usage, "the last change of texture has not ended", uri_, "load again later");
  return check_texture_change(program_->prepared, program.prepared,
                              client_.description().welcome.profile_samples);
}

// The device's gain is not changed, so that a later gain is a factor of the same value.
Result<void> Player::change(Program program, double fade_s) {
  TACTO_TRY(may_change(program, fade_s));
  const schema::SessionProgram& brought = program.session;  // a change uses only this part of the header
  recorder_->change({view_.expected(), steady_ns(), brought});
  const auto done = upload_change(client_, program.prepared, device_gain_m_per_n_, fade_s);
  take_ticks();
  take_faults();
  if (!done) return done;
  leaving_peak_m_ = program_->tray_peak_m;
  program_ = std::move(program);
  view_textures();
  faded_at_ = view_.expected() + static_cast<std::uint64_t>((fade_s + kBehindS) * program_->prepared.rate_hz);
  recorder_->event({view_.expected(), steady_ns(), "texture changed to " + program_->name()});
  return {};
}

void Player::view_textures() {
  if (!program_) return;
  const bool stops = program_->options.ends == Ends::stop;
  view_.textures_from(stops ? program_->start_m : -INFINITY,
                      stops ? program_->start_m + program_->length_m : INFINITY);
}

schema::SessionHeader Player::session_header() const {
  const firmware_host::Description& about = client_.description();
  schema::SessionHeader header = loaded_header();
  header.clock_hz = about.welcome.clock_hz;
  header.loop = options_.loop != nullptr ? "host" : "device";
  header.device_uri = uri_;
  header.device_name = about.welcome.name;
  header.device_serial = about.welcome.serial;
  header.device_firmware = about.welcome.firmware;
  header.device_protocol = fmt::format("{}.{}", about.welcome.major, about.welcome.minor);
  header.initial_gain = gain_;
  header.sensor = tray_.sensor(header.rate_hz);
  header.simulated = firmware_host::simulated_device(about);
  return header;
}

Result<void> Player::begin_session(const std::string& path) {
  const schema::SessionHeader header = session_header();
  const std::size_t samples = client_.description().welcome.profile_samples;
  std::unique_ptr<LiveLimits> limits;
  if (options_.tell_limits && !forces_) limits = std::make_unique<LiveLimits>(header, samples);
  auto recorder = FlightRecorder::begin(path, header, options_.full_queue, limits.get());
  TACTO_TRY(recorder);
  recorder_ = std::move(*recorder);
  marks_ = 0;
  limits_ = std::move(limits);
  tray_.begin(header.rate_hz, [this](schema::SessionSamples run) { recorder_->measured(std::move(run)); });
  return {};
}

Result<void> Player::upload_loaded() {
  if (forces_) return upload_scene(client_, *forces_);
  device_gain_m_per_n_ = program_->prepared.gain_m_per_n;
  TACTO_TRY(upload(client_, program_->prepared));
  return client_.command(device_gain());
}

Result<void> Player::arm(const std::string& session_path) {
  TACTO_TRY(require(state_ == PlayerState::idle, "arm", "disarm first"));
  TACTO_TRY(require(loaded(), "arm", "load a texture or scene first"));
  if (program_) TACTO_TRY(may_gain(gain_));
  // If another program was killed during playback, the device may still ramp down.
  TACTO_TRY(wait_for_idle());
  TACTO_TRY(begin_session(session_path));
  fault_.clear();
  stopped_because_.clear();
  const schema::SessionHeader& header = loaded_header();
  view_.begin(header.rate_hz, header.metres_per_count);
  view_textures();
  faded_at_ = 0;
  const wire::Arm arm{forces_ ? wire::DriveSource::scene : wire::DriveSource::profile,
                      firmware_host::millihertz(header.rate_hz)};
  auto done = upload_loaded();
  client_.take_ticks();  // ticks of an earlier run, possibly of another program
  client_.take_axis_ticks();
  if (done) done = recorder_->start();
  if (done) done = client_.command(arm);
  if (!done) {
    recorder_->discard();
    recorder_.reset();
    limits_.reset();
    return done;
  }
  session_path_ = session_path;
  if (!options_.note.empty()) recorder_->event({0, steady_ns(), options_.note});
  if (forces_)
    for (const HeldLayer& layer : forces_->held) recorder_->event({0, steady_ns(), held_words(layer)});
  if (const auto streams = options_.loop != nullptr ? Result<void>() : tray_.begin_stream(); !streams)
    recorder_->event({0, steady_ns(), "no samples of the sensors: " + schema::message(streams.error())});
  const auto beaten = beat();
  enter(PlayerState::armed, "");
  return beaten;
}

Result<void> Player::play() {
  const char* const remedy = state_ == PlayerState::fault ? "disarm first, then arm" : "arm first";
  TACTO_TRY(require(runs(state_), "play", remedy));
  stopped_because_.clear();
  return steer(wire::Play{});
}

Result<void> Player::stop(const std::string& why) {
  const bool may = state_ != PlayerState::idle && state_ != PlayerState::lost;
  TACTO_TRY(require(may, "stop", "nothing is playing"));
  stopped_because_ = why;
  return steer(wire::Stop{});
}

Result<void> Player::may_gain(double gain) const {
  if (!std::isfinite(gain)) return fail(ErrorKind::usage, "the gain is not a finite number", uri_);
  if (forces_)
    return fail(ErrorKind::unsuitable, "a scene of forces has no gain", uri_, "set a number of a layer");
  if (!program_) return {};
  const bool fades = recorder_ != nullptr && view_.expected() < faded_at_;
  const double peak_m = std::max(program_->tray_peak_m, fades ? leaving_peak_m_ : 0);
  return within_reach(*program_, peak_m, gain);
}

Result<void> Player::gain(double gain) {
  TACTO_TRY(may_gain(gain));
  gain_ = gain;
  if (!recorder_) return {};
  const auto done = steer(device_gain());
  if (done) recorder_->event({view_.expected(), steady_ns(), fmt::format("gain {:g}", gain)});
  return done;
}

Result<void> Player::change_scene(const SceneCommand& command) {
  TACTO_TRY(require(forces_ && runs(state_), "change a scene of forces", "arm one first"));
  const auto done = std::visit([&](const auto& message) { return steer(message); }, command.message);
  if (done) recorder_->event({view_.expected(), steady_ns(), command.text});
  return done;
}

// The heartbeat's answer follows the ticks that the device has sent before it.
Result<std::uint64_t> Player::mark(const std::string& text) {
  TACTO_TRY(require(recorder_ != nullptr, "mark", "arm first: a mark is in a session"));
  if (marks_ >= schema::kMostMarks)
    return fail(ErrorKind::usage, fmt::format("this session has {} marks", marks_), session_path_,
                "disarm and arm: the next session has room for as many");
  if (const auto beaten = beat(); !beaten) return tl::unexpected(lose(beaten.error()).error());
  take_faults();
  take_ticks();
  ++marks_;
  recorder_->event({view_.expected(), steady_ns(), std::string(schema::kMarkEvent) + text});
  return view_.expected();
}

void Player::note(const std::string& text) {
  if (recorder_) recorder_->event({view_.expected(), steady_ns(), text});
}

wire::Gain Player::device_gain() const {
  return {static_cast<float>(gain_ * device_gain_m_per_n_)};
}

Result<void> Player::wait_for_idle() {
  for (double waited_s = 0; waited_s < kIdleWaitS; waited_s += kIdleStepS) {
    const auto pulse = client_.heartbeat();
    TACTO_TRY(pulse);
    take_ticks();
    if (pulse->state == wire::DriveState::idle) return {};
    TACTO_TRY(client_.receive(kIdleStepS));
  }
  return fail(ErrorKind::device, "the device did not come to rest", uri_, "switch off the amplifier");
}

Result<void> Player::disarm(const std::string& why) {
  if (state_ == PlayerState::idle) return {};
  TACTO_TRY(require(state_ != PlayerState::lost, "disarm", "the device does not answer"));
  auto done = steer(wire::Disarm{});
  if (done) done = wait_for_idle();
  if (done) done = tray_.end_stream();
  if (!done) return lose(done.error());
  enter(PlayerState::idle, why);
  return end_session();
}

// A device that closes the loop itself reads the encoder and sets the drive in the same tick.
std::string Player::latency_words() const {
  if (options_.loop != nullptr) return options_.loop->latency_words();
  return fmt::format("from the encoder's edge to the {}: the device's own tick, at most {:g} ms",
                     forces_ ? "force" : "drive", 1e3 / loaded_header().rate_hz);
}

Result<void> Player::end_session() {
  if (!recorder_) return {};
  tray_.end();
  if (view_.ticks() > 0) recorder_->event({view_.expected(), steady_ns(), latency_words()});
  const auto closed = recorder_->close();
  last_session_ = recorder_->counts();
  recorder_.reset();
  return closed;
}

Result<void> Player::lose(const schema::Error& error) {
  const bool first = state_ != PlayerState::lost;
  if (first) enter(PlayerState::lost, schema::message(error));
  (void)end_session();
  return tl::unexpected(error);
}

Result<void> Player::beat() {
  const double asked_s = client_.transport().now_s();
  const auto pulse = client_.heartbeat();
  TACTO_TRY(pulse);
  round_trip_s_ = client_.transport().now_s() - asked_s;
  pulse_s_ = static_cast<double>(pulse->device_ticks) / std::max(1U, client_.description().welcome.clock_hz);
  next_beat_s_ = client_.transport().now_s() + options_.heartbeat_s;
  return {};
}

Result<void> Player::step(double timeout_s) {
  if (state_ == PlayerState::lost || state_ == PlayerState::idle) return {};
  auto done = client_.receive(timeout_s);
  if (done && client_.transport().now_s() >= next_beat_s_) done = beat();
  take_faults();
  take_ticks();
  if (!done) return lose(done.error());
  watch_lateness();
  return {};
}

// Ticks of an earlier run may still arrive: they are ignored.
template <class Message>
void Player::take(const Message& message) {
  if (!recorder_ || message.count == 0 || message.first_tick < view_.expected()) return;
  if (message.first_tick > view_.expected()) {
    const std::uint64_t lost = message.first_tick - view_.expected();
    view_.take_loss(lost);
    recorder_->loss({view_.expected(), lost, schema::SessionLoss::Why::link});
  }
  const wire::Welcome& about = client_.description().welcome;
  const double ns_per_clock = 1e9 / std::max(1U, about.clock_hz);
  const auto time_ns = std::llround(static_cast<double>(message.device_ticks) * ns_per_clock);
  const double period_ns = 1e9 / loaded_header().rate_hz;
  LoopView* const loop = options_.loop;
  for (std::uint8_t i = 0; i < message.count; ++i) {
    const std::uint64_t number = message.first_tick + i;
    schema::SessionTick row = session_tick(message, i);
    row.tick = number;
    row.time_ns = loop != nullptr ? loop->due_ns(number) : time_ns + std::llround(i * period_ns);
    if (loop != nullptr) row.lateness_ns = loop->lateness_ns(number);
    view_.take(row);
    recorder_->tick(row);
    if (tick_listener_) tick_listener_(row);
    if (tray_.run() != nullptr && loop != nullptr) loop->take_samples(number, *tray_.run());
  }
  const PlayerState seen = state_of(view_.last().flags);
  if (seen != state_ && state_ != PlayerState::fault && state_ != PlayerState::idle)
    enter(seen, seen == PlayerState::armed ? stopped_because_ : fault_);
}

void Player::take_ticks() {
  tray_.take();
  for (const wire::Ticks& message : client_.take_ticks()) take(message);
  for (const wire::AxisTicks& message : client_.take_axis_ticks()) take(message);
}

void Player::take_faults() {
  for (const wire::Fault& fault : client_.take_faults()) {
    const firmware_host::FaultWords words = firmware_host::words_of(fault.code, fault.detail);
    if (!recorder_) continue;
    // A converter that fails ends the stream of samples; the drive continues.
    if (fault.code == wire::FaultCode::ring_full || fault.code == wire::FaultCode::converter) {
      recorder_->event({view_.expected(), steady_ns(), words.what});
      continue;
    }
    fault_ = words.remedy.empty() ? words.what : words.what + " (" + words.remedy + ")";
    enter(PlayerState::fault, fault_);
  }
}

// The drive of a late tick is late at the finger. Too many late ticks are a fault.
void Player::watch_lateness() {
  if (state_ != PlayerState::playing || view_.late_part() <= options_.most_late) return;
  fault_ = fmt::format(
      "{:.0f} % of the ticks of a second were late (run fewer other programs, or use a lower rate)",
      100 * view_.late_part());
  (void)steer(wire::Stop{});
  enter(PlayerState::fault, fault_);
}

void Player::enter(PlayerState state, const std::string& why) {
  if (state == state_) return;
  state_ = state;
  if (state == PlayerState::lost) fault_ = why;
  const std::string words = fmt::format("{}{}{}", to_string(state), why.empty() ? "" : ": ", why);
  if (recorder_) recorder_->event({view_.expected(), steady_ns(), words});
  // Before the first tick, the time is that of the heartbeat's answer.
  const double device_s = view_.ticks() > 0 ? 1e-9 * static_cast<double>(view_.last().time_ns) : pulse_s_;
  if (listener_) listener_(state, why, device_s);
}

// Losses are reported until the next session begins.
PlayerStatus Player::status() const {
  PlayerStatus status{state_, fault_, gain_, view_, recorded(), {}, session_path_, round_trip_s_};
  if (!status.recorder && !session_path_.empty()) status.recorder = last_session_;
  if (limits_) status.limits = limits_->figures();
  return status;
}

}  // namespace tacto::playback
