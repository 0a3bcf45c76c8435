// SPDX-License-Identifier: GPL-3.0-or-later
// What all operations of this folder keep of a texture, and how they add their step. Internal to this folder.
#pragma once

#include <utility>
#include <vector>

#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

/// A texture with new values: grid, quantity, place, surface and notes are the old one's; source, average,
/// certificate and unknown members, which describe the old values, are left out. `step` is added to its
/// transform.
schema::Texture transformed(const schema::Texture& texture, std::vector<double> values,
                            schema::TransformStep step);

}  // namespace tacto::spatial
