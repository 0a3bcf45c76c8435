// SPDX-License-Identifier: GPL-3.0-or-later
// Standard descriptions of a texture in a few numbers: one-third-octave bands of spatial frequency, RMS,
// spectral centroid and slope, all within its valid band.
#pragma once

#include <optional>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/description.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

struct DescriptionOptions {
  /// Length of Welch's windows. Default: a quarter of the part at steady speed, but at least eight
  /// wavelengths of the valid band's lower limit if the part is that long.
  std::optional<double> window_m;
};

/// Welch's power spectral density S(k) of the whole texture (Welch 1967: Hann windows of length W, half
/// overlapping, each without its mean; the same as scipy.signal.welch(x, 1 / pitch, 'hann', W)). It is
/// constant within half a bin of each bin, between k1 and k2: the band that is valid along the whole part,
/// from 1.5 / W (a Hann window's noise bandwidth) to half the sampling frequency. Then
///   RMS = sqrt(int_k1^k2 S dk)
///   centroid = int k S dk / int S dk (Peeters 2004, 6.1.1)
///   band b = sqrt(int S dk) between f_b / G^(1/6) and f_b G^(1/6), f_b = G^(b/3) per mm, G = 10^0.3 (IEC
///     61260-1:2014, 5.2 to 5.5, base 10, with 1 /mm as reference frequency and ideal edges); a band that k1
///     or k2 cuts is `partial`
///   slope = coefficient c of the least-squares line 10 log10 S_b = a + c log2 f_b through the bands' mean
///     densities S_b, at the geometric middle of the known part of each band, weighted by the width of that
///     part in octaves: dB per octave, 0 for white noise; NaN for less than an octave
/// In the whole band the RMS agrees with that of the samples (Parseval), except for the content below 1.5 / W
/// and for the first and last half window, which have less weight. Errors: usage (a window of fewer than 8
/// samples or longer than the part); unsuitable (no common valid band, fewer than 8 samples).
schema::Result<schema::Description> describe(const schema::Texture& texture,
                                             const DescriptionOptions& options = {});

}  // namespace tacto::spatial
