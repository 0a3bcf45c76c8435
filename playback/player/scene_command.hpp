// SPDX-License-Identifier: GPL-3.0-or-later
// Commands that change a scene of forces while it is played, and files of them.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "firmware-host/core/wire/host_messages.hpp"
#include "playback/player/force_program.hpp"

namespace tacto::playback {

inline constexpr double kUsualRampS = 0.01;  ///< of a number and of a place

struct SceneCommand {
  std::variant<wire::Set, wire::Move, wire::Raise> message;
  std::string text;       ///< for the session
  std::string note = {};  ///< a warning, or empty
};

/// A plain number. Errors: usage, also for one that is not finite.
schema::Result<double> number_in_text(std::string_view text);

/// Of a patch's centre.
struct PatchPlace {
  double x_m = 0, y_m = 0;
};

/// "10mm,20mm". Errors: usage; as parse_quantity.
schema::Result<PatchPlace> parse_place(const std::string& text);

/// Sets a number, PATCH.LAYER.MEMBER, to a value in the unit that ends the member's name; LAYER is its index
/// in the patch, or its type if no other layer there has this type; of a piece in space PIECE.MEMBER. Errors:
/// usage, without a place: an unknown patch, layer or member (with the nearest name), a member without a
/// slider or that cannot change during playback, a value outside the slider (of a scaled one with the range
/// of the file), a ramp outside 0 to 10 s.
schema::Result<SceneCommand> set_command(const std::string& number, double value, double ramp_s,
                                         const ForceProgram& forces);

/// Moves a patch to the whole count of each axis that is nearest to the place. Notes if a part of it is then
/// outside the travel of the device. Errors: usage: an unknown patch (with the nearest name), a place farther
/// than core::kFarthestMove, a ramp as in set_command.
schema::Result<SceneCommand> move_command(const std::string& patch, const PatchPlace& to, double ramp_s,
                                          const ForceProgram& forces);

/// Makes a patch the topmost one. Errors: usage: an unknown patch.
schema::Result<SceneCommand> raise_command(const std::string& patch, const PreparedScene& scene);

/// "set PATCH.LAYER.MEMBER VALUE [over TIME]", "move PATCH X,Y [over TIME]", "raise PATCH". Errors: as these
/// commands; usage, for another command.
schema::Result<SceneCommand> parse_scene_command(std::string_view text, const ForceProgram& forces);

struct TimedSceneCommand {
  double time_s = 0;  ///< since play
  SceneCommand command;
};

/// A table with the columns time (with its unit, as in time_s) and command. Errors: as read_file; malformed,
/// with the line: times that do not increase or are below 0; as parse_scene_command.
schema::Result<std::vector<TimedSceneCommand>> read_scene_script(const std::string& file,
                                                                 const ForceProgram& forces);

}  // namespace tacto::playback
