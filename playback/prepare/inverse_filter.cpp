// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/inverse_filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "data-schema/base/decibels.hpp"

namespace tacto::playback {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kGrid = 1000;  // steps from 0 to half the rate
constexpr double kFilterS = 3.2e-3;
constexpr double kLeastTaps = 24, kMostTaps = wire::kMaxTaps;
constexpr double kBelowBandWeight = 0.3;
constexpr double kBeyondBandWeight = 1e-3;
constexpr double kBandMargin = 1.01;
constexpr double kFirstPenalty = 1e-9, kLeastRaisedPenalty = 1e-8;
constexpr double kAim = 0.95;  // of the largest permitted gain
constexpr double kRidge = 1e-12;
constexpr int kMostLawsonRounds = 80;

double decibels(double ratio) {
  return schema::amplitude_db(std::max(ratio, 1e-30));
}

class Designer {
 public:
  Designer(const Chain& chain, Inverse inverse, const spatial::Band& band, const InverseDesign& design)
      : rate_hz_(chain.sample_rate_hz), band_(band), design_(design) {
    const double at_rest = std::abs(chain_response(chain, 0));
    for (std::size_t k = 0; k <= kGrid; ++k) {
      const Complex response = chain_response(chain, frequency_hz(k)) / at_rest;
      responses_.push_back(inverse == Inverse::magnitude ? std::abs(response) : response);
      leads_.push_back(std::abs(lead_response(chain, frequency_hz(k))));
    }
    for (std::size_t i = 0; i < 2 * kGrid; ++i)
      turns_.push_back(std::polar(1.0, -std::numbers::pi * static_cast<double>(i) / kGrid));
  }

  /// For the normalised chain.
  std::vector<double> taps() {
    const double usual = 4 * std::ceil(kFilterS * rate_hz_ / 4);
    count_ =
        design_.taps > 0 ? design_.taps : static_cast<std::size_t>(std::clamp(usual, kLeastTaps, kMostTaps));
    penalties_.assign(kGrid + 1, kFirstPenalty);
    std::vector<double> taps = solved();
    for (int round = 0; round < kMostLawsonRounds && raise_penalties(taps); ++round) taps = solved();
    return taps;
  }

  InverseFilter judged(const std::vector<float>& taps) const {
    InverseFilter filter{taps, solutions_, design_.delay_s, 0, -300, -300};
    double error = 0;
    std::size_t bins = 0;
    for (std::size_t k = 0; k <= kGrid; ++k) {
      const Complex gain = response_of(taps, k);
      const double f = frequency_hz(k);
      filter.gain_db = std::max(filter.gain_db, decibels(std::abs(gain) * leads_[k]));
      if (f > band_.high_hz && f <= design_.stops_at_hz)
        filter.beyond_band_db = std::max(filter.beyond_band_db, decibels(std::abs(gain * responses_[k])));
      if (!band_.contains(f)) continue;
      error += std::norm(gain * responses_[k] - delayed(k));
      ++bins;
    }
    filter.error_db = decibels(std::sqrt(error / static_cast<double>(std::max<std::size_t>(bins, 1))));
    return filter;
  }

 private:
  double frequency_hz(std::size_t k) const { return 0.5 * rate_hz_ * static_cast<double>(k) / kGrid; }
  bool kept(std::size_t k) const { return frequency_hz(k) <= kBandMargin * band_.high_hz; }
  Complex delayed(std::size_t k) const {
    return std::polar(1.0, -2 * std::numbers::pi * frequency_hz(k) * design_.delay_s);
  }
  double weight(std::size_t k) const {
    const double amplitude = !kept(k)                               ? kBeyondBandWeight
                             : frequency_hz(k) < 0.8 * band_.low_hz ? kBelowBandWeight
                                                                    : 1;
    return amplitude * amplitude;
  }
  template <class Taps>
  Complex response_of(const Taps& taps, std::size_t k) const {
    Complex sum = 0;
    for (std::size_t i = 0; i < taps.size(); ++i)
      sum += static_cast<double>(taps[i]) * turns_[k * i % (2 * kGrid)];
    return sum;
  }

  // Solves the normal equations, which are symmetric, Toeplitz and, by the ridge, positive definite.
  std::vector<double> solved() {
    ++solutions_;
    const auto n = static_cast<Eigen::Index>(count_);
    Eigen::VectorXd row = Eigen::VectorXd::Zero(n), right = Eigen::VectorXd::Zero(n);
    for (std::size_t k = 0; k <= kGrid; ++k) {
      const double weights =
          weight(k) * std::norm(responses_[k]) + (kept(k) ? 0 : penalties_[k] * leads_[k] * leads_[k]);
      const Complex aim = kept(k) ? weight(k) * std::conj(responses_[k]) * delayed(k) : 0;
      for (Eigen::Index i = 0; i < n; ++i) {
        const Complex turn = turns_[k * static_cast<std::size_t>(i) % (2 * kGrid)];
        row[i] += weights * turn.real();
        right[i] += (aim * std::conj(turn)).real();
      }
    }
    row[0] *= 1 + kRidge;
    Eigen::MatrixXd equations(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) equations(i, j) = row[std::abs(i - j)];
    const Eigen::VectorXd taps = equations.llt().solve(right);
    return {taps.begin(), taps.end()};
  }

  // Returns false if the gain is within its limit.
  bool raise_penalties(const std::vector<double>& taps) {
    const double bound = schema::amplitude_of_db(design_.most_gain_db), aim = kAim * bound;
    bool beyond = false;
    for (std::size_t k = 0; k <= kGrid; ++k) {
      const double gain = std::abs(response_of(taps, k)) * leads_[k];
      beyond = beyond || gain > bound;
      if (gain > aim)
        penalties_[k] = std::max(penalties_[k], kLeastRaisedPenalty) * gain * gain / (aim * aim);
    }
    return beyond;
  }

  double rate_hz_;
  spatial::Band band_;
  InverseDesign design_;
  std::size_t count_ = 0, solutions_ = 0;
  std::vector<Complex> responses_, turns_;
  std::vector<double> leads_, penalties_;
};

}  // namespace

InverseFilter inverse_filter(const Chain& chain, Inverse inverse, const spatial::Band& band,
                             const InverseDesign& design) {
  const bool single = inverse == Inverse::gain || inverse == Inverse::none;
  Designer designer(chain, inverse, band,
                    single ? InverseDesign{0, design.most_gain_db, design.stops_at_hz, 1} : design);
  const double per_metre = inverse == Inverse::none ? inverse_response(chain, inverse, 0).real()
                                                    : 1 / std::abs(chain_response(chain, 0));
  const std::vector<double> taps = single ? std::vector<double>{1} : designer.taps();
  InverseFilter filter = designer.judged({taps.begin(), taps.end()});
  for (std::size_t i = 0; i < taps.size(); ++i) filter.taps[i] = static_cast<float>(taps[i] * per_metre);
  return filter;
}

}  // namespace tacto::playback
