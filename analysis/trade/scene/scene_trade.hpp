// SPDX-License-Identifier: GPL-3.0-or-later
// What each choice of a scene of force patches costs on a force device, and what it changes.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/design/design.hpp"
#include "analysis/trade/rows/trade_row.hpp"
#include "analysis/trade/scene/scene_runs.hpp"

namespace tacto::analysis {

struct SceneTradeRequest {
  DesignRequest design;  ///< device, rate, hand; `judged` is the limit of the fourth column
  std::optional<AxisPaths> path = std::nullopt;  ///< none: strokes_over()
  std::optional<double> max_error_n = std::nullopt, max_tick_s = std::nullopt;
};

/// In the row that is the scene as its file has it.
inline constexpr const char* kAsItIs = "as it is";

struct SceneTradeRow {
  TradeRow row;
  /// Of the difference from the reference along the paths: largest, RMS; NaN, with all numbers of the row, at
  /// a rate at which the scene cannot be prepared.
  double error_n = 0, error_rms_n = 0;
  /// The same for any path, at any speed up to kFastestHandMps; NaN: not promised, measured only.
  double promised_n = std::numeric_limits<double>::quiet_NaN();
  double stiffness_n_per_m = 0, limit_n_per_m = 0;  ///< of all layers that act there; NaN: not known
  std::string verdict;                              ///< of Stability
};

/// The scene that keeps what was asked.
struct SceneChoice {
  schema::Scene scene;               ///< as it was, with the changed layers
  std::vector<std::string> changed;  ///< "octaves of noise 0 of 'sand': 2 octaves"
  double promised_n = 0, error_n = 0;
  double tick_s = 0;  ///< of the most expensive path
  std::size_t bytes = 0;
  std::string verdict;  ///< of the worst layer
  /// Filters or added dampers are numbers now, chosen for this device, rate and hand.
  bool is_for_loop = false;
};

struct SceneTrade {
  std::string scene, device, machine;
  std::string hand;     ///< or that nothing holds the device
  std::string assumed;  ///< of the places of patches; empty: there is one patch
  double rate_hz = 0;
  std::string paths;           ///< along which the errors are measured
  std::string timed_along;     ///< the paths of the costs
  double largest_force_n = 0;  ///< of the reference along them
  double rounding_n = 0;       ///< what can be promised of the scene as it is
  std::vector<SceneTradeRow> rows;
  std::size_t not_promised = 0;             ///< rows
  std::vector<std::string> without_choice;  ///< "spring 0 of 'pool'"
  std::optional<SceneChoice> chosen = std::nullopt;
};

/// Knobs: those of layer_knobs(); "finest level" of each height map and texture (its levels from the second,
/// third, fifth on: half an octave, one and two octaves of its highest frequencies are left out);
/// "rate" of the device. Of a layer the reference is ExactScene of the scene as it is, at the request's rate;
/// of the rate it is ExactScene at the device's largest rate at which the scene can be prepared, and forces
/// are held from tick to tick. All forces are those before the limits of the device. Cost: of a tick of the
/// whole scene along strokes_over(), of the rate per ms of playing; memory: the block and the kernel's state.
/// The stiffness and its limit are those of design_scene().
///
/// With max_error_n or max_tick_s it chooses members of layers: step by step the one that saves most time for
/// the force that it changes, as long as the sum over the layers that act together, rounding included, keeps
/// the error; with max_tick_s until a tick is that short. `where` is the scene's file. Errors: those of
/// playback::prepare_scene() and design_scene(); unsuitable: a path that leaves the travel or has over 2^22
/// ticks; an error below rounding_n, or a tick below that of the smallest scene that keeps the error.
schema::Result<SceneTrade> trade_scene(const schema::Scene& scene, const std::string& where,
                                       const SceneTradeRequest& request,
                                       const std::function<void(double)>& progress);

}  // namespace tacto::analysis
