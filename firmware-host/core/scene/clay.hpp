// SPDX-License-Identifier: Apache-2.0
// Clay: the heights of a relief that sink where a point presses it (Massie 1996, section 3.7.1).
#pragma once

#include "firmware-host/core/scene/piece_relief.hpp"

namespace tacto::core {

/// With d = 2 half_m: the 4 grid points of the cell at a place, from the origin of the piece, sink by d, and
/// the 8 next to them by d / 2. So n presses in one cell make the paraboloid 9/8 (1 - r^2 / 4.5) d n at the
/// 16 points around it, r in grid steps from its middle, and take 8 d n from the sum of the heights. With
/// `kept` each of the 16 points around those 16, but for the corners, rises by d / 2: those at r^2 = 8.5 get
/// it from the nearest of the 4, those at 6.5 from the nearest of the 8. A point stays that would sink below
/// least_m, or whose parts would leave the grid or most_m: so the sum of the heights is kept everywhere. The
/// surface in the cell depends on the 16 points alone: it never rises under the point that presses.
/// Afterwards bend_per_m is that of the new heights, too. A place beside the grid changes nothing.
/// Precondition: the table is in the kernel's own memory (SceneView::as_in()). Safe in the tick: a fixed
/// number of steps.
void press_clay(ReliefPieceTable& table, SpaceVector place) noexcept;

/// At least the largest second derivative of the surface, in any direction, that the heights from `reach`
/// before a grid point to `reach` + 1 behind it have a share in, reach at most 2.
float clay_bend_per_m(const ReliefPieceTable& table, int32_t column, int32_t row, int reach) noexcept;

}  // namespace tacto::core
