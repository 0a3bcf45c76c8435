// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/fidelity/emulated_pass.hpp"

#include <fmt/format.h>

#include <cmath>

#include "analysis/fidelity/scratch_folder.hpp"
#include "playback/model/finger_path.hpp"

namespace tacto::analysis {
namespace {

using playback::FingerPath;
using schema::ErrorKind;
using schema::Result;

constexpr double kBesideS = 0.25;  // before the texture, for the drive's initial ramp, and behind it

FingerPath straight_path(const schema::Texture& texture, double at_m, double speed_mps) {
  const double way_m = texture.signal.length_m() + 2 * kBesideS * speed_mps;
  const double from_m = at_m - kBesideS * speed_mps;
  return {{0, way_m / speed_mps}, {from_m, from_m + way_m}};
}

// Tick i is (i + 1) periods after arming. The emulated finger starts at arming.
std::vector<double> true_positions(const FingerPath& path, double rate_hz, std::size_t ticks) {
  auto positions = playback::positions_along(path, rate_hz, ticks + 1);
  positions.erase(positions.begin());
  return positions;
}

Result<void> check_counts(const EmulatedPass& pass) {
  const double step_m = pass.columns.header.metres_per_count;
  for (std::size_t i = 0; i < pass.position_m.size(); ++i)
    if (std::abs(pass.columns.position_m[i] - pass.position_m[i]) > 1.01 * step_m)
      return schema::fail(ErrorKind::internal, "the emulated finger was not where its path is",
                          fmt::format("tick {}", pass.columns.tick[i]));
  return {};
}

Result<void> check_played(const EmulatedPass& pass, const std::string& device) {
  if (pass.outcome.status.state == playback::PlayerState::fault)
    return schema::fail(ErrorKind::device, "playing ended in a fault: " + pass.outcome.status.fault, device);
  if (pass.columns.lost_at)
    return schema::fail(ErrorKind::device, fmt::format("{} ticks were lost", pass.columns.lost), device);
  return check_counts(pass);
}

}  // namespace

Result<EmulatedPass> emulated_pass(const schema::Texture& texture, playback::PlayOptions options,
                                   double speed_mps, const std::function<bool()>& stop_asked,
                                   const std::function<void(double)>& progress) {
  const auto scratch = ScratchFolder::make();
  TACTO_TRY(scratch);
  const FingerPath path = straight_path(texture, options.program.at_m.value_or(0), speed_mps);
  options.finger_path = path;
  options.session = *scratch / "pass.session";
  options.program.any_displacement = options.device_uri.starts_with("sim:");
  auto outcome = playback::play_once(options, stop_asked, progress);
  TACTO_TRY(outcome);
  if (stop_asked()) return schema::fail(ErrorKind::usage, "stopped before the end", "fidelity");
  auto columns = playback::read_session_columns(options.session);
  TACTO_TRY(columns);
  EmulatedPass pass{std::move(*columns), std::move(*outcome), {}};
  // The final ramp of the drive is longer than the path, at the end of which the finger rests.
  const auto along = static_cast<std::size_t>(path.duration_s() * pass.columns.header.rate_hz);
  pass.position_m =
      true_positions(path, pass.columns.header.rate_hz, std::min(along, pass.columns.tick.size()));
  TACTO_TRY(check_played(pass, options.device_uri));
  return pass;
}

}  // namespace tacto::analysis
