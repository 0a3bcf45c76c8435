// SPDX-License-Identifier: GPL-3.0-or-later
// One-third-octave bands of spatial frequency.
#pragma once

#include <vector>

#include "data-schema/texture/description.hpp"

namespace tacto::spatial {

/// The bands that overlap [low_per_m, high_per_m], with ideal edges f_b / G^(1/6) and f_b G^(1/6), f_b =
/// G^(b/3) per mm, G = 10^0.3 (IEC 61260-1:2014, 5.2 to 5.5, base 10, with 1 /mm as reference frequency). A
/// band that the range cuts is `partial`; rms and density are 0. Precondition: 0 < low_per_m < high_per_m,
/// finite.
std::vector<schema::ThirdOctaveBand> third_octaves(double low_per_m, double high_per_m);

}  // namespace tacto::spatial
