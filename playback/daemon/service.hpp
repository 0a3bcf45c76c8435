// SPDX-License-Identifier: GPL-3.0-or-later
// What tactographd does with each request.
#pragma once

#include <memory>
#include <string>

#include "data-schema/control.hpp"
#include "data-schema/daemon_config.hpp"
#include "playback/daemon/host_loop.hpp"
#include "playback/daemon/player.hpp"
#include "playback/daemon/player_device.hpp"

namespace tacto::playback {

/// A device, a player and what is loaded. One thread.
class Service {
 public:
  using Publish = std::function<void(std::string_view event, const schema::ControlFields& fields)>;

  /// Opens the device. Errors: as open_player_device, Player::make; usage, not_found: of the configuration's
  /// transducer, finger path, or folder of sessions.
  static schema::Result<std::unique_ptr<Service>> open(const schema::DaemonConfig& config, Publish publish);

  /// Errors: of what was asked for, with what to do.
  schema::Result<schema::ControlFields> handle(const schema::ControlRequest& request);
  /// Supervises for about `timeout_s`. False where nothing is under way, and nothing was waited for.
  bool step(double timeout_s);
  /// Ramps to zero and closes the session.
  void end();
  PlayerState state() const { return player_->state(); }

 private:
  Service(const schema::DaemonConfig& config, Publish publish)
      : config_(config), publish_(std::move(publish)) {}
  schema::Result<void> connect();
  schema::Result<void> close_loop_here(PlayerOptions& options);
  firmware_host::Client& client() { return loop_client_ ? *loop_client_ : *device_.client; }
  schema::Result<schema::ControlFields> load(const schema::ControlRequest& request);
  schema::Result<Program> prepared_program(const ProgramRequest& request);
  schema::Result<schema::ControlFields> arm();
  schema::Result<schema::ControlFields> gain(const schema::ControlRequest& request);
  schema::Result<void> save_gain(double factor);
  schema::Result<schema::ControlFields> done(const schema::Result<void>& result, PlayerState wanted);
  schema::ControlFields hello() const;
  schema::ControlFields status() const;
  std::string resolved(const std::string& file) const;
  std::string next_session() const;
  PrepareOptions options();

  schema::DaemonConfig config_;
  Publish publish_;
  PlayerDevice device_;
  std::unique_ptr<HostLoop> loop_;  // where the host closes it
  std::unique_ptr<firmware_host::Client> loop_client_;
  std::unique_ptr<Player> player_;
  std::string loaded_, scene_path_;
  double saved_gain_ = 1;  // that the scene's file holds, of the gains that were loaded
  double next_status_s_ = 0;
};

}  // namespace tacto::playback
