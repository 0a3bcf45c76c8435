// SPDX-License-Identifier: GPL-3.0-or-later
// Times and lengths of a playback where its user names none.
#pragma once

namespace tacto::schema {

inline constexpr double kOnsetS = 0.02;    ///< in which the drive rises
inline constexpr double kReleaseS = 0.01;  ///< in which it falls
inline constexpr double kSeamM = 1e-3;     ///< of a loop whose end does not meet its beginning

}  // namespace tacto::schema
