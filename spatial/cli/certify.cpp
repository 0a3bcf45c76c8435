// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph certify: which peaks of textures made at different speeds belong to the surface.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/version.hpp"
#include "spatial/certificate/certificate.hpp"
#include "spatial/cli/texture_inputs.hpp"
#include "spatial/cli/verbs.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::Certificate;
using schema::CertifiedPeak;
using schema::PeakVerdict;
using schema::Result;

struct CertifyOptions {
  std::vector<std::string> names;
  CertificateOptions certificate;
  schema::Existing existing = schema::Existing::keep;
  bool dry = false;
};

Result<std::vector<Certificate>> certificates_of(const std::vector<NamedTexture>& files,
                                                 const CertificateOptions& options) {
  std::vector<TextureAtSpeed> textures;
  for (const NamedTexture& file : files) textures.push_back({file.name, &file.texture});
  auto certificates = certify(textures, options);
  if (!certificates) return certificates;
  for (Certificate& certificate : *certificates) {
    certificate.created = schema::creation_time();
    certificate.creator = kCreator;
  }
  return certificates;
}

Result<void> check_stored(const std::vector<NamedTexture>& files) {
  const auto made = std::ranges::find(files, false, &NamedTexture::stored);
  if (made == files.end()) return {};
  return schema::fail(schema::ErrorKind::unsuitable,
                      "is a stroke of a recording: there is no texture to store in", made->path,
                      "make textures with 'tactograph spatial' first, or use --dry-run");
}

Result<void> check_uncertified(const std::vector<NamedTexture>& files, schema::Existing existing) {
  const auto certified = [](const NamedTexture& file) { return file.texture.certificate.has_value(); };
  const auto found = std::ranges::find_if(files, certified);
  if (found == files.end() || existing == schema::Existing::replace) return {};
  return schema::fail(schema::ErrorKind::usage, "already contains a certificate, which is not overwritten",
                      found->path, "replace it with --force, or use --dry-run");
}

Result<void> check_storable(const std::vector<NamedTexture>& files, schema::Existing existing) {
  const auto stored = check_stored(files);
  return stored ? check_uncertified(files, existing) : stored;
}

Result<void> store(std::vector<NamedTexture>& files, const std::vector<Certificate>& certificates) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    files[i].texture.certificate = certificates[i];
    const auto written = schema::write_texture(schema::stem_of(files[i].path, ".texture"), files[i].texture);
    if (!written) return written;
  }
  return {};
}

Report row_of(const CertifiedPeak& peak) {
  Report row;
  row.add("verdict", schema::verdict_name(peak.verdict));
  row.add("frequency_per_m", peak.frequency_per_m).add("frequency_hz", peak.frequency_hz);
  row.add("confidence", peak.confidence).add("snr_db", peak.snr_db).add("snr_needed_db", peak.snr_needed_db);
  row.add("speed_ratio", peak.speed_ratio).add("speed_ratio_needed", peak.speed_ratio_needed);
  row.add("found_in", peak.found_in.size()).add("reason", peak.reason);
  return row;
}

std::size_t count(const Certificate& certificate, PeakVerdict verdict) {
  return static_cast<std::size_t>(std::ranges::count(certificate.peaks, verdict, &CertifiedPeak::verdict));
}

Report report_of(const std::vector<NamedTexture>& files, const std::vector<Certificate>& certificates,
                 bool stored) {
  const Certificate& first = certificates.front();
  std::vector<Report> textures, peaks;
  for (std::size_t i = 0; i < files.size(); ++i)
    textures.push_back(Report().add("texture", first.textures[i]).add("mean_speed_mps", first.speeds_mps[i]));
  for (const CertifiedPeak& peak : first.peaks) peaks.push_back(row_of(peak));
  Report report;
  report.add("textures", std::move(textures)).add("speed_ratio", first.speed_ratio);
  report.add("spatial", count(first, PeakVerdict::spatial))
      .add("temporal", count(first, PeakVerdict::temporal));
  report.add("undecided", count(first, PeakVerdict::undecided)).add("seen_from", first.textures.front());
  if (!peaks.empty()) report.add("peaks", std::move(peaks));
  report.add("stored", stored);
  return report;
}

Result<Report> run_certify(const CertifyOptions& options) {
  auto files = open_textures(options.names);
  TACTO_TRY(files);
  if (!options.dry) TACTO_TRY(check_storable(*files, options.existing));
  const auto certificates = certificates_of(*files, options.certificate);
  TACTO_TRY(certificates);
  if (!options.dry) TACTO_TRY(store(*files, *certificates));
  return report_of(*files, *certificates, !options.dry);
}

cli::Action declare_certify(CLI::App& app) {
  auto options = std::make_shared<CertifyOptions>();
  app.add_option(
         "TEXTURE", options->names,
         std::string("Two or more textures of one surface, recorded at different speeds. ") + kTextureInputs)
      ->required();
  app.add_option("--confidence", options->certificate.confidence,
                 "Probability from which a peak is classified, above 0.5 and below 1")
      ->capture_default_str();
  app.add_flag_callback(
      "--force", [options] { options->existing = schema::Existing::replace; },
      "Replace the certificate that a texture already contains");
  app.add_flag("--dry-run", options->dry, "Print the result only; do not store it in the textures");
  return [options] { return run_certify(*options); };
}

}  // namespace

const cli::Verb kCertifyVerb{
    "certify",
    "Separate peaks of the surface from those in time (mains, resonances) by strokes at different speeds",
    "tactograph certify oak-slow oak-fast", declare_certify};

}  // namespace tacto::spatial
