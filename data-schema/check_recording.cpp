// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "data-schema/check_parts.hpp"
#include "data-schema/recording_json.hpp"

namespace tacto::schema {

std::vector<Finding> check_recording(const std::string& path, const Document& document,
                                     const Progress& progress) {
  const RecordingHeader header = recording_header_unchecked(document);
  std::vector<Finding> findings;
  for (const auto& [pointer, what] : recording_breaches(header))
    findings.push_back({fmt::format("{}#{}", path, pointer), what});
  const std::string wav = (std::filesystem::path(path).parent_path() / header.wav_file).string();
  const auto more = check_wav(
      {wav, header.sha256, header.format, header.frames, std::round(header.sample_rate_hz), header.channels},
      progress);
  findings.insert(findings.end(), more.begin(), more.end());
  return findings;
}

}  // namespace tacto::schema
