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
  /// Of Welch's spectrum; unless told, a quarter of that part, but eight wavelengths of the valid band's
  /// lower end where the texture has them.
  std::optional<double> window_m;
};

/// Welch's power spectral density S(k) of the whole texture (Welch 1967: Hann windows of length W, half
/// overlapping, each without its mean; the same as scipy.signal.welch(x, 1 / pitch, 'hann', W)), taken as
/// constant within half a bin of each bin, between k1 and k2: the band that is valid all along, from 1.5 / W
/// (a Hann window's noise bandwidth) to half the sampling frequency. Then
///   RMS                 sqrt(int_k1^k2 S dk)
///   centroid            int k S dk / int S dk                                             (Peeters
///   2004, 6.1.1) band b              sqrt(int S dk) between f_b / G^(1/6) and f_b G^(1/6), f_b = G^(b/3) per
///   mm, G = 10^0.3
///                       (IEC 61260-1:2014, 5.2 to 5.5, base 10; its reference frequency is 1 /mm here; ideal
///                       edges, no filter's skirts); `partial` where k1 or k2 cuts it
///   slope               b of the least-squares line 10 log10 S_b = a + b log2 f_b through the bands' mean
///   densities
///                       S_b, at the geometric middle of what is known of each, weighted by their known width
///                       in octaves: dB per octave, 0 for white noise; needs an octave, else NaN
/// In the whole band the RMS agrees with the samples' (Parseval) but for what lies under 1.5 / W and for the
/// first and last half window, which weigh less. Errors: usage (a window under 8 samples or longer than that
/// part); unsuitable (no common valid band, fewer than 8 samples).
schema::Result<schema::Description> describe(const schema::Texture& texture,
                                             const DescriptionOptions& options = {});

}  // namespace tacto::spatial
