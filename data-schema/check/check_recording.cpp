// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "data-schema/check/check_parts.hpp"
#include "data-schema/recording/recording_json.hpp"
#include "data-schema/session/session_reader.hpp"
#include "data-schema/transducer/transducer_plausible.hpp"

namespace tacto::schema {
namespace {

// Times are computed from the gaps' counts; the number of the frame behind each gap shows whether a gap is
// missing or there twice. Only the first fault is reported: it shifts all later ones.
std::optional<Violation> sequence_breach(const RecordingHeader& header) {
  std::uint64_t missing = 0;
  for (std::size_t i = 0; i < header.gaps.size(); ++i) {
    const Gap& gap = header.gaps[i];
    missing += gap.count;
    if (gap.device_sequence != gap.frame + missing)
      return Violation{
          fmt::format("/gaps/{}/device_sequence", i),
          fmt::format(
              "is {}, but its frame and the gaps before it give {}: a gap is missing, or stored twice",
              gap.device_sequence, gap.frame + missing)};
  }
  return std::nullopt;
}

}  // namespace

std::vector<Finding> check_recording(const std::string& path, const Document& document,
                                     const Progress& progress) {
  const RecordingHeader header = recording_header_unchecked(document);
  std::vector<Finding> findings;
  for (const auto& [pointer, what] : recording_breaches(header))
    findings.push_back({fmt::format("{}#{}", path, pointer), what});
  if (const auto breach = sequence_breach(header))
    findings.push_back({fmt::format("{}#{}", path, breach->pointer), breach->what});
  if (header.transducer)
    if (const auto plausible = check_plausible(*header.transducer, path + "#/transducer"); !plausible)
      findings.push_back({plausible.error().where, plausible.error().what});
  const std::string wav = (std::filesystem::path(path).parent_path() / header.wav_file).string();
  const auto more = check_wav(
      {wav, header.sha256, header.format, header.frames, std::round(header.sample_rate_hz), header.channels},
      progress);
  findings.insert(findings.end(), more.begin(), more.end());
  return findings;
}

Result<Checked> check_session(const std::string& path) {
  auto reader = SessionReader::open(path);
  TACTO_TRY(reader);
  Checked checked{{}, reader->header().newer_version};
  const SessionTotals totals = session_totals(*reader);
  if (totals.ending == SessionEnding::damaged)
    checked.findings.push_back(
        {fmt::format("{}, byte {}", path, reader->sound_bytes()), "is not a block with a correct checksum"});
  if (totals.end && totals.end->ticks != totals.ticks)
    checked.findings.push_back({path, fmt::format("its last block gives {} ticks, but there are {}",
                                                  totals.end->ticks, totals.ticks)});
  if (totals.samples > 0 && !reader->header().sensor)
    checked.findings.push_back(
        {path, "contains measured samples, but its header does not describe the sensor"});
  if (!totals.samples_grow)
    checked.findings.push_back({path, "its measured samples are not in the order of their frames"});
  return checked;
}

}  // namespace tacto::schema
