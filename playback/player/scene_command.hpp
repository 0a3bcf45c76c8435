// SPDX-License-Identifier: GPL-3.0-or-later
// Commands that change a scene of forces while it is played, and files of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware-host/core/wire/host_messages.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"

namespace tacto::playback {

inline constexpr double kUsualSetRampS = 0.01;

struct SceneCommand {
  wire::Set set;
  std::string text;  ///< for the session
};

/// Sets a number, PATCH.LAYER.MEMBER, to a value in the unit that ends the member's name; LAYER is its index
/// in the patch, or its type if no other layer there has this type. Errors: usage, without a place: an
/// unknown patch, layer or member (with the nearest name), a member without a slider or that cannot change
/// during playback, a value outside the slider, a ramp outside 0 to 10 s.
schema::Result<SceneCommand> set_command(const std::string& number, double value, double ramp_s,
                                         const PreparedScene& scene);

/// "set PATCH.LAYER.MEMBER VALUE [over TIME]". Errors: as set_command; usage, for another command.
schema::Result<SceneCommand> parse_scene_command(std::string_view text, const PreparedScene& scene);

struct TimedSceneCommand {
  double time_s = 0;  ///< since play
  SceneCommand command;
};

/// A table with the columns time (with its unit, as in time_s) and command. Errors: as read_file; malformed,
/// with the line: times that do not increase or are below 0; as parse_scene_command.
schema::Result<std::vector<TimedSceneCommand>> read_scene_script(const std::string& file,
                                                                 const PreparedScene& scene);

}  // namespace tacto::playback
