// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/texture/certificate_json.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "data-schema/json/json_document.hpp"

namespace tacto::schema {
namespace {

constexpr std::array<const char*, 3> kVerdicts = {"spatial", "temporal", "undecided"};

struct PeakNumber {
  const char* name;
  double CertifiedPeak::*member;
};

constexpr PeakNumber kPeakNumbers[] = {
    {"confidence", &CertifiedPeak::confidence},
    {"frequency_per_m", &CertifiedPeak::frequency_per_m},
    {"frequency_hz", &CertifiedPeak::frequency_hz},
    {"rms", &CertifiedPeak::rms},
    {"snr_db", &CertifiedPeak::snr_db},
    {"snr_needed_db", &CertifiedPeak::snr_needed_db},
    {"speed_ratio", &CertifiedPeak::speed_ratio},
    {"speed_ratio_needed", &CertifiedPeak::speed_ratio_needed},
};

PeakVerdict verdict_from(const std::string& name) {
  const auto found = std::ranges::find(kVerdicts, name);
  return found == kVerdicts.end() ? PeakVerdict::undecided
                                  : static_cast<PeakVerdict>(found - kVerdicts.begin());
}

Json peak_body(const CertifiedPeak& peak) {
  Json body = {{"verdict", verdict_name(peak.verdict)}};
  put_text(body, "reason", peak.reason);
  for (const auto& [name, member] : kPeakNumbers) body[name] = peak.*member;
  body["found_in"] = peak.found_in;
  return body;
}

CertifiedPeak peak_from(const Json& body) {
  CertifiedPeak peak;
  peak.verdict = verdict_from(text_or(body, "verdict"));
  peak.reason = text_or(body, "reason");
  for (const auto& [name, member] : kPeakNumbers) peak.*member = number_or(body, name, 0);
  if (body.contains("found_in")) peak.found_in = body["found_in"].get<std::vector<std::string>>();
  return peak;
}

}  // namespace

std::string verdict_name(PeakVerdict verdict) {
  return kVerdicts[static_cast<std::size_t>(verdict)];
}

Json certificate_body(const Certificate& certificate) {
  Json body = {{"textures", certificate.textures}, {"speeds_mps", certificate.speeds_mps}};
  body["speed_ratio"] = certificate.speed_ratio;
  body["confidence_needed"] = certificate.confidence_needed;
  put_text(body, "created", certificate.created);
  put_text(body, "creator", certificate.creator);
  body["peaks"] = Json::array();
  for (const CertifiedPeak& peak : certificate.peaks) body["peaks"].push_back(peak_body(peak));
  return body;
}

Certificate certificate_from(const Json& body) {
  Certificate certificate;
  certificate.textures = body["textures"].get<std::vector<std::string>>();
  certificate.speeds_mps = body["speeds_mps"].get<std::vector<double>>();
  certificate.speed_ratio = number_or(body, "speed_ratio", 0);
  certificate.confidence_needed = number_or(body, "confidence_needed", 0);
  certificate.created = text_or(body, "created");
  certificate.creator = text_or(body, "creator");
  for (const Json& peak : body["peaks"]) certificate.peaks.push_back(peak_from(peak));
  return certificate;
}

}  // namespace tacto::schema
