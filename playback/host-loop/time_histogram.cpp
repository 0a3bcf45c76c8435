// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/host-loop/time_histogram.hpp"

#include <fmt/format.h>

namespace tacto::playback {

std::string late_part_name(double bound_s) {
  return fmt::format("late_over_{:g}us_part", 1e6 * bound_s);
}

}  // namespace tacto::playback
