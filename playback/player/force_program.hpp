// SPDX-License-Identifier: GPL-3.0-or-later
// The force patches of a scene, prepared for a force device.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/playback_defaults.hpp"
#include "data-schema/session/session.hpp"
#include "firmware-host/link/client.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"
#include "playback/prepare/scene/stable_scene.hpp"

namespace tacto::playback {

struct ForceRequest {
  std::string file;               ///< stem or file of a scene
  std::optional<double> rate_hz;  ///< default: the device's largest
  double onset_s = schema::kOnsetS;
  std::uint16_t watchdog_ms = 100;
  std::optional<std::string> only_in = {};  ///< the file must be in this folder (served_file); none: anywhere
  bool hold_stable = false;                 ///< scale the stiffness of layers that are beyond their limit
};

/// Ready to upload. Only the player adds the rest of `session`: device, clock, initial state.
struct ForceProgram {
  PreparedScene scene;
  wire::ForceLimits limits;  ///< those of the device
  schema::SessionHeader session;
  std::vector<std::string> notes;  ///< what of the scene the device cannot give
  /// With hold_stable: the layers that were scaled. Player::arm() records them as events of the session.
  std::vector<HeldLayer> held = {};
};

/// The device as it describes itself: mass and friction are not known. Precondition: it has axes.
schema::Device device_of(const firmware_host::Description& description);

/// `device`: as its file or device_of() describes it, held by `hand` if one is known; `own`: its axes on the
/// wire. Errors: as read_scene, served_file, prepare_scene, force_setup_of, hold_stable; unsuitable: a
/// texture; a force that falls to zero too slowly to be safe.
schema::Result<ForceProgram> make_force_program(const ForceRequest& request, const schema::Device& device,
                                                const std::optional<schema::Hand>& hand,
                                                const wire::Axes& own);

/// Sends limits and block. Errors: as Client::command.
schema::Result<void> upload_scene(firmware_host::Client& client, const ForceProgram& forces);

}  // namespace tacto::playback
