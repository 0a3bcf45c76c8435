// SPDX-License-Identifier: GPL-3.0-or-later
// The colours of lines, texts and areas in pictures. Those of a spectrogram's levels:
// engine/heatmap_pixels.cpp.
#pragma once

#include <array>
#include <cstddef>

#include "spatial/picture/draw/geometry.hpp"

namespace tacto::spatial {

inline constexpr Colour kInk{0.10, 0.10, 0.12};
inline constexpr Colour kGreyInk{0.38, 0.38, 0.42};
inline constexpr Colour kGridLine{0.86, 0.86, 0.88};
inline constexpr Colour kAlarm{0.76, 0.20, 0.10};
inline constexpr Colour kTrace{0.16, 0.28, 0.45};     ///< a texture above its spectrogram
inline constexpr Colour kNoWindow{0.93, 0.93, 0.94};  ///< where no window of a spectrogram fits

/// Colours that colour-blind people can distinguish, also in grey (Okabe and Ito 2008): blue, vermilion,
/// green, ...
constexpr Colour series_colour(std::size_t index) {
  constexpr std::array<Colour, 6> kSeries = {{{0.000, 0.447, 0.698},
                                              {0.835, 0.369, 0.000},
                                              {0.000, 0.620, 0.451},
                                              {0.800, 0.475, 0.655},
                                              {0.337, 0.706, 0.914},
                                              {0.902, 0.624, 0.000}}};
  return kSeries[index % kSeries.size()];
}

}  // namespace tacto::spatial
