// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/construction_tally.hpp"

#include <fmt/format.h>

#include "playback/prepare/prepare.hpp"

namespace tacto::playback {
namespace {

LeftOut levels_left_out(const Prepared& prepared) {
  const double coarsest_per_m = prepared.finest_per_m * std::exp2(-0.5 * (prepared.scale.levels - 1));
  return {fmt::format("{} of {} levels", wire::kMaxLevels - prepared.scale.levels, wire::kMaxLevels),
          fmt::format("no content is finer than {:.4g} /mm, no finger faster than {:.3g} m/s is expected",
                      1e-3 * prepared.finest_per_m, prepared.passes_to_hz / coarsest_per_m)};
}

}  // namespace

std::vector<LeftOut> left_out_of(const Prepared& prepared) {
  const ConstructionTally& built = prepared.built;
  std::vector<LeftOut> left_out;
  const auto tell = [&](std::size_t count, const char* part, const char* because) {
    if (count == 0) left_out.push_back({part, because});
  };
  tell(built.seams, "a loop's seam",
       prepared.loop_period_m > 0 ? "the texture's end meets its beginning" : "the texture is not a loop");
  if (built.levels < wire::kMaxLevels) left_out.push_back(levels_left_out(prepared));
  tell(built.filters, "a filter that inverts the transducer", "only its gain, or no inverse, was requested");
  tell(built.hysteresis, "play operators that invert a hysteresis",
       "the transducer's file has no hysteresis, or it is not inverted");
  tell(built.sections, "recursive sections", "only the inverse of a hysteresis needs them");
  tell(built.energy_limits, "an energy limit", "no limit was requested");
  tell(built.touch_gates, "a touch gate", "no contact force was requested");
  tell(built.following, "looking ahead and the timing of edges", "turned off");
  left_out.push_back(
      {"memory for another texture", "only a texture that is loaded during playback needs it"});
  return left_out;
}

}  // namespace tacto::playback
