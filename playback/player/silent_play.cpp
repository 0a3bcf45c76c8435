// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/silent_play.hpp"

#include <fmt/format.h>

#include "data-schema/base/quantity.hpp"

namespace tacto::playback {
namespace {

using schema::length_for_people;

std::string from_to(double from_m, double to_m) {
  return fmt::format("from {} to {}", length_for_people(from_m), length_for_people(to_m));
}

std::string reason(const TickView& ticks, const PlayableRange& what) {
  const double from_m = ticks.least_position_m(), to_m = ticks.greatest_position_m();
  if (what.contact_on_n > 0 && ticks.gated() > 0)
    return fmt::format("the normal force stayed below the {:g} N at which the drive begins (--contact)",
                       what.contact_on_n);
  if (what.stops && (to_m < what.start_m || from_m > what.end_m))
    return fmt::format("the finger moved {}, the texture is {} (--at, or at_m in the scene)",
                       from_to(from_m, to_m), from_to(what.start_m, what.end_m));
  if (from_m > what.reach_m || to_m < -what.reach_m)
    return fmt::format(
        "the finger moved {}; farther than {:.4g} m from the encoder's zero no texture is read (begin "
        "nearer)",
        from_to(from_m, to_m), what.reach_m);
  return fmt::format("the finger moved {}", from_to(from_m, to_m));
}

}  // namespace

PlayableRange playable_range(const Program& program) {
  return {program.start_m, program.start_m + program.length_m, program.options.ends == Ends::stop,
          program.options.contact_on_n, program.reach_m};
}

std::optional<std::string> note_of_silence(const TickView& ticks, const PlayableRange& what) {
  if (ticks.ticks() == 0 || ticks.drive_peak_v() > 0) return std::nullopt;
  return "nothing was played, the drive stayed at 0 V: " + reason(ticks, what);
}

std::optional<std::string> note_off_textures(double share, double finger_from_m, double finger_to_m,
                                             const PlayableRange& what) {
  if (share <= kMostOffTextures) return std::nullopt;
  return fmt::format(
      "the finger was off the texture for {:.0f} % of the time: the finger moved {}, the texture is {}; move "
      "the texture (--at, or at_m in the scene), continue it (--ends mirror or loop), or change the path",
      100 * share, from_to(finger_from_m, finger_to_m), from_to(what.start_m, what.end_m));
}

std::optional<std::string> note_off_textures(const TickView& ticks, const PlayableRange& what) {
  return note_off_textures(ticks.off_textures(), ticks.least_position_m(), ticks.greatest_position_m(), what);
}

}  // namespace tacto::playback
