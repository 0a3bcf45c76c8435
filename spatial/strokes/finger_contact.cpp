// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/finger_contact.hpp"

#include <algorithm>

#include "data-schema/base/quantity.hpp"

namespace tacto::spatial {

double finger_up_below_n(std::span<const Stroke> strokes) {
  double hardest_n = 0;
  for (const Stroke& stroke : strokes) hardest_n = std::max(hardest_n, stroke.force_n.value_or(0));
  return std::max(kLightestTouch_n, kUpShareOfHardest * hardest_n);
}

std::string why_finger_up(double threshold_n) {
  return schema::for_people(threshold_n, schema::Dimension::force) +
         (threshold_n > kLightestTouch_n ? ", a tenth of the largest mean force of a stroke"
                                         : ", the least force of a touch");
}

}  // namespace tacto::spatial
