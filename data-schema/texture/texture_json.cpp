// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/texture/texture_json.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "data-schema/json/json_document.hpp"
#include "data-schema/texture/certificate.hpp"
#include "data-schema/texture/transform.hpp"

namespace tacto::schema {
namespace {

// The member `transform`.

constexpr std::array<const char*, 4> kOperations = {"stretch", "gain", "mix", "filter"};
constexpr std::array<const char*, 2> kLengthenings = {"periods", "best_fit"};

// The word's place in the list; the schema allows no other words.
template <class Word, std::size_t kCount>
Word word_from(const std::array<const char*, kCount>& words, const std::string& text) {
  const auto found = std::ranges::find(words, text);
  return static_cast<Word>(found == words.end() ? 0 : found - words.begin());
}

Json step_body(const TransformStep& step) {
  Json body = {{"operation", operation_name(step.operation)}};
  for (const auto& [name, member] : kTransformNumbers)
    if (step.*member) body[name] = *(step.*member);
  if (step.keep_slope) body["keep_slope"] = *step.keep_slope;
  if (step.lengthening) body["lengthening"] = lengthening_name(*step.lengthening);
  if (step.joints) body["joints"] = *step.joints;
  if (!step.weights.empty()) body["weights"] = step.weights;
  return body;
}

TransformStep step_from(const Json& body) {
  TransformStep step;
  step.operation = word_from<TransformOperation>(kOperations, text_or(body, "operation"));
  for (const auto& [name, member] : kTransformNumbers)
    if (body.contains(name)) step.*member = body[name].get<double>();
  if (body.contains("keep_slope")) step.keep_slope = body["keep_slope"].get<bool>();
  if (body.contains("lengthening"))
    step.lengthening = word_from<Lengthening>(kLengthenings, text_or(body, "lengthening"));
  if (body.contains("joints")) step.joints = body["joints"].get<int>();
  if (body.contains("weights")) step.weights = body["weights"].get<std::vector<double>>();
  return step;
}

Json transform_body(const TextureTransform& transform) {
  Json sources = Json::array(), steps = Json::array();
  for (const auto& [texture, sha256] : transform.sources)
    sources.push_back({{"texture", texture}, {"sha256", sha256}});
  for (const TransformStep& step : transform.steps) steps.push_back(step_body(step));
  return {{"sources", sources}, {"steps", steps}};
}

// Reads what transform_body made. Precondition: it fits the texture's schema.
TextureTransform transform_from(const Json& body) {
  TextureTransform transform;
  for (const Json& source : body["sources"])
    transform.sources.push_back({text_or(source, "texture"), text_or(source, "sha256")});
  for (const Json& step : body["steps"]) transform.steps.push_back(step_from(step));
  return transform;
}

// The member `certificate`.

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

// Precondition: the body fits the schema.
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

struct TextureText {
  const char* name;
  std::string Texture::*member;
};

constexpr TextureText kTextureTexts[] = {
    {"simulated", &Texture::simulated}, {"surface", &Texture::surface}, {"subject", &Texture::subject},
    {"finger", &Texture::finger},       {"notes", &Texture::notes},     {"created", &Texture::created},
    {"creator", &Texture::creator},
};

struct SourceText {
  const char* name;
  std::string TextureSource::*member;
};

constexpr SourceText kSourceTexts[] = {
    {"recording", &TextureSource::recording}, {"recording_sha256", &TextureSource::recording_sha256},
    {"method", &TextureSource::method},       {"filter", &TextureSource::filter},
    {"edges", &TextureSource::edges},         {"reduction", &TextureSource::reduction},
};

struct SourceNumber {
  const char* name;
  double TextureSource::*member;
};

constexpr SourceNumber kSourceNumbers[] = {
    {"from_s", &TextureSource::from_s},
    {"to_s", &TextureSource::to_s},
    {"low_hz", &TextureSource::low_hz},
    {"high_hz", &TextureSource::high_hz},
    {"mean_speed_mps", &TextureSource::mean_speed_mps},
    {"min_speed_mps", &TextureSource::min_speed_mps},
    {"max_speed_mps", &TextureSource::max_speed_mps},
    {"position_moved_m", &TextureSource::position_moved_m},
    {"position_quantum_m", &TextureSource::position_quantum_m},
    {"position_noise_m", &TextureSource::position_noise_m},
};

// Left out if they are 0.
struct SourceCount {
  const char* name;
  int TextureSource::*member;
};

constexpr SourceCount kSourceCounts[] = {
    {"stroke", &TextureSource::stroke},
    {"order", &TextureSource::order},
    {"counter_bits", &TextureSource::counter_bits},
    {"counter_wraps", &TextureSource::counter_wraps},
    {"interpolated_frames", &TextureSource::interpolated_frames},
};

struct SourceOption {
  const char* name;
  std::optional<double> TextureSource::*member;
};

constexpr SourceOption kSourceOptions[] = {
    {"low_per_m", &TextureSource::low_per_m},
    {"high_per_m", &TextureSource::high_per_m},
    {"normal_force_n", &TextureSource::normal_force_n},
    {"waveform_correlation", &TextureSource::waveform_correlation},
};

Json source_body(const TextureSource& source) {
  Json body = Json::object();
  for (const auto& [name, member] : kSourceTexts) put_text(body, name, source.*member);
  for (const auto& [name, member] : kSourceNumbers) body[name] = source.*member;
  for (const auto& [name, member] : kSourceCounts)
    if (source.*member != 0) body[name] = source.*member;
  body["equalised"] = source.equalised;
  for (const auto& [name, member] : kSourceOptions)
    if (source.*member) body[name] = *(source.*member);
  if (source.finger_up) body["finger_up"] = true;
  if (!source.axes.empty()) body["axes"] = source.axes;
  return body;
}

TextureSource source_from(const Json& body) {
  TextureSource source;
  for (const auto& [name, member] : kSourceTexts) source.*member = text_or(body, name);
  for (const auto& [name, member] : kSourceNumbers) source.*member = number_or(body, name, 0);
  for (const auto& [name, member] : kSourceCounts)
    source.*member = static_cast<int>(number_or(body, name, 0));
  source.equalised = body.value("equalised", false);
  for (const auto& [name, member] : kSourceOptions)
    if (body.contains(name)) source.*member = body[name].get<double>();
  source.finger_up = body.value("finger_up", false);
  source.axes = body.value("axes", source.axes);
  return source;
}

Json band_body(const std::vector<BandPoint>& band) {
  Json body = Json::array();
  for (const BandPoint& point : band)
    body.push_back(
        {{"position_m", point.position_m}, {"low_per_m", point.low_per_m}, {"high_per_m", point.high_per_m}});
  return body;
}

std::vector<BandPoint> band_points_from(const Json& body) {
  std::vector<BandPoint> band;
  for (const Json& point : body)
    band.push_back({point["position_m"].get<double>(), point["low_per_m"].get<double>(),
                    point["high_per_m"].get<double>()});
  return band;
}

Json channels_body(const std::string& unit) {
  return Json::array({{{"name", "mean"}, {"unit", unit}}, {{"name", "standard_deviation"}, {"unit", unit}}});
}

Json stroke_body(const AveragedStroke& stroke) {
  Json body = {{"stroke", stroke.stroke},
               {"from_s", stroke.from_s},
               {"to_s", stroke.to_s},
               {"direction", stroke.direction},
               {"shift_m", stroke.shift_m}};
  if (stroke.correlation) body["correlation"] = *stroke.correlation;
  put_text(body, "recording", stroke.recording);
  put_text(body, "recording_sha256", stroke.recording_sha256);
  return body;
}

AveragedStroke averaged_stroke_from(const Json& body) {
  AveragedStroke stroke{static_cast<int>(number_or(body, "stroke", 0)), number_or(body, "from_s", 0),
                        number_or(body, "to_s", 0), static_cast<int>(number_or(body, "direction", 1)),
                        number_or(body, "shift_m", 0)};
  if (body.contains("correlation")) stroke.correlation = body["correlation"].get<double>();
  stroke.recording = text_or(body, "recording");
  stroke.recording_sha256 = text_or(body, "recording_sha256");
  return stroke;
}

Json average_body(const TextureAverage& average) {
  Json strokes = Json::array(), counts = Json::array();
  for (const AveragedStroke& stroke : average.strokes) strokes.push_back(stroke_body(stroke));
  for (const StrokeCount& count : average.counts)
    counts.push_back({{"position_m", count.position_m}, {"strokes", count.strokes}});
  return {{"align", average.align}, {"strokes", strokes}, {"counts", counts}};
}

TextureAverage average_from(const Json& body) {
  TextureAverage average;
  average.align = text_or(body, "align");
  for (const Json& stroke : body["strokes"]) average.strokes.push_back(averaged_stroke_from(stroke));
  for (const Json& count : body["counts"])
    average.counts.push_back({count["position_m"].get<double>(), count["strokes"].get<int>()});
  return average;
}

PlaybackGain playback_gain_from(const Json& body) {
  return {body["gain_m_per_n"].get<double>(), text_or(body, "who"), text_or(body, "when")};
}

}  // namespace

const char* operation_name(TransformOperation operation) {
  return kOperations[static_cast<std::size_t>(operation)];
}

const char* lengthening_name(Lengthening lengthening) {
  return kLengthenings[static_cast<std::size_t>(lengthening)];
}

std::string verdict_name(PeakVerdict verdict) {
  return kVerdicts[static_cast<std::size_t>(verdict)];
}

Json playback_gain_body(const PlaybackGain& gain) {
  Json body = {{"gain_m_per_n", gain.gain_m_per_n}};
  put_text(body, "who", gain.who);
  put_text(body, "when", gain.when);
  return body;
}

Json texture_body(const Texture& texture, const TextureData& data) {
  Json body = {{"data", {{"file", data.file}, {"sha256", data.sha256}, {"samples", data.samples}}}};
  body["pitch_m"] = texture.signal.pitch_m;
  body["quantity"] = texture.quantity;
  body["unit"] = texture.unit;
  body["direction"] = texture.direction;
  body["source_origin_m"] = texture.source_origin_m;
  if (!texture.valid_band.empty()) body["valid_band"] = band_body(texture.valid_band);
  // A texture that was drawn or computed names no recording.
  if (!texture.source.recording.empty()) body["source"] = source_body(texture.source);
  if (texture.transform) body["transform"] = transform_body(*texture.transform);
  if (texture.average) {
    body["channels"] = channels_body(texture.unit);
    body["average"] = average_body(*texture.average);
  }
  if (texture.playback_gain) body["playback_gain"] = playback_gain_body(*texture.playback_gain);
  for (const auto& [name, member] : kTextureTexts) put_text(body, name, texture.*member);
  if (texture.certificate) body["certificate"] = certificate_body(*texture.certificate);
  return body;
}

Texture texture_from(const Json& body) {
  Texture texture;
  texture.signal.pitch_m = body["pitch_m"].get<double>();
  texture.quantity = text_or(body, "quantity");
  texture.unit = text_or(body, "unit");
  texture.direction = body["direction"].get<int>();
  texture.source_origin_m = number_or(body, "source_origin_m", 0);
  if (body.contains("valid_band")) texture.valid_band = band_points_from(body["valid_band"]);
  if (body.contains("source")) texture.source = source_from(body["source"]);
  if (body.contains("transform")) texture.transform = transform_from(body["transform"]);
  if (body.contains("average")) texture.average = average_from(body["average"]);
  if (body.contains("certificate")) texture.certificate = certificate_from(body["certificate"]);
  if (body.contains("playback_gain")) texture.playback_gain = playback_gain_from(body["playback_gain"]);
  for (const auto& [name, member] : kTextureTexts) texture.*member = text_or(body, name);
  return texture;
}

TextureData texture_data_from(const Json& body) {
  const Json& data = body["data"];
  return {text_or(data, "file"), text_or(data, "sha256"), data["samples"].get<std::uint64_t>(),
          body.contains("average") ? 2U : 1U};
}

}  // namespace tacto::schema
