// SPDX-License-Identifier: GPL-3.0-or-later
// `render` and `explain` of a scene of force patches on a force device.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/command/output_options.hpp"
#include "firmware-host/boards/boards.hpp"
#include "playback/prepare/scene/stable_scene.hpp"

namespace tacto::playback {

/// --device; `device` must outlive the parser, here and below.
void declare_force_device(CLI::App& app, std::string& device);

/// --hand
void declare_hand(CLI::App& app, std::string& hand);

/// --hold-stable
void declare_hold_stable(CLI::App& app, bool& hold_stable);

/// The layers whose stiffness was scaled, by which margin, and those that were not judged.
void add_held(cli::Report& report, const std::vector<HeldLayer>& held,
              const std::vector<std::string>& unknown);

/// Errors: usage, if an option was given that is not among `names`: the others are those of a tray.
schema::Result<void> check_force_options(const CLI::App& app, std::initializer_list<std::string_view> names);

struct ForceRendering {
  std::string scene, device, path, output;
  std::string hand;  ///< empty: the path is imposed
  std::optional<double> rate_hz;
  schema::Existing existing = schema::Existing::keep;
  bool hold_stable = false;
};

/// Writes the forces along the path as a CSV.
schema::Result<cli::Report> render_forces(const ForceRendering& asked);

/// The layers with their memory and time, and whether they fit the device: in `device_bytes`, or on `board`
/// if it is not null.
schema::Result<cli::Report> explain_forces(const std::string& scene, const std::string& device,
                                           const std::string& hand, std::optional<double> rate_hz,
                                           std::optional<std::size_t> device_bytes,
                                           const boards::Board* board);

}  // namespace tacto::playback
