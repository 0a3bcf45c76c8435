// SPDX-License-Identifier: GPL-3.0-or-later
// The speed certificate: what stays in 1/m while the speed changes is the surface's; what stays in Hz is not.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/certificate.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

/// The texture must outlive the work.
struct TextureAtSpeed {
  std::string name;
  const schema::Texture* texture = nullptr;
};

struct CertificateOptions {
  /// Probability from which on a peak is called.
  double confidence = 0.95;
};

/// Calls each peak that is found in any of the textures' mean spectra (of their parts at steady speed), over
/// position and over time (x to t by the speed that the valid band tells, so that unevenness within a stroke
/// counts too).
///
/// A peak found in texture i at k and f = k v_i is held against both hypotheses in each other texture j: a
/// line at k (spatial), a line at f (temporal). The evidence is the likelihood ratio of probabilistic data
/// association (Bar-Shalom and Tse 1975, Automatica 11(5)),
///   L_j = 1 - P_D + P_D sum_m N(d_m; sigma) / clutter,
/// over the lines m of j at distances d_m from the prediction; N is normal with the uncertainties of both
/// lines, 0.1 % of k for the scale of positions or 0.3 % of f for that of speeds; clutter is j's lines per
/// unit of frequency; P_D, the chance that the line would be seen there, follows from its power over j's
/// background, which may differ by 6 dB (standard deviation). L_j is 1, nothing, where j does not know the
/// place (outside of its valid band), where another line hides it, or where the line that lies there is
/// called already. The unevenness of the own stroke adds its part: a line is sharper in its own domain by
/// what its smearing costs in the other; at most e^3.
///   confidence = L_spatial / (L_spatial + L_temporal + 1), the 1 standing for neither.
/// The surest peak is called first and its lines in all textures are spoken for; then the rest is weighed
/// again. Of 200 simulated cases at most 5 % of the called peaks are called wrongly
/// (tests/spatial/certificate_test.cpp).
///
/// Gives one certificate a texture, in their order: peaks are the same, with frequencies as they lie in it.
/// Errors: usage (fewer than two textures, a confidence not between 0.5 and 1); unsuitable (units differ; no
/// speed is known; fewer than 64 samples or a band too narrow; speeds that differ too little, saying what
/// would do).
schema::Result<std::vector<schema::Certificate>> certify(std::span<const TextureAtSpeed> textures,
                                                         const CertificateOptions& options = {});

}  // namespace tacto::spatial
