// SPDX-License-Identifier: GPL-3.0-or-later
// Plays on a device that closes the loop: uploads, arms, controls, supervises, records. A device on USB, an
// emulated one and the host's own real-time loop have the same interface.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "firmware-host/link/client.hpp"
#include "playback/host-loop/loop_view.hpp"
#include "playback/host-loop/tray_samples.hpp"
#include "playback/player/flight_recorder.hpp"
#include "playback/player/force_program.hpp"
#include "playback/player/program.hpp"
#include "playback/player/scene_command.hpp"
#include "playback/session/tick_view.hpp"

namespace tacto::playback {

/// idle: no output. armed: ticking, the drive at zero. playing. fault: the drive has been ramped to zero,
/// until disarm. lost: the device no longer answers (its own watchdog has ramped the drive to zero).
///   idle -> armed by arm; armed -> playing by play; playing -> armed by stop; armed, playing, fault -> idle
///   by disarm; armed, playing -> fault by the device (message in PlayerStatus::fault) or by too many late
///   ticks; any -> lost by a device that does not answer.
enum class PlayerState { idle, armed, playing, fault, lost };
std::string_view to_string(PlayerState state);

/// Tick `i` of a message as a session stores it, without its number, time and lateness.
schema::SessionTick session_tick(const wire::Ticks& message, std::uint8_t i);
schema::SessionTick session_tick(const wire::AxisTicks& message, std::uint8_t i);

struct PlayerOptions {
  FullQueue full_queue = FullQueue::lose;
  double heartbeat_s = 0.025;
  double most_late = 0.2;     ///< part of the ticks within a second; a larger part is a fault
  bool tell_limits = false;   ///< live, by a second kernel on the recorder's thread (live_limits.hpp)
  LoopView* loop = nullptr;   ///< of a loop on this computer; none: the device closes it
  std::string note;           ///< an event of each session, at its beginning; empty: none
  bool follow_force = false;  ///< the device streams its normal force (Player::normal_force_n)
};

struct PlayerStatus {
  PlayerState state = PlayerState::idle;
  std::string fault;  ///< cause, and what to do; empty if there is no fault
  double gain = 1;
  TickView ticks;  ///< since arming
  std::optional<RecorderCounts> recorder;
  LimitsTook limits;        ///< since arming, if requested
  std::string session;      ///< file being written, or the last one
  double round_trip_s = 0;  ///< of the last heartbeat
};

inline constexpr double kUsualFadeS = 0.05;  ///< of a change of texture

/// For one thread, which also uses the client. Every call returns within the client's timeouts. A call that
/// is not possible in the current state is refused (usage), with what to do first.
class Player {
 public:
  /// Called at each change of state, with its cause.
  using Listener = std::function<void(PlayerState state, const std::string& why, double device_s)>;

  /// The client must outlive the player. Errors: device: neither a drive nor forces, or no encoder with a
  /// known step.
  static schema::Result<std::unique_ptr<Player>> make(firmware_host::Client& client, std::string uri,
                                                      const PlayerOptions& options);
  ~Player();

  /// The step of the encoder, or of the first axis of a device that has only forces, m per count.
  double metres_per_count() const { return metres_per_count_; }
  void listen(Listener listener) { listener_ = std::move(listener); }
  /// Called with each tick of a session, on the player's thread.
  void listen_to_ticks(std::function<void(const schema::SessionTick&)> listener) {
    tick_listener_ = std::move(listener);
  }

  /// In idle: stores the program for arm(), which uploads it. Armed or playing: cross-fades to its texture
  /// over `fade_s` (0 to 10 s); gain() is not changed. Errors: as check_upload(), in idle; usage, in another
  /// state, while an earlier change still fades, or for another fade; unsuitable, if the tray would exceed
  /// its limit; as of check_texture_change(); device. After an error the current texture continues.
  schema::Result<void> load(Program program, double fade_s = kUsualFadeS);
  /// The same for a scene of forces, only in idle; its gain is 1.
  schema::Result<void> load(ForceProgram forces);
  /// Whether load() of a program, or of forces, is possible on this device and in this state. Errors:
  /// unsuitable; usage.
  schema::Result<void> may_load(bool forces) const;
  bool loaded() const { return program_ || forces_; }
  /// The forces that are loaded; none: a program for a tray, or nothing.
  const std::optional<ForceProgram>& forces() const { return forces_; }
  /// Begins a session (never over an existing file), and arms when its header and upload are on the disk.
  /// Only in idle, with a program. Errors: usage; device; cannot_write. After an error there is no session.
  schema::Result<void> arm(const std::string& session_path);
  schema::Result<void> play();
  /// `why`, if given, is published with the next state.
  schema::Result<void> stop(const std::string& why = {});
  /// At any time; kept for the next session. Errors: as may_gain; device.
  schema::Result<void> gain(double gain);
  /// Errors: usage, for a gain that is not finite; unsuitable, for one at which the tray would exceed its
  /// limit, with the largest that fits, and for forces.
  schema::Result<void> may_gain(double gain) const;
  /// Changes the scene of forces that is played. Errors: usage, in idle and for a drive; device.
  schema::Result<void> change_scene(const SceneCommand& command);
  /// Puts a client's mark into the session, and returns its tick: the first one that the device had not sent.
  /// Errors: usage, without a session and after kMostMarks; device.
  schema::Result<std::uint64_t> mark(const std::string& text);
  /// Puts an event that is no mark into the session, before the first tick that has not arrived; without a
  /// session nothing.
  void note(const std::string& text);
  /// Ramps to zero, waits for idle (a second at most), and closes the session; `why` as in stop(). Errors:
  /// device; cannot_write.
  schema::Result<void> disarm(const std::string& why = {});

  /// Receives the device's messages, waiting at most `timeout_s`, and resets its watchdog. An error (the
  /// device is lost) is returned once; from then on the state is lost.
  schema::Result<void> step(double timeout_s);

  PlayerState state() const { return state_; }
  /// The normal force now, N, if PlayerOptions asks for it: a mean over the last 0.1 s. It is in no session.
  /// None: the device does not report it, or this computer closes the loop.
  std::optional<double> normal_force_n() const {
    return tray_.normal_force_n(1e-9 * static_cast<double>(view_.last().time_ns));
  }
  /// Counts of the session that is being written, if there is one.
  std::optional<RecorderCounts> recorded() const {
    return recorder_ ? std::optional(recorder_->counts()) : std::nullopt;
  }
  /// Counts of the last session that was closed.
  const RecorderCounts& last_session() const { return last_session_; }
  PlayerStatus status() const;
  /// Seconds of ticks since arming, by the device's clock.
  double armed_s() const { return view_.span_s(); }

 private:
  Player(firmware_host::Client& client, std::string uri, const PlayerOptions& options, double metres);
  template <class Message>
  schema::Result<void> steer(const Message& message);
  void keep(std::span<const std::uint8_t> frame);
  wire::Gain device_gain() const;
  void view_textures();  // tells view_ where the program has textures
  schema::Result<void> wait_for_idle();
  schema::Result<void> beat();
  schema::Result<void> require(bool allowed, const char* what, const char* remedy) const;
  schema::Result<void> change(Program program, double fade_s);
  schema::Result<void> may_change(const Program& program, double fade_s) const;
  const schema::SessionHeader& loaded_header() const {
    return forces_ ? forces_->session : program_->session;
  }
  schema::SessionHeader session_header() const;
  schema::Result<void> upload_loaded();
  schema::Result<void> begin_session(const std::string& path);
  void take_ticks();
  template <class Message>
  void take(const Message& message);
  void take_faults();
  void watch_lateness();
  void enter(PlayerState state, const std::string& why);
  void follow(const TickView& view);
  schema::Result<void> lose(const schema::Error& error);
  schema::Result<void> end_session();
  std::string latency_words() const;

  firmware_host::Client& client_;
  std::string uri_;
  PlayerOptions options_;
  double metres_per_count_ = 0;
  Listener listener_;
  std::function<void(const schema::SessionTick&)> tick_listener_;
  std::optional<Program> program_;
  std::optional<ForceProgram> forces_;  // or this one
  std::unique_ptr<LiveLimits> limits_;  // if requested; declared before the recorder, which uses it
  std::unique_ptr<FlightRecorder> recorder_;
  std::string session_path_;
  RecorderCounts last_session_;
  PlayerState state_ = PlayerState::idle;
  std::string fault_, stopped_because_;
  double gain_ = 1;
  double leaving_peak_m_ = 0;       // of the tray, by the texture before the last change
  double device_gain_m_per_n_ = 0;  // gain_ is a factor of it; since arming
  std::uint64_t faded_at_ = 0;      // the tick at which the last change is complete
  TickView view_;
  TraySamples tray_;
  std::size_t marks_ = 0;  // of the session
  double pulse_s_ = 0;     // the device's clock at the last heartbeat
  double next_beat_s_ = 0, round_trip_s_ = 0;
};

}  // namespace tacto::playback
