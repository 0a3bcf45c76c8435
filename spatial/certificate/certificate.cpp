// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/certificate/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "spatial/features/speed_hypotheses.hpp"

namespace tacto::spatial {
namespace {

using schema::Certificate;
using schema::CertifiedPeak;
using schema::ErrorKind;
using schema::PeakVerdict;
using schema::Result;

// A hypothesis fits from this likelihood ratio to "neither" on.
constexpr double kFits = 3;

// A peak that is classified or left undecided, with its vibrations in the textures where it was found.
struct Call {
  PeakVerdict verdict = PeakVerdict::undecided;
  double confidence = 0;
  SpeedEvidence evidence;
  std::vector<VibrationId> members;
};

struct Candidate {
  VibrationId id;
  SpeedEvidence evidence;
  double confidence() const {
    return std::max(evidence.confidence_spatial(), evidence.confidence_temporal());
  }
  bool spatial() const { return evidence.spatial >= evidence.temporal; }
};

std::vector<Candidate> open_candidates(const SpeedHypotheses& hypotheses) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < hypotheses.strokes().size(); ++i)
    for (std::size_t v = 0; v < hypotheses.strokes()[i].vibrations.size(); ++v)
      if (!hypotheses.is_used({i, v})) candidates.push_back({{i, v}, hypotheses.evidence({i, v})});
  return candidates;
}

std::vector<Call> called(SpeedHypotheses& hypotheses, double confidence_needed) {
  std::vector<Call> calls;
  while (true) {
    const auto candidates = open_candidates(hypotheses);
    const auto surest = std::ranges::max_element(candidates, {}, &Candidate::confidence);
    if (surest == candidates.end() || surest->confidence() < confidence_needed) return calls;
    const PeakVerdict verdict = surest->spatial() ? PeakVerdict::spatial : PeakVerdict::temporal;
    calls.push_back(
        {verdict, surest->confidence(), surest->evidence, hypotheses.same(surest->id, surest->spatial())});
    for (const VibrationId member : calls.back().members) hypotheses.mark_used(member);
  }
}

// Adds the remaining candidates, highest confidence first. Candidates that are probably one peak in several
// textures become one peak.
void add_undecided(SpeedHypotheses& hypotheses, std::vector<Call>& calls) {
  auto candidates = open_candidates(hypotheses);
  std::ranges::sort(candidates, std::greater(), &Candidate::confidence);
  for (const Candidate& candidate : candidates) {
    if (hypotheses.is_used(candidate.id)) continue;
    std::vector<VibrationId> members{candidate.id};
    if (std::max(candidate.evidence.spatial, candidate.evidence.temporal) > kFits)
      members = hypotheses.same(candidate.id, candidate.spatial());
    calls.push_back({PeakVerdict::undecided, candidate.confidence(), candidate.evidence, members});
    for (const VibrationId member : members) hypotheses.mark_used(member);
  }
}

std::string reason_of(const Call& call) {
  constexpr double kUnlikelySeen = 0.5;
  if (call.verdict != PeakVerdict::undecided) return {};
  const bool spatial = call.evidence.spatial >= call.evidence.temporal;
  if (!(spatial ? call.evidence.spatial_tested : call.evidence.temporal_tested)) return "outside_band";
  if (!call.evidence.resolved) return "speed_ratio";
  if (call.evidence.best_detection < kUnlikelySeen) return "signal_to_noise";
  return call.evidence.spatial > kFits && call.evidence.temporal > kFits ? "both_fit" : "neither_fits";
}

// Mean weighted by the inverse variance.
double weighted_mean(const SpeedHypotheses& hypotheses, const Call& call, double Vibration::*value,
                     double Vibration::*sigma) {
  double sum = 0, weights = 0;
  for (const VibrationId id : call.members) {
    const Vibration& vibration = hypotheses.at(id);
    const double weight = 1 / (vibration.*sigma * vibration.*sigma);
    sum += weight * vibration.*value;
    weights += weight;
  }
  return sum / weights;
}

CertifiedPeak peak_of(const SpeedHypotheses& hypotheses, const Call& call) {
  CertifiedPeak peak;
  peak.verdict = call.verdict;
  peak.confidence = call.confidence;
  peak.reason = reason_of(call);
  const auto strongest = std::ranges::max_element(
      call.members, {}, [&](VibrationId id) { return hypotheses.at(id).prominence_db; });
  const Vibration& vibration = hypotheses.at(*strongest);
  peak.rms = std::sqrt(vibration.power);
  peak.snr_db = vibration.prominence_db;
  peak.snr_needed_db = vibration.needed_db;
  peak.speed_ratio = call.evidence.speed_ratio;
  const auto& spectrum = hypotheses.strokes()[strongest->stroke].space;
  peak.speed_ratio_needed =
      1 / (1 - spectrum.resolution() / std::max(vibration.frequency_per_m, spectrum.low()));
  for (const VibrationId id : call.members) peak.found_in.push_back(hypotheses.strokes()[id.stroke].name);
  return peak;
}

// Sets the peak's frequencies in one stroke: a spatial peak keeps k, a temporal one keeps f. An undecided one
// keeps the values of the stroke where it was found.
void place(CertifiedPeak& peak, const SpeedHypotheses& hypotheses, const Call& call, double speed_mps) {
  const Vibration& first = hypotheses.at(call.members.front());
  if (call.verdict == PeakVerdict::spatial) {
    peak.frequency_per_m =
        weighted_mean(hypotheses, call, &Vibration::frequency_per_m, &Vibration::sigma_per_m);
    peak.frequency_hz = peak.frequency_per_m * speed_mps;
  } else if (call.verdict == PeakVerdict::temporal) {
    peak.frequency_hz = weighted_mean(hypotheses, call, &Vibration::frequency_hz, &Vibration::sigma_hz);
    peak.frequency_per_m = peak.frequency_hz / speed_mps;
  } else {
    peak.frequency_per_m = first.frequency_per_m;
    peak.frequency_hz = first.frequency_hz;
  }
}

Certificate header_of(const std::vector<StrokeLines>& strokes, const CertificateOptions& options) {
  Certificate certificate;
  for (const StrokeLines& stroke : strokes) {
    certificate.textures.push_back(stroke.name);
    certificate.speeds_mps.push_back(stroke.speed_mps);
  }
  const auto [slowest, fastest] = std::ranges::minmax(certificate.speeds_mps);
  certificate.speed_ratio = fastest / slowest;
  certificate.confidence_needed = options.confidence;
  return certificate;
}

Certificate seen_from(std::size_t stroke, const SpeedHypotheses& hypotheses, const std::vector<Call>& calls,
                      Certificate certificate) {
  for (const Call& call : calls) {
    CertifiedPeak peak = peak_of(hypotheses, call);
    place(peak, hypotheses, call, hypotheses.strokes()[stroke].speed_mps);
    certificate.peaks.push_back(std::move(peak));
  }
  std::ranges::sort(certificate.peaks, {}, &CertifiedPeak::frequency_per_m);
  return certificate;
}

Result<void> check(std::span<const TextureAtSpeed> textures, const CertificateOptions& options) {
  if (textures.size() < 2)
    return schema::fail(ErrorKind::usage,
                        "a certificate needs at least two textures, recorded at different speeds",
                        "textures");
  if (!(options.confidence > 0.5 && options.confidence < 1))
    return schema::fail(ErrorKind::usage, "the confidence must be above 0.5 and below 1", "confidence",
                        "0.95 is the default");
  for (const TextureAtSpeed& each : textures)
    if (each.texture->unit != textures.front().texture->unit)
      return schema::fail(ErrorKind::unsuitable,
                          fmt::format("its unit differs from that of {}", textures.front().name), each.name);
  return {};
}

Result<std::vector<StrokeLines>> lines_of(std::span<const TextureAtSpeed> textures) {
  std::vector<StrokeLines> strokes;
  for (const TextureAtSpeed& each : textures) {
    auto lines = stroke_lines(each.name, *each.texture);
    TACTO_TRY(lines);
    strokes.push_back(std::move(*lines));
  }
  return strokes;
}

// Requires the smallest useful speed ratio, which is that at the highest frequency of the valid bands.
Result<void> check_ratio(const std::vector<StrokeLines>& strokes, double ratio) {
  double least = INFINITY, highest_per_m = 0, resolution_per_m = 0;
  for (const StrokeLines& stroke : strokes) {
    if (!(stroke.space.high() > stroke.space.low()))
      return schema::fail(ErrorKind::unsuitable, "its valid band is too narrow for a spectrum", stroke.name,
                          "make it from a section with a steadier speed");
    const double needed = 1 / (1 - stroke.space.resolution() / stroke.space.high());
    if (needed < least) {
      least = needed;
      highest_per_m = stroke.space.high();
      resolution_per_m = stroke.space.resolution();
    }
  }
  if (ratio >= least) return {};
  const double at_middle = 1 / (1 - std::min(0.9, resolution_per_m / (highest_per_m / 4)));
  return schema::fail(ErrorKind::unsuitable,
                      fmt::format("the speeds differ only by a factor of {:.4g}; a peak at {:.3g} /mm needs "
                                  "{:.4g}, one at {:.3g} /mm {:.4g}",
                                  ratio, 1e-3 * highest_per_m, least, 0.25e-3 * highest_per_m, at_middle),
                      "textures", "record a stroke at another speed");
}

}  // namespace

Result<std::vector<Certificate>> certify(std::span<const TextureAtSpeed> textures,
                                         const CertificateOptions& options) {
  TACTO_TRY(check(textures, options));
  auto strokes = lines_of(textures);
  TACTO_TRY(strokes);
  const Certificate header = header_of(*strokes, options);
  TACTO_TRY(check_ratio(*strokes, header.speed_ratio));
  SpeedHypotheses hypotheses(std::move(*strokes));
  std::vector<Call> calls = called(hypotheses, options.confidence);
  add_undecided(hypotheses, calls);
  std::vector<Certificate> certificates;
  for (std::size_t i = 0; i < textures.size(); ++i)
    certificates.push_back(seen_from(i, hypotheses, calls, header));
  return certificates;
}

}  // namespace tacto::spatial
