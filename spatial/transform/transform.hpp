// SPDX-License-Identifier: GPL-3.0-or-later
// Textures from textures: gain, band-pass along position, and sums. (Stretching: stretch.hpp)
#pragma once

#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

/// Reads a texture whose transform names this file as the source and has no steps yet. The functions of this
/// folder append their steps. Errors: of schema::read_texture.
schema::Result<schema::Texture> read_transform_source(const std::string& name);

/// All values times `gain`; below 0 the texture is inverted. Errors: usage, for 0 and what is not finite.
schema::Result<schema::Texture> with_gain(const schema::Texture& texture, double gain);

/// The content between two spatial frequencies, with zero phase (filter_in_space: Fourier, treated ends).
/// Errors: unsuitable, of filter_in_space.
schema::Result<schema::Texture> filtered(const schema::Texture& texture, double low_per_m, double high_per_m);

/// The sum of the textures times their weights, over the length of the shortest, on the finest of their
/// grids; coarser ones are interpolated by the windowed sinc. Valid is the band that is valid in all of them.
/// Their sources come one after the other. Preconditions: one weight for each texture; no texture has steps
/// yet. Errors: usage: fewer than two textures, a weight that is 0 or not finite; unsuitable: other
/// quantities, units.
schema::Result<schema::Texture> mix(std::span<const schema::Texture> textures,
                                    std::span<const double> weights);

}  // namespace tacto::spatial
