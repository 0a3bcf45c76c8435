// SPDX-License-Identifier: GPL-3.0-or-later
// How many standard errors half a 95 % interval is wide.
#pragma once

namespace tacto::analysis {

inline constexpr double kNormal95 = 1.959964;  // of the normal distribution, two-sided

/// Student's t, two-sided 95 %: within 0.5 % from 4 degrees of freedom on (Cornish and Fisher's expansion).
double student_95(double freedom);

}  // namespace tacto::analysis
