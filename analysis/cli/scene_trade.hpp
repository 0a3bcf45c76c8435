// SPDX-License-Identifier: GPL-3.0-or-later
// `trade` of a scene of force patches on a force device.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/command/output_options.hpp"

namespace tacto::analysis {

/// For the help of the verb.
inline constexpr const char* kSceneTradeRule =
    "With --device: the choices are the octaves of noise, the filter of triangular and square grooves, the "
    "finest level of height maps and textures, and the rates of the device. Each has its largest error "
    "against the scene in double precision, the time of a tick, its memory, and the largest stable "
    "stiffness, "
    "as 'design' computes it. --max-error and --max-tick choose octaves and filters; the chosen scene is "
    "played, rendered and explained as any other. An error that cannot be promised is refused.";

struct SceneTradeOptions {
  std::string device, hand, path;
  std::optional<double> rate_hz, max_error_n, max_tick_s;
};

/// --device, --hand, --rate, --finger-path, --max-error, --max-tick; `options` must outlive the parser.
void declare_scene_trade(CLI::App& app, SceneTradeOptions& options);

/// Errors: usage, if an option of a tray was given with --device, or one of those above without it.
schema::Result<void> check_trade_options(const CLI::App& app);

schema::Result<cli::Report> run_scene_trade(const std::string& scene, const SceneTradeOptions& options,
                                            const std::vector<std::string>& outputs,
                                            schema::Existing existing);

}  // namespace tacto::analysis
