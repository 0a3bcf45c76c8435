// SPDX-License-Identifier: GPL-3.0-or-later
// An upper bound of the stiffness of a field of atoms.
#pragma once

#include "playback/prepare/scene/field_section.hpp"

namespace tacto::playback {

/// A bound from above of the largest eigenvalue, absolute, of the derivative of the force by the place, for a
/// force_scale of 1: of all places in the patch and of all z_m of its slider. It is at most 2 % above the
/// largest; more where 6 million evaluations of an atom do not suffice for that. For one atom in the section
/// it is exact: 24 epsilon / sigma^2 (26 core^-14 - 7 core^-8); 57.146 epsilon / sigma^2 where the force is
/// zero.
double stiffest_n_per_m(const FieldSection& section, const schema::LayerNumber& z_m,
                        const schema::Patch& patch);

}  // namespace tacto::playback
