// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/recording/recording_json.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data-schema/base/format_version.hpp"
#include "data-schema/transducer/transducer_json.hpp"

namespace tacto::schema {

Json body_of(const Gap& gap) {
  return {{"frame", gap.frame}, {"device_sequence", gap.device_sequence}, {"count", gap.count}};
}
Gap gap_from(const Json& body) {
  return {body.at("frame"), body.at("device_sequence"), body.at("count")};
}

Json body_of(const Mark& mark) {
  return {{"frame", mark.frame}, {"label", mark.label}};
}
Mark mark_from(const Json& body) {
  return {body.at("frame"), body.at("label")};
}

Json body_of(const ClockPair& pair) {
  return {{"device_sequence", pair.device_sequence}, {"device_s", pair.device_s}, {"host_s", pair.host_s}};
}
ClockPair clock_pair_from(const Json& body) {
  return {body.at("device_sequence"), body.at("device_s"), body.at("host_s")};
}

Json body_of(const FaultNote& fault) {
  return {{"frame", fault.frame}, {"what", fault.what}};
}
FaultNote fault_from(const Json& body) {
  return {body.at("frame"), body.at("what")};
}

namespace {

struct HeaderText {
  const char* name;
  std::string RecordingHeader::*member;
};

constexpr HeaderText kHeaderTexts[] = {
    {"clock", &RecordingHeader::clock},
    {"device", &RecordingHeader::device},
    {"serial", &RecordingHeader::serial},
    {"firmware", &RecordingHeader::firmware},
    {"simulated", &RecordingHeader::simulated},
    {"source_file", &RecordingHeader::source_file},
    {"source_sha256", &RecordingHeader::source_sha256},
    {"recorded", &RecordingHeader::recorded},
    {"created", &RecordingHeader::created},
    {"creator", &RecordingHeader::creator},
    {"subject", &RecordingHeader::subject},
    {"finger", &RecordingHeader::finger},
    {"surface", &RecordingHeader::surface},
    {"notes", &RecordingHeader::notes},
    {"ended", &RecordingHeader::ended},
};

struct NumberMember {
  const char* name;
  std::optional<double> RecordingHeader::*member;
};

constexpr NumberMember kHeaderNumbers[] = {
    {"humidity_percent", &RecordingHeader::humidity_percent},
    {"clock_drift_ppm", &RecordingHeader::clock_drift_ppm},
    {"clock_drift_uncertainty_ppm", &RecordingHeader::clock_drift_uncertainty_ppm},
    {"clock_offset_s", &RecordingHeader::clock_offset_s},
    {"clock_scatter_s", &RecordingHeader::clock_scatter_s},
};

struct FormatName {
  SampleFormat format;
  const char* name;
};

constexpr FormatName kFormatNames[] = {
    {SampleFormat::pcm32, "pcm32"}, {SampleFormat::float32, "float32"}, {SampleFormat::float64, "float64"}};

const char* name_of(SampleFormat format) {
  return std::ranges::find(kFormatNames, format, &FormatName::format)->name;
}

SampleFormat format_named(std::string_view name) {
  return std::ranges::find(kFormatNames, name, &FormatName::name)->format;
}

void put_number(Json& body, const char* key, const std::optional<double>& number) {
  if (number) body[key] = *number;
}

std::optional<double> optional_number(const Json& body, const char* key) {
  return body.contains(key) ? std::optional(body[key].get<double>()) : std::nullopt;
}

template <class Item, class ToJson>
void put_list(Json& body, const char* key, const std::vector<Item>& items, ToJson to_json) {
  for (const Item& item : items) body[key].push_back(to_json(item));
}

template <class FromJson>
auto list_from(const Json& body, const char* key, FromJson from_json) {
  std::vector<decltype(from_json(body))> items;
  if (body.contains(key)) std::ranges::transform(body[key], std::back_inserter(items), from_json);
  return items;
}

Json calibration_body(const AppliedCalibration& applied) {
  Json body = {{"nominal_scale", applied.nominal_scale}, {"nominal_offset", applied.nominal_offset}};
  put_text(body, "scale_date", applied.scale_date);
  put_text(body, "scale_method", applied.scale_method);
  put_number(body, "scale_uncertainty", applied.scale_uncertainty);
  put_text(body, "zero_date", applied.zero_date);
  put_number(body, "zero_uncertainty", applied.zero_uncertainty);
  return body;
}

AppliedCalibration applied_from(const Json& body) {
  return {body["nominal_scale"],
          body["nominal_offset"],
          text_or(body, "scale_date"),
          text_or(body, "scale_method"),
          optional_number(body, "scale_uncertainty"),
          text_or(body, "zero_date"),
          optional_number(body, "zero_uncertainty")};
}

Json stroke_body(const StrokeFigures& stroke) {
  Json body = {{"first_frame", stroke.first_frame},
               {"frames", stroke.frames},
               {"length_m", stroke.length_m},
               {"direction", stroke.direction},
               {"mean_speed_mps", stroke.mean_speed_mps}};
  put_number(body, "mean_normal_n", stroke.mean_normal_n);
  body["clipped_samples"] = stroke.clipped_samples;
  body["lost_frames"] = stroke.lost_frames;
  return body;
}

StrokeFigures stroke_from(const Json& body) {
  return {body["first_frame"],     body["frames"],         body["length_m"],
          body["direction"],       body["mean_speed_mps"], optional_number(body, "mean_normal_n"),
          body["clipped_samples"], body["lost_frames"]};
}

Json channel_body(const Channel& channel) {
  Json body = {{"name", channel.name},
               {"quantity", channel.quantity},
               {"unit", channel.unit},
               {"scale", channel.scale},
               {"offset", channel.offset}};
  put_number(body, "native_rate_hz", channel.native_rate_hz);
  put_number(body, "range_min", channel.range_min);
  put_number(body, "range_max", channel.range_max);
  put_text(body, "source", channel.source);
  put_text(body, "derivation", channel.derivation);
  put_text(body, "calibrated", channel.calibrated);
  if (channel.calibration) body["calibration"] = calibration_body(*channel.calibration);
  return body;
}

Channel channel_from(const Json& body) {
  Channel channel;
  channel.name = body["name"];
  channel.quantity = body["quantity"];
  channel.unit = body["unit"];
  channel.scale = body["scale"];
  channel.offset = body["offset"];
  channel.native_rate_hz = optional_number(body, "native_rate_hz");
  channel.range_min = optional_number(body, "range_min");
  channel.range_max = optional_number(body, "range_max");
  channel.source = text_or(body, "source");
  channel.derivation = text_or(body, "derivation");
  channel.calibrated = text_or(body, "calibrated");
  if (body.contains("calibration")) channel.calibration = applied_from(body["calibration"]);
  return channel;
}

// A document inside the sidecar: it has its own version, and can be copied to a file.
Json embedded_transducer(const Transducer& transducer) {
  Json body = {{"kind", "transducer"}, {"version", kFormatVersion}};
  body.update(transducer_body(transducer));
  return body;
}

Json data_body(const RecordingHeader& header) {
  return {{"file", header.wav_file},
          {"sha256", header.sha256},
          {"format", name_of(header.format)},
          {"frames", header.frames}};
}

Json recording_body(const RecordingHeader& header) {
  Json body = {
      {"data", data_body(header)}, {"sample_rate_hz", header.sample_rate_hz}, {"channels", Json::array()}};
  put_list(body, "channels", header.channels, channel_body);
  for (const auto& [name, member] : kHeaderTexts) put_text(body, name, header.*member);
  for (const auto& [name, member] : kHeaderNumbers) put_number(body, name, header.*member);
  if (header.transducer) body["transducer"] = embedded_transducer(*header.transducer);
  put_list(body, "gaps", header.gaps, [](const Gap& each) { return body_of(each); });
  put_list(body, "marks", header.marks, [](const Mark& each) { return body_of(each); });
  put_list(body, "clock_pairs", header.clock_pairs, [](const ClockPair& each) { return body_of(each); });
  put_list(body, "faults", header.faults, [](const FaultNote& each) { return body_of(each); });
  put_list(body, "strokes", header.strokes, stroke_body);
  put_list(body, "warnings", header.warnings, [](const std::string& text) { return Json(text); });
  return body;
}

RecordingHeader header_from(const Json& body) {
  RecordingHeader header;
  const Json& data = body["data"];
  header.wav_file = data["file"];
  header.sha256 = data["sha256"];
  header.format = format_named(data["format"].get_ref<const std::string&>());
  header.frames = data["frames"];
  header.sample_rate_hz = body["sample_rate_hz"];
  header.channels = list_from(body, "channels", channel_from);
  for (const auto& [name, member] : kHeaderTexts) header.*member = text_or(body, name);
  for (const auto& [name, member] : kHeaderNumbers) header.*member = optional_number(body, name);
  if (body.contains("transducer")) header.transducer = transducer_from(body["transducer"]);
  header.gaps = list_from(body, "gaps", gap_from);
  header.marks = list_from(body, "marks", mark_from);
  header.clock_pairs = list_from(body, "clock_pairs", clock_pair_from);
  header.faults = list_from(body, "faults", fault_from);
  header.strokes = list_from(body, "strokes", stroke_from);
  header.warnings = list_from(body, "warnings", [](const Json& text) { return text.get<std::string>(); });
  return header;
}

// Checks that a schema cannot express: a channel has the unit of its quantity, and a unique name.
std::optional<Violation> channel_breach(const RecordingHeader& header, std::size_t i) {
  const Channel& channel = header.channels[i];
  const auto quantity = quantity_named(channel.quantity);
  if (quantity && si_symbol(quantity->dimension) != channel.unit)
    return Violation{fmt::format("/channels/{}/unit", i),
                     fmt::format("{} is in {}, not in {}", channel.quantity, si_symbol(quantity->dimension),
                                 channel.unit)};
  const auto first = std::ranges::find(header.channels, channel.name, &Channel::name);
  if (first != header.channels.begin() + static_cast<std::ptrdiff_t>(i))
    return Violation{fmt::format("/channels/{}/name", i),
                     fmt::format("there are two channels '{}'", channel.name)};
  return std::nullopt;
}

std::optional<Violation> gap_breach(const RecordingHeader& header, std::size_t i) {
  const std::uint64_t frame = header.gaps[i].frame;
  if (frame > header.frames || (i > 0 && frame < header.gaps[i - 1].frame))
    return Violation{fmt::format("/gaps/{}/frame", i),
                     fmt::format("gaps must increase and end at frame {} or before", header.frames)};
  if (i > 0 && frame == header.gaps[i - 1].frame &&
      header.gaps[i].device_sequence == header.gaps[i - 1].device_sequence)
    return Violation{fmt::format("/gaps/{}/device_sequence", i), "the same gap occurs twice"};
  return std::nullopt;
}

}  // namespace

std::vector<Violation> recording_breaches(const RecordingHeader& header) {
  std::vector<Violation> breaches;
  for (std::size_t i = 0; i < header.channels.size(); ++i)
    if (auto breach = channel_breach(header, i)) breaches.push_back(std::move(*breach));
  for (std::size_t i = 0; i < header.gaps.size(); ++i)
    if (auto breach = gap_breach(header, i)) breaches.push_back(std::move(*breach));
  return breaches;
}

Result<std::string> recording_text(const RecordingHeader& header) {
  if (const auto breaches = recording_breaches(header); !breaches.empty())
    return fail(ErrorKind::unsuitable, breaches.front().what, breaches.front().pointer);
  return document_text("recording", recording_body(header), header.extra_json);
}

RecordingHeader recording_header_unchecked(const Document& document) {
  RecordingHeader header = header_from(document.body);
  keep_unknown(document, header);
  return header;
}

Result<RecordingHeader> recording_header_from(const Document& document, const std::string& path) {
  RecordingHeader header = recording_header_unchecked(document);
  if (const auto breaches = recording_breaches(header); !breaches.empty())
    return fail(ErrorKind::malformed, breaches.front().what, path + "#" + breaches.front().pointer);
  return header;
}

}  // namespace tacto::schema
