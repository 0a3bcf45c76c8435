// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "data-schema/check/check_parts.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/statistics.hpp"
#include "data-schema/wav/wav.hpp"

namespace tacto::schema {
namespace {

// The end of libsndfile's text for a sample format.
std::string_view words_for(SampleFormat format) {
  if (format == SampleFormat::pcm32) return "32 bit PCM";
  return format == SampleFormat::float32 ? "32 bit float" : "64 bit float";
}

std::vector<Finding> check_layout(const ExpectedWav& expected, const WavInfo& info) {
  std::vector<Finding> findings;
  const auto differ = [&](const std::string& what) { findings.push_back({expected.path, what}); };
  if (info.sample_rate_hz != expected.header_rate)
    differ(
        fmt::format("its header has the rate {}, its sidecar {}", info.sample_rate_hz, expected.header_rate));
  if (info.channels != expected.channels.size())
    differ(fmt::format("has {} channels, its sidecar {}", info.channels, expected.channels.size()));
  if (!info.format.ends_with(words_for(expected.format)))
    differ(fmt::format("contains '{}', its sidecar has {}", info.format, words_for(expected.format)));
  if (info.frames != expected.frames)
    differ(fmt::format("{}contains {} frames, its sidecar has {}",
                       info.frames < expected.frames ? "truncated: " : "", info.frames, expected.frames));
  return findings;
}

void add_checksum(const ExpectedWav& expected, std::vector<Finding>& findings) {
  const auto sum = sha256_of_file(expected.path);
  if (sum && *sum != expected.sha256)
    findings.push_back({expected.path, fmt::format("its checksum (SHA-256) is {}, its sidecar has {}", *sum,
                                                   expected.sha256)});
}

void add_samples(const ExpectedWav& expected, const Progress& progress, std::vector<Finding>& findings) {
  const auto statistics = channel_statistics(expected.path, expected.channels, progress);
  if (!statistics) {
    findings.push_back({statistics.error().where, statistics.error().what});
    return;
  }
  for (std::size_t c = 0; c < statistics->size(); ++c)
    if (const Statistics& channel = (*statistics)[c]; channel.not_finite() > 0)
      findings.push_back({fmt::format("{}, channel '{}', sample {}", expected.path, expected.channels[c].name,
                                      channel.first_not_finite()),
                          fmt::format("NaN or infinite, the first of {}", channel.not_finite())});
}

}  // namespace

std::vector<Finding> check_wav(const ExpectedWav& expected, const Progress& progress) {
  const auto reader = WavReader::open(expected.path);
  std::vector<Finding> findings;
  if (reader)
    findings = check_layout(expected, reader->info());
  else
    findings.push_back({reader.error().where, reader.error().what});
  add_checksum(expected, findings);
  if (reader && reader->info().channels == expected.channels.size())
    add_samples(expected, progress, findings);
  return findings;
}

}  // namespace tacto::schema
