// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/texture/texture.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "data-schema/files/files.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/texture/texture_json.hpp"
#include "data-schema/texture/texture_wav.hpp"
#include "data-schema/wav/wav.hpp"

namespace tacto::schema {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTextureKind = "texture";
constexpr std::string_view kTextureSuffix = ".texture";

// The textures that `spatial` names after a recording with several strokes: oak-01, oak-02, oak-forward.
std::vector<std::string> textures_after(const std::string& name) {
  constexpr std::string_view kEnding = ".texture.json";
  const fs::path stem = stem_of(stem_of(name, kTextureSuffix), "");
  const std::string begin = stem.filename().string() + "-";
  std::vector<std::string> found;
  std::error_code ignored;
  const fs::path folder = stem.has_parent_path() ? stem.parent_path() : ".";
  for (fs::directory_iterator at(folder, ignored), end; !ignored && at != end; at.increment(ignored)) {
    const std::string file = at->path().filename().string();
    if (file.starts_with(begin) && file.ends_with(kEnding))
      found.push_back((stem.parent_path() / file.substr(0, file.size() - kEnding.size())).string());
  }
  std::ranges::sort(found);
  return found;
}

// A recording with this name is the most frequent mistake; it has an error message of its own.
tl::unexpected<Error> absent(const std::string& name) {
  const auto others = stored_files(name);
  const std::vector<std::string> textures = textures_after(name);
  constexpr std::size_t kMostNamed = 6;
  const std::string choose = textures.size() > kMostNamed
                                 ? fmt::format("name one of {} textures, {} to {}", textures.size(),
                                               textures.front(), textures.back())
                                 : fmt::format("name one of these textures: {}", fmt::join(textures, ", "));
  if (others && others->front().kind == FileKind::recording)
    return fail(ErrorKind::unsuitable, "is a recording", name,
                textures.empty() ? "make a texture with 'tactograph spatial'" : choose);
  if (others && others->front().kind != FileKind::texture)
    return fail(ErrorKind::unsuitable, fmt::format("is a {}, not a texture", kind_name(others->front().kind)),
                name);
  return fail(ErrorKind::not_found, "there is no such texture", name,
              textures.empty() ? "a texture is NAME.texture.json and NAME.texture.wav" : choose);
}

Result<void> check_layout(const std::string& wav, const TextureData& data, double pitch_m) {
  const auto reader = WavReader::open(wav);
  TACTO_TRY(reader);
  const WavInfo& info = reader->info();
  if (info.frames != data.samples)
    return fail(ErrorKind::malformed,
                fmt::format("contains {} samples, its sidecar has {}", info.frames, data.samples), wav);
  if (info.channels != data.channels)
    return fail(ErrorKind::malformed,
                fmt::format("has {} channels, its sidecar {}", info.channels, data.channels), wav);
  if (info.sample_rate_hz != header_rate_of(pitch_m))
    return fail(
        ErrorKind::malformed,
        fmt::format("has {} samples per metre, its sidecar a pitch of {} m", info.sample_rate_hz, pitch_m),
        wav);
  return {};
}

Result<void> check_finite(const std::vector<double>& samples, const std::string& where, ErrorKind fault) {
  const auto broken = std::ranges::find_if(samples, [](double each) { return !std::isfinite(each); });
  if (broken == samples.end()) return {};
  return fail(fault, fmt::format("sample {} is not a finite number", broken - samples.begin()), where);
}

// The WAV holds single precision: up to 3.4e38, and whole digits from 1.2e-38 on.
Result<void> check_single(const std::vector<double>& samples, const std::string& unit,
                          const std::string& where) {
  const auto beyond = [](double each) { return !std::isfinite(static_cast<float>(each)); };
  const auto found = std::ranges::find_if(samples, beyond);
  if (found == samples.end()) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("sample {} is {:.4g} {}, above the 3.4e38 that a texture's file can store",
                          found - samples.begin(), *found, unit),
              where, "check the scale of the channel: 'tactograph info' of the recording shows it");
}

Result<void> check_not_lost(const std::vector<double>& samples, const std::string& unit,
                            const std::string& where) {
  double largest = 0;
  for (const double each : samples) largest = std::max(largest, std::abs(each));
  if (largest == 0 || largest >= static_cast<double>(std::numeric_limits<float>::min())) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("its largest value is {:.4g} {}, below the 1.2e-38 that a texture's file can "
                          "store: all values would be nearly 0",
                          largest, unit),
              where, "check the scale of the channel: 'tactograph info' of the recording shows it");
}

Result<std::vector<double>> read_samples(const std::string& wav, std::size_t channel) {
  auto samples = read_wav_channel(wav, channel);
  if (!samples) return samples;
  const auto finite = check_finite(*samples, wav, ErrorKind::malformed);
  return finite ? samples : forward_error(finite);
}

// Mean and spread of an average, interleaved.
std::vector<double> frames_of(const Texture& texture) {
  std::vector<double> frames;
  frames.reserve(2 * texture.signal.values.size());
  for (std::size_t i = 0; i < texture.signal.values.size(); ++i)
    frames.insert(frames.end(), {texture.signal.values[i], texture.average->spread[i]});
  return frames;
}

Result<void> write_samples(const std::string& path, const Texture& texture) {
  const std::size_t channels = texture.average ? 2 : 1;
  auto writer =
      WavWriter::create(path, header_rate_of(texture.signal.pitch_m), channels, SampleFormat::float32);
  TACTO_TRY(writer);
  auto written = texture.average ? writer->write(frames_of(texture)) : writer->write(texture.signal.values);
  return written ? writer->close() : written;
}

Result<void> check_writable(const std::string& stem, const Texture& texture) {
  const SpaceSignal& signal = texture.signal;
  if (signal.values.empty()) return fail(ErrorKind::unsuitable, "the texture has no samples", stem);
  if (!(signal.pitch_m > 0)) return fail(ErrorKind::unsuitable, "the texture's pitch is not above 0", stem);
  if (auto finite = check_finite(signal.values, stem, ErrorKind::unsuitable); !finite) return finite;
  if (auto held = check_single(signal.values, texture.unit, stem); !held) return held;
  if (auto kept = check_not_lost(signal.values, texture.unit, stem); !kept || !texture.average) return kept;
  if (texture.average->spread.size() != signal.values.size())
    return fail(ErrorKind::unsuitable, "the texture's spread has another length than its mean", stem);
  if (auto finite = check_finite(texture.average->spread, stem, ErrorKind::unsuitable); !finite)
    return finite;
  return check_single(texture.average->spread, texture.unit, stem);
}

std::string sidecar_path(const std::string& name) {
  return stem_of(name, kTextureSuffix) + ".texture.json";
}

Result<Document> open_sidecar(const std::string& name) {
  const std::string path = sidecar_path(name);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return absent(name);
  return open_document(path, kTextureKind);
}

}  // namespace

Result<Texture> read_texture(const std::string& name) {
  const auto document = open_sidecar(name);
  TACTO_TRY(document);
  const std::string path = sidecar_path(name);
  Texture texture = texture_from(document->body);
  const TextureData data = texture_data_from(document->body);
  const std::string wav = (fs::path(path).parent_path() / data.file).string();
  TACTO_TRY(check_layout(wav, data, texture.signal.pitch_m));
  auto samples = read_samples(wav, 0);
  TACTO_TRY(samples);
  texture.signal.values = std::move(*samples);
  if (texture.average) {
    auto spread = read_samples(wav, 1);
    TACTO_TRY(spread);
    texture.average->spread = std::move(*spread);
  }
  TACTO_TRY(check_sum(wav, data.sha256));
  keep_unknown(*document, texture);
  return texture;
}

Result<TextureWav> texture_wav(const std::string& name) {
  const std::string path = sidecar_path(name);
  const auto document = open_document(path, kTextureKind);
  TACTO_TRY(document);
  const TextureData data = texture_data_from(document->body);
  return TextureWav{(fs::path(path).parent_path() / data.file).string(), data.sha256};
}

Result<std::optional<PlaybackGain>> read_playback_gain(const std::string& name) {
  const auto document = open_sidecar(name);
  return document ? texture_from(document->body).playback_gain
                  : Result<std::optional<PlaybackGain>>(forward_error(document));
}

Result<void> write_playback_gain(const std::string& name, const PlaybackGain& gain) {
  auto document = open_sidecar(name);
  TACTO_TRY(document);
  const std::string path = sidecar_path(name);
  if (const auto free = check_changeable(path); !free) return free;
  document->body["playback_gain"] = playback_gain_body(gain);
  const auto text = document_text(kTextureKind, document->body, {});
  TACTO_TRY(text);
  PendingFiles pending;
  if (const auto written = pending.write(path, *text); !written) return written;
  return pending.commit();
}

Result<void> add_texture(PendingFiles& pending, const std::string& name, const Texture& texture) {
  const std::string stem = stem_of(name, kTextureSuffix);
  if (auto named = check_stem(stem); !named) return named;
  if (auto writable = check_writable(stem, texture); !writable) return writable;
  const std::string wav = stem + ".texture.wav";
  const auto temporary = pending.add(wav);
  TACTO_TRY(temporary);
  if (auto written = write_samples(*temporary, texture); !written) return written;
  const auto sha256 = sha256_of_file(*temporary);
  TACTO_TRY(sha256);
  const TextureData data{fs::path(wav).filename().string(), *sha256, texture.signal.values.size(),
                         texture.average ? 2U : 1U};
  const auto text = document_text(kTextureKind, texture_body(texture, data), texture.extra_json);
  TACTO_TRY(text);
  return pending.write(stem + ".texture.json", *text);
}

Result<void> write_texture(const std::string& name, const Texture& texture) {
  PendingFiles pending;
  if (auto added = add_texture(pending, name, texture); !added) return added;
  return pending.commit();
}

std::string whole_rms_band(const Texture& texture) {
  const TextureSource& source = texture.source;
  if (texture.transform) return "all samples";
  if (source.filter.empty() || source.filter == "none") return "all samples, unfiltered";
  if (source.high_per_m)
    return fmt::format("all samples, filtered to {:.4g}-{:.4g} /mm", 1e-3 * source.low_per_m.value_or(0),
                       1e-3 * *source.high_per_m);
  return fmt::format("all samples, filtered to {:.4g}-{:.4g} Hz", source.low_hz, source.high_hz);
}

std::string reduction_in_words(const TextureSource& source) {
  if (source.axes.empty()) return {};
  return fmt::format("{} of {}: the magnitude of the spectrum over time is kept, the waveform is not",
                     source.reduction, fmt::join(source.axes, ", "));
}

Result<void> check_texture_free(const std::string& name, Existing existing) {
  const std::string stem = stem_of(name, kTextureSuffix);
  for (const char* ending : {".texture.json", ".texture.wav"})
    if (auto free = check_output_free(stem + ending, existing); !free) return free;
  return {};
}

}  // namespace tacto::schema
