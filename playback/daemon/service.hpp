// SPDX-License-Identifier: GPL-3.0-or-later
// Handles the requests to tactographd.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "data-schema/control/control.hpp"
#include "data-schema/control/daemon_config.hpp"
#include "playback/control/stay_watch.hpp"
#include "playback/daemon/tick_stream.hpp"
#include "playback/player/host_loop_client.hpp"
#include "playback/player/player.hpp"
#include "playback/player/player_device.hpp"
#include "playback/player/program_loader.hpp"

namespace tacto::playback {

/// A device, its player and what is loaded. For one thread.
class Service {
 public:
  using Publish = std::function<void(std::string_view event, const schema::ControlFields& fields)>;

  /// Opens the device. Errors: as open_player_device, Player::make; usage, not_found: for the transducer,
  /// finger path or folder of sessions in the configuration.
  static schema::Result<std::unique_ptr<Service>> open(const schema::DaemonConfig& config, Publish publish);

  /// Returns none if the answer follows by finished_load(). Errors: of the request, with what to do.
  std::optional<schema::Result<schema::ControlFields>> handle(const schema::ControlRequest& request);
  /// The answer to a `load` whose texture is now prepared; returned once.
  std::optional<schema::Result<schema::ControlFields>> finished_load();
  /// Cancels a load: its answer is then an error, and the current playback continues.
  void give_up_load() { loader_.give_up(); }
  /// Whether another thread prepares a texture; do not wait for it.
  bool loading() const { return loader_.busy(); }
  /// Whether the event `ticks` is published.
  void stream_ticks(bool on) { ticks_.turn(on); }
  /// Supervises for about `timeout_s`. Returns false at once if there is nothing to supervise.
  bool step(double timeout_s);
  /// Which lines stay() needs: those of one client, or of all.
  const StayRules& stay_rules() const { return stay_.rules(); }
  /// Call after each serve(): if the clients who have to stay have left, the drive falls and the session is
  /// closed.
  void stay(const LinesReceived& heard, double passed_s);
  /// Ramps to zero and closes the session.
  void end();
  PlayerState state() const { return player_->state(); }

 private:
  Service(const schema::DaemonConfig& config, Publish publish)
      : config_(config), publish_(std::move(publish)) {}
  schema::Result<void> connect();
  schema::Result<PlayerDevice> open_device();
  firmware_host::Client& client() { return here_ ? *here_.client : *device_.client; }
  schema::Result<void> begin_load(const schema::ControlRequest& request);
  schema::Result<schema::ControlFields> load(Program program);
  schema::Result<schema::ControlFields> load(ForceProgram forces);
  schema::Result<void> begin_load_of_forces(const schema::ControlRequest& request);
  schema::Result<void> may_begin(const char* what) const;
  schema::Result<schema::ControlFields> arm(const schema::ControlRequest& request);
  schema::Result<schema::ControlFields> gain(const schema::ControlRequest& request);
  schema::Result<schema::ControlFields> set(const schema::ControlRequest& request);
  schema::Result<schema::ControlFields> move(const schema::ControlRequest& request);
  schema::Result<schema::ControlFields> raise(const schema::ControlRequest& request);
  schema::Result<schema::ControlFields> mark(const schema::ControlRequest& request);
  schema::Result<void> require_forces() const;
  schema::Result<schema::ControlFields> change_scene(const SceneCommand& command, const char* event,
                                                     schema::ControlFields fields);
  schema::Result<void> save_gain(double factor, const std::string& who);
  schema::Result<void> save_scene_gain(double factor, const std::string& who);
  void report_losses(const RecorderCounts& counts, bool last);
  void publish_ticks(bool last);
  void publish_idle_status();
  double rate_hz() const;
  schema::Result<schema::ControlFields> disarm(const std::string& why = {});
  schema::Result<schema::ControlFields> done(const schema::Result<void>& result, PlayerState target);
  schema::ControlFields hello() const;
  schema::ControlFields status() const;
  schema::Result<double> factor_of(const schema::ControlRequest& request) const;
  void add_present_gain(schema::ControlFields& fields, double factor) const;
  std::string resolved(const std::string& file) const;
  std::string full_name(const std::string& file) const;
  std::string next_session() const;
  PrepareOptions options();
  TickBudget budget() const;

  schema::DaemonConfig config_;
  Publish publish_;
  PlayerDevice device_;
  std::optional<schema::Device> force_device_;  // if it has axes with forces
  std::optional<schema::Hand> force_hand_;      // that holds it, if it is emulated
  HostLoopClient here_;
  std::uint64_t missed_before_ = 0;  // periods that the loop on this computer missed before the session
  std::unique_ptr<Player> player_;
  ProgramLoader loader_;
  schema::ControlRequest load_request_;  // the request that is being prepared
  StayWatch stay_;
  std::string why_;  // reason of the last change of state
  std::string loaded_, scene_path_;
  std::optional<InverseChoice> filter_;  // chosen by a budget for the loaded texture; a change keeps it
  double passes_to_hz_ = 0;              // of the loaded texture
  // With their signs; 1 before a load, so that the factor alone has the sign.
  double loaded_gain_m_per_n_ = 1, default_gain_m_per_n_ = 1;
  double loop_period_m_ = 0, loop_seam_m_ = 0;
  double start_m_ = 0, length_m_ = 0;  // of the loaded texture
  schema::SessionTexture alone_;       // the loaded texture, if it is not a scene
  double saved_gain_ = 1;              // the gain in the scene's file, as a factor of the loaded gain
  double next_status_s_ = 0, next_ticks_s_ = 0;
  TickStream ticks_;
  std::optional<std::uint64_t> reported_lost_;  // of the session; none if nothing was lost
};

}  // namespace tacto::playback
