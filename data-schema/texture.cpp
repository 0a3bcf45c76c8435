// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "data-schema/file_kind.hpp"
#include "data-schema/files.hpp"
#include "data-schema/json_document.hpp"
#include "data-schema/texture_json.hpp"
#include "data-schema/wav.hpp"

namespace tacto::schema {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kKind = "texture";
constexpr std::string_view kSuffix = ".texture";

// A recording under the name is the commonest mistake, and is answered as such.
tl::unexpected<Error> absent(const std::string& name) {
  const auto others = stored_files(name);
  if (others && others->front().kind == FileKind::recording)
    return fail(Fault::unsuitable, "is a recording", name, "make a texture with 'tactograph spatial'");
  if (others && others->front().kind != FileKind::texture)
    return fail(Fault::unsuitable, fmt::format("is a {}, not a texture", kind_name(others->front().kind)),
                name);
  return fail(Fault::not_found, "there is no such texture", name,
              "a texture is NAME.texture.json and NAME.texture.wav");
}

Result<std::vector<double>> read_samples(const std::string& wav, const TextureData& data, double pitch_m) {
  const auto reader = WavReader::open(wav);
  if (!reader) return forward_error(reader);
  const WavInfo& info = reader->info();
  if (info.frames != data.samples)
    return fail(Fault::malformed,
                fmt::format("holds {} samples, its sidecar says {}", info.frames, data.samples), wav);
  if (info.sample_rate_hz != header_rate_of(pitch_m))
    return fail(
        Fault::malformed,
        fmt::format("has {} samples a metre, its sidecar a pitch of {} m", info.sample_rate_hz, pitch_m),
        wav);
  return read_wav_channel(wav, 0);
}

Result<void> check_finite(const std::vector<double>& samples, const std::string& where, Fault fault) {
  const auto broken = std::ranges::find_if(samples, [](double each) { return !std::isfinite(each); });
  if (broken == samples.end()) return {};
  return fail(fault, fmt::format("sample {} is not a finite number", broken - samples.begin()), where);
}

Result<void> write_samples(const std::string& path, const SpaceSignal& signal) {
  auto writer = WavWriter::create(path, header_rate_of(signal.pitch_m), 1, SampleFormat::float32);
  if (!writer) return forward_error(writer);
  if (auto written = writer->write(signal.values); !written) return written;
  return writer->close();
}

Result<void> check_writable(const std::string& stem, const SpaceSignal& signal) {
  if (signal.values.empty()) return fail(Fault::unsuitable, "the texture has no samples", stem);
  if (!(signal.pitch_m > 0)) return fail(Fault::unsuitable, "the texture's pitch is not above 0", stem);
  return check_finite(signal.values, stem, Fault::unsuitable);
}

}  // namespace

Result<Texture> read_texture(const std::string& name) {
  const std::string path = stem_of(name, kSuffix) + ".texture.json";
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return absent(name);
  const auto document = open_document(path, kKind);
  if (!document) return forward_error(document);
  Texture texture = texture_from(document->body);
  const TextureData data = texture_data_from(document->body);
  const std::string wav = (fs::path(path).parent_path() / data.file).string();
  auto samples = read_samples(wav, data, texture.signal.pitch_m);
  if (!samples) return forward_error(samples);
  if (const auto finite = check_finite(*samples, wav, Fault::malformed); !finite)
    return forward_error(finite);
  texture.signal.values = std::move(*samples);
  texture.extra_json = unknown_members(document->body, kKind);
  texture.newer_version = document->newer_version;
  return texture;
}

Result<void> write_texture(const std::string& name, const Texture& texture) {
  const std::string stem = stem_of(name, kSuffix);
  if (auto named = check_stem(stem); !named) return named;
  if (auto writable = check_writable(stem, texture.signal); !writable) return writable;
  const std::string wav = stem + ".texture.wav";
  PendingFiles pending;
  const auto temporary = pending.add(wav);
  if (!temporary) return forward_error(temporary);
  if (auto written = write_samples(*temporary, texture.signal); !written) return written;
  const auto sha256 = sha256_of_file(*temporary);
  if (!sha256) return forward_error(sha256);
  const TextureData data{fs::path(wav).filename().string(), *sha256, texture.signal.values.size()};
  const auto text = document_text(kKind, texture_body(texture, data), texture.extra_json);
  if (!text) return forward_error(text);
  if (auto written = pending.write(stem + ".texture.json", *text); !written) return written;
  return pending.commit();
}

}  // namespace tacto::schema
