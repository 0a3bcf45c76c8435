// SPDX-License-Identifier: GPL-3.0-or-later
// What is to be played, as a user names it: a texture or a scene, made ready for a device.
#pragma once

#include <optional>
#include <string>

#include "data-schema/session/session.hpp"
#include "playback/choose/budget.hpp"
#include "playback/choose/choices.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// What is asked for. A texture may say where it lies; a scene says it itself.
struct ProgramRequest {
  std::string file;  ///< stem or file of a texture or scene
  std::optional<double> at_m, gain_m_per_n;
  std::optional<schema::TextureEnds> ends;
  bool implausible = false;       ///< insist on a transducer whose numbers no transducer has
  bool unfit_transducer = false;  ///< take a transducer whose file says that its model does not fit
  TickBudget budget = {};         ///< chooses reading and inverse, where something is asked
  /// Also what could move the tray beyond its limit: on an emulated one, to see what the other limits take
  /// away.
  bool any_displacement = false;
  schema::PlaybackChoices choices = {};   ///< go before the scene's
  schema::PlaybackChoices defaults = {};  ///< for what neither they nor the scene say
  /// `file` and all that belongs to it has to lie in this folder (served_file); none: anywhere.
  std::optional<std::string> only_in = {};
};

/// Ready to upload. `session` lacks only what the player knows: device, clock, initial state.
struct Program {
  Prepared prepared;
  schema::SessionHeader session;
  std::string scene_path;   ///< empty for a texture by itself
  double tray_peak_m = 0;   ///< the furthest that the tray goes, at a factor of 1 (displacement_limit.hpp)
  double gain_m_per_n = 0;  ///< the largest of its textures, with its sign
  std::optional<schema::PlaybackGain> kept_gain;  ///< the texture's own, where it is played with that
  double start_m = 0;                             ///< of the first texture
  double length_m = 0;                            ///< from the first texture's start to the last one's end
  double reach_m = 0;                             ///< from the encoder's zero: farther away nothing is read
  std::optional<TickDecision> decision;           ///< of the request's budget
  PrepareOptions options;                         ///< that it was prepared with, in the end

  /// The scene's file, or the texture's.
  const std::string& name() const { return scene_path.empty() ? session.textures.front().file : scene_path; }
};

/// Reads the files, and prepares. `options`: rate, encoder, limits; gain and ends are taken from the request
/// or the scene, and what was chosen from request, scene and defaults, in this order. Errors: as
/// read_texture, read_scene, read_transducer, prepare, decide, find_trade_table; unsuitable: as check_usable;
/// more textures than a session has room to name; a scene of several textures whose ends are not `stop`;
/// usage: a place or gain for a scene; as
/// check_meant, of the request.
schema::Result<Program> make_program(const ProgramRequest& request, const std::string& transducer,
                                     PrepareOptions options);

}  // namespace tacto::playback
