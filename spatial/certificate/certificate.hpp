// SPDX-License-Identifier: GPL-3.0-or-later
// The speed certificate: a peak that keeps its frequency in 1/m at all speeds belongs to the surface; one
// that keeps its frequency in Hz does not.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/certificate.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

/// The texture must outlive the call of certify().
struct TextureAtSpeed {
  std::string name;
  const schema::Texture* texture = nullptr;
};

struct CertificateOptions {
  /// Smallest probability at which a peak is classified.
  double confidence = 0.95;
};

/// Classifies each peak that is found in the mean spectrum of any texture (of its part at steady speed), over
/// position and over time. Time follows from position by the speed, which is the ratio of the valid band's
/// limits in Hz and in 1/m. So uneven speed within a stroke is evidence too.
///
/// A peak found in texture i at k and f = k v_i is tested in each other texture j against both hypotheses: a
/// line at k (spatial), a line at f (temporal). The evidence is the likelihood ratio of probabilistic data
/// association (Bar-Shalom and Tse 1975, Automatica 11(5)),
///   L_j = 1 - P_D + P_D sum_m N(d_m; sigma) / clutter,
/// over the lines m of j at distances d_m from the prediction. N is normal with the uncertainties of both
/// lines, 0.1 % of k for the scale of positions or 0.3 % of f for that of speeds. Clutter is the number of
/// lines of j per unit of frequency. P_D, the probability of detecting the line in j, follows from its power
/// over the background of j; this ratio may differ by 6 dB (standard deviation). L_j is 1 (no evidence) where
/// the prediction is outside the valid band of j, where another line hides it, or where the line found there
/// is already classified. The uneven speed of the texture's own stroke is further evidence: the smearing of a
/// line in the wrong domain lowers its prominence there. It counts at most e^3.
///   confidence = L_spatial / (L_spatial + L_temporal + 1), where the 1 is for "neither".
/// The peak with the highest confidence is classified first and its lines in all textures are marked as used;
/// then the remaining peaks are evaluated again. Of 200 simulated cases at most 5 % of the classified peaks
/// are classified wrongly (tests/spatial/certificate_test.cpp).
///
/// Returns one certificate per texture, in the order of the textures. All have the same peaks, with the
/// frequencies of that texture. Errors: usage (fewer than two textures, a confidence not between 0.5 and 1);
/// unsuitable (units differ; no speed is known; fewer than 64 samples or a band too narrow; speeds that
/// differ too little, with the ratio that is required).
schema::Result<std::vector<schema::Certificate>> certify(std::span<const TextureAtSpeed> textures,
                                                         const CertificateOptions& options = {});

}  // namespace tacto::spatial
