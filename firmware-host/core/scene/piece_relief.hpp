// SPDX-License-Identifier: Apache-2.0
// A plane that a height map raises: its surface, where a straight way enters it, and the place on it to which
// a point slides.
#pragma once

#include "firmware-host/core/scene/piece.hpp"

namespace tacto::core {

/// Precondition: the table of a piece of the kind relief.
inline const ReliefPieceTable& relief_piece(const PieceTable& table) noexcept {
  static_assert(__builtin_offsetof(ReliefPieceTable, piece) == 0);
  return reinterpret_cast<const ReliefPieceTable&>(table);
}

/// As surface_at(): the height over the surface along the plane's normal by the size of its gradient, exact
/// on the surface and beside it to the second order. Safe in the tick.
PieceSurface relief_surface_at(const ReliefPieceTable& table, SpaceVector place) noexcept;

/// Steps of relief_entry(), and of slid_on_relief().
inline constexpr int kReliefEntrySteps = 24, kSlideSteps = 16;

/// As entry_of(). For a point on the surface `under_m` > 0: where it would be this far under the surface;
/// deeper points are not stopped. Each step goes as far as a surface of the largest second derivative of the
/// heights (ReliefPieceTable::bend_per_m) surely leaves free, so that no hill is passed; where
/// kReliefEntrySteps do not lead to the surface or the end of the way, the part that they led to. Safe in the
/// tick.
float relief_entry(const ReliefPieceTable& table, SpaceVector place, SpaceVector way, float under_m) noexcept;

/// As bend_of(). Safe in the tick.
float relief_bend(const ReliefPieceTable& table, SpaceVector place, SpaceVector way) noexcept;

/// From the place of the surface over `start` along the surface towards the hand: Newton's method for the
/// least distance, or down its slope where it is not convex, by at most one sample of the map a step and
/// never away from the hand. So it stays on its side of each hill, and ends after kSlideSteps on its way or
/// where it is nearest in its neighbourhood. Safe in the tick.
SpaceVector slid_on_relief(const ReliefPieceTable& table, SpaceVector hand, SpaceVector start) noexcept;

}  // namespace tacto::core
