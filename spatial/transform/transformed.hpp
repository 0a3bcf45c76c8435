// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a texture with new values from another one, with its metadata and one more step in its history.
// Internal to this folder.
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
