// SPDX-License-Identifier: GPL-3.0-or-later
// A texture or a scene, as a user names it, prepared for a device.
#pragma once

#include <optional>
#include <string>

#include "data-schema/base/gain.hpp"
#include "data-schema/session/session.hpp"
#include "playback/choose/budget.hpp"
#include "playback/choose/choices.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// A request. A texture may be given a position, ends and a gain; a scene has its own, and accepts a factor
/// on its gains.
struct ProgramRequest {
  std::string file;  ///< stem or file of a texture or scene
  std::optional<double> at_m;
  std::optional<schema::TextureEnds> ends;
  std::optional<schema::Gain> gain;
  bool implausible = false;       ///< accept a transducer with implausible numbers
  bool unfit_transducer = false;  ///< accept a transducer whose file states that its model does not fit
  TickBudget budget = {};         ///< chooses interpolation and inverse, if requested
  /// Accept a displacement beyond the tray's limit: on an emulated device, to see the effect of the other
  /// limits.
  bool any_displacement = false;
  schema::PlaybackChoices choices = {};   ///< before those of the scene
  schema::PlaybackChoices defaults = {};  ///< for what neither they nor the scene set
  /// `file` and all its files must be in this folder (served_file); none: anywhere
  std::optional<std::string> only_in = {};
};

/// Ready to upload. Only the player adds the rest of `session`: device, clock, initial state.
struct Program {
  Prepared prepared;
  schema::SessionHeader session;
  std::string scene_path;   ///< empty for a single texture
  double tray_peak_m = 0;   ///< largest displacement of the tray, at a factor of 1 (displacement_limit.hpp)
  double gain_m_per_n = 0;  ///< the largest of the textures' gains, with its sign
  double default_gain_m_per_n = 0;                ///< the same without the gain of the request
  std::optional<schema::PlaybackGain> kept_gain;  ///< the gain stored with the texture, if that is used
  double start_m = 0;                             ///< of the first texture
  double length_m = 0;                            ///< from the first texture's start to the last one's end
  double reach_m = 0;                             ///< from the encoder's zero; beyond it nothing is read
  std::optional<TickDecision> decision;           ///< of the request's budget
  PrepareOptions options;                         ///< with which it was prepared

  /// The scene's file, or the texture's.
  const std::string& name() const { return scene_path.empty() ? session.textures.front().file : scene_path; }
};

/// Reads the files, and prepares. `options`: rate, encoder, limits; gain and ends are taken from the request
/// or the scene, and choices from request, scene and defaults, in this order. Errors: as read_texture,
/// read_scene, read_transducer, prepare, decide, find_trade_table; unsuitable: as check_usable; more textures
/// than fit into a session; a scene of several textures whose ends are not `stop`; usage: a place or gain for
/// a scene; as check_consistent, for the request.
schema::Result<Program> make_program(const ProgramRequest& request, const std::string& transducer,
                                     PrepareOptions options);

/// The device refuses a longer onset. Errors: usage.
schema::Result<void> check_onset(double onset_s);

}  // namespace tacto::playback
