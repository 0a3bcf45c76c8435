// SPDX-License-Identifier: GPL-3.0-or-later
// What can be chosen of the layers of a scene, and how much a choice changes the force at most.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "playback/prepare/scene/prepared_scene.hpp"

namespace tacto::analysis {

/// A layer, some of its members changed.
struct LayerChoice {
  std::string choice;  ///< "2 octaves", "filter 1.2 mm"
  schema::ForceLayer layer;
  /// The largest change of the force on a hand at any place and speed, with the worse ends of the sliders.
  double change_n = 0;
};

/// The choices of one layer: first the layer as it is, then each with less work in a tick.
struct LayerKnob {
  std::size_t patch = 0, index = 0;  ///< in the scene, in the patch
  std::string name;                  ///< "octaves of noise 0 of 'sand'"
  std::vector<LayerChoice> choices;
};

/// The largest slope of one octave of noise in a plane z = 0, per cell: that of the middle of a cell whose
/// corners have the worst of the eight gradients. There each corner gives 1/4 + 15/8 1/2 (1/2 + 1/2) - 1/2 =
/// 11/16 along x.
inline constexpr double kNoiseSlope = 2.75;

/// - noise: fewer octaves; those that stay keep their amplitudes, so the depth changes with them. Each
///   octave left out changes the slope by at most amplitude 2^i kNoiseSlope / period.
/// - triangular and square grooves: a wider filter, from period / 64 to period / 4, where it leaves fewer
///   harmonics. With the amplitudes a, then b, the slope changes by at most the sum of 2 pi n |a - b| /
///   period.
/// Both hold at any speed, because a speed multiplies each octave and harmonic by 0 to 1. Layers without a
/// choice have no knob. Precondition: grooves have a filter.
std::vector<LayerKnob> layer_knobs(const std::vector<schema::Patch>& patches);

/// How much the force of a layer in single precision differs from that in double precision at most: by the
/// bounds of core's groove_at(), noise() and relief_at(), of a place and a speed of up to kFastestHandMps in
/// single precision, with a margin of at least two.
double rounding_bound_n(const schema::Patch& patch, const schema::ForceLayer& layer,
                        const playback::Reliefs& reliefs);

}  // namespace tacto::analysis
