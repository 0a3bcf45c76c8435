// SPDX-License-Identifier: GPL-3.0-or-later
// Files with samples: recordings, textures, spectrograms and sessions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "analysis/page/html.hpp"
#include "analysis/report/project_readers.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/recording/recording_frames.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/texture.hpp"
#include "playback/session/force_session.hpp"
#include "playback/session/session_rows.hpp"
#include "spatial/picture/spectrogram_figure.hpp"
#include "spatial/spectrogram/spectrogram.hpp"
#include "spatial/texture/make_texture.hpp"
#include "spatial/texture/valid_band.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;
using schema::for_people;
using schema::Result;
using schema::ResultCurve;

constexpr std::size_t kMostPieces = 1000;
constexpr std::size_t kMostKept = 100'000;
constexpr std::size_t kChunk = 1 << 16;

struct ShownUnit {
  double scale;
  const char* symbol;
};

ShownUnit shown_unit(const std::string& unit) {
  if (unit == "N") return {1e3, "mN"};
  if (unit == "m") return {1e3, "mm"};
  return {1, unit.c_str()};
}

std::string name_of_file(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string missing_words(const schema::RecordingHeader& header) {
  std::uint64_t missing = 0;
  for (const schema::Gap& gap : header.gaps) missing += gap.count;
  return header.gaps.empty() ? "none" : fmt::format("{} frames in {} gaps", missing, header.gaps.size());
}

Result<Envelope> channel_envelope(const schema::Recording& recording, std::size_t channel, double scale,
                                  const Progress& progress) {
  auto frames = schema::RecordingFrames::open(recording);
  TACTO_TRY(frames);
  Envelope envelope(recording.header.frames);
  std::vector<double> values;
  for (std::uint64_t at = 0; at < recording.header.frames; at += values.size()) {
    values.resize(std::min<std::uint64_t>(kChunk, recording.header.frames - at));
    TACTO_TRY(frames->read(channel, at, values));
    for (std::size_t i = 0; i < values.size(); ++i)
      envelope.add(schema::frame_time_s(recording.header, at + i), scale * values[i]);
    if (progress) progress(static_cast<double>(at) / static_cast<double>(recording.header.frames));
  }
  return envelope;
}

// The tangential force, otherwise the first channel.
std::size_t main_channel(const schema::RecordingHeader& header) {
  const auto force = schema::find_channel(header, "tangential_force");
  return force.value_or(0);
}

std::string channels_words(const schema::RecordingHeader& header) {
  std::string words;
  for (const schema::Channel& channel : header.channels)
    words += fmt::format("{}{} ({})", words.empty() ? "" : ", ", channel.name, channel.unit);
  return words;
}

std::string band_words(const schema::Texture& texture) {
  if (texture.valid_band.empty()) return "not stated";
  const schema::BandPoint band = spatial::band_throughout(texture.valid_band);
  if (!(band.low_per_m < band.high_per_m)) return "none over the whole length";
  return fmt::format("{} to {} over the whole length",
                     for_people(band.low_per_m, Dimension::spatial_frequency),
                     for_people(band.high_per_m, Dimension::spatial_frequency));
}

std::string in_unit(double value, const std::string& unit) {
  if (unit == "N") return for_people(value, Dimension::force);
  if (unit == "m") return for_people(value, Dimension::length);
  return fmt::format("{:.4g} {}", value, unit);
}

// A texture that is shorter than a window has no spectrogram, only its curve.
Result<void> draw_texture(const schema::Texture& texture, const std::string& name, ProjectFile& file) {
  auto spectrogram = spatial::spatial_spectrogram(texture, {});
  if (!spectrogram) {
    const ShownUnit unit = shown_unit(texture.unit);
    Envelope envelope(texture.signal.values.size());
    for (std::size_t i = 0; i < texture.signal.values.size(); ++i)
      envelope.add(1e3 * texture.signal.position_m(i), unit.scale * texture.signal.values[i]);
    file.pictures.push_back(envelope.picture(
        name, "position (mm)", fmt::format("{} ({})", texture.quantity, unit.symbol), unit.symbol));
    return {};
  }
  spectrogram->name = name;
  schema::Texture shown = texture;
  if (!shown.simulated.empty()) shown.simulated = kSimulatedOnPage;
  auto svg = spatial::to_page_svg(spatial::SpectrogramFigure({{&shown, &*spectrogram}}));
  TACTO_TRY(svg);
  file.drawings.push_back(std::move(*svg));
  return {};
}

}  // namespace

Envelope::Envelope(std::size_t samples)
    : per_piece_(samples / kMostPieces + 1), per_kept_(samples / kMostKept + 1) {}

void Envelope::add(double x, double y) {
  if (in_piece_ == 0)
    pieces_.push_back({x, y, y});
  else
    pieces_.back() = {pieces_.back().x, std::min(pieces_.back().low, y), std::max(pieces_.back().high, y)};
  in_piece_ = (in_piece_ + 1) % per_piece_;
  if (seen_++ % per_kept_ == 0) kept_.push_back(y);
}

ResultCurve Envelope::curve(const spatial::ShownRange& range) const {
  ResultCurve curve{"", {}, {}, false};
  // A value beyond the axis is a gap: at the axis's end it would look like a saturated sensor.
  const auto shown = [&](double value) { return value >= range.low && value <= range.high ? value : NAN; };
  for (const Piece& piece : pieces_) {
    curve.x.push_back(piece.x);
    curve.y.push_back(shown(piece.low));
    if (piece.high == piece.low) continue;
    curve.x.push_back(piece.x);
    curve.y.push_back(shown(piece.high));
  }
  return curve;
}

double Envelope::least() const {
  return pieces_.empty() ? 0 : std::ranges::min_element(pieces_, {}, &Piece::low)->low;
}

double Envelope::most() const {
  return pieces_.empty() ? 0 : std::ranges::max_element(pieces_, {}, &Piece::high)->high;
}

schema::ResultPicture Envelope::picture(const std::string& title, const std::string& x_label,
                                        const std::string& y_label, const std::string& unit) const {
  const double low = least(), high = most();
  constexpr double kFew = 1e-3;  // more than that are no spikes, but a part of the signal
  spatial::ShownRange range = spatial::shown_range(kept_);
  if (static_cast<double>(range.beyond) > kFew * static_cast<double>(range.values)) range.beyond = 0;
  if (range.beyond == 0) range.low = low, range.high = high;
  if (range.beyond > 0) range.furthest = std::abs(low) > std::abs(high) ? low : high;
  const std::string words = range.beyond == 0 ? "" : ": " + spatial::out_of_range_text(range, unit);
  return {title + words, x_label, y_label, false, {curve(range)}};
}

Result<void> add_recording(const std::string& path, ProjectFile& file, const Progress& progress) {
  const auto recording = schema::open_recording(path);
  TACTO_TRY(recording);
  const schema::RecordingHeader& header = recording->header;
  file.date = header.recorded.empty() ? header.created : header.recorded;
  file.origin = header.device.empty() ? header.source_file : header.device;
  file.simulated = header.simulated;
  file.figures = {{"duration", for_people(schema::duration_s(header), Dimension::time)},
                  {"rate", for_people(header.sample_rate_hz, Dimension::frequency)},
                  {"channels", channels_words(header)},
                  {"missing", missing_words(header)}};
  if (!header.surface.empty()) file.figures.push_back({"surface", header.surface});
  if (header.channels.empty() || header.frames == 0) return {};
  const std::size_t channel = main_channel(header);
  const schema::Channel& shown = header.channels[channel];
  const ShownUnit unit = shown_unit(shown.unit);
  const auto envelope = channel_envelope(*recording, channel, unit.scale, progress);
  TACTO_TRY(envelope);
  file.pictures.push_back(envelope->picture(name_of_file(path), "time (s)",
                                            fmt::format("{} ({})", shown.name, unit.symbol), unit.symbol));
  return {};
}

namespace {

void add_transform_figures(const schema::TextureTransform& transform, ProjectFile& file) {
  std::string names, steps;
  for (const schema::TransformSource& source : transform.sources)
    names += (names.empty() ? "" : ", ") + source.texture;
  for (const schema::TransformStep& step : transform.steps) {
    steps += fmt::format("{}{}", steps.empty() ? "" : ", ", schema::operation_name(step.operation));
    if (step.factor) steps += fmt::format(" {:.4g}x", *step.factor);
    if (step.joint_error) steps += fmt::format(" (error of the joint {:.2g})", *step.joint_error);
  }
  file.origin = names;
  file.figures.push_back({"operations", steps});
}

}  // namespace

Result<void> add_texture_file(const std::string& path, ProjectFile& file) {
  const auto texture = schema::read_texture(path);
  TACTO_TRY(texture);
  file.date = texture->created;
  file.origin = texture->source.recording;
  file.simulated = texture->simulated;
  file.figures = {{"length", for_people(texture->signal.length_m(), Dimension::length)},
                  {"grid", for_people(texture->signal.pitch_m, Dimension::length)},
                  {texture->quantity + ", RMS", in_unit(spatial::rms_of(*texture), texture->unit)},
                  {"valid band", band_words(*texture)}};
  if (texture->source.mean_speed_mps > 0)
    file.figures.push_back({"mean speed", for_people(texture->source.mean_speed_mps, Dimension::speed)});
  if (texture->transform) add_transform_figures(*texture->transform, file);
  if (texture->average)
    file.figures.push_back({"mean of", fmt::format("{} strokes", texture->average->strokes.size())});
  return draw_texture(*texture, name_of_file(path), file);
}

Result<void> add_spectrogram(const std::string& path, ProjectFile& file) {
  const auto spectrogram = schema::read_spectrogram_nc(path);
  TACTO_TRY(spectrogram);
  file.origin = spectrogram->name;
  file.simulated = spectrogram->simulated;
  file.figures = {{"strokes", std::to_string(spectrogram->strokes)},
                  {"positions", std::to_string(spectrogram->position_m.size())},
                  {"window", for_people(spectrogram->window_m, Dimension::length)}};
  if (spectrogram->bins > 0)
    file.figures.push_back({"up to", for_people(spectrogram->frequency_per_m(spectrogram->bins - 1),
                                                Dimension::spatial_frequency)});
  return {};
}

namespace {

constexpr std::size_t kMostTurnsShown = 20;

void add_turns(const std::vector<playback::TextureChange>& turns, ProjectFile& file) {
  for (std::size_t i = 0; i < std::min(turns.size(), kMostTurnsShown); ++i) {
    const playback::TextureChange& turn = turns[i];
    std::string names = turn.brings ? "" : "not named";
    if (turn.brings)
      for (const schema::SessionTexture& texture : turn.brings->textures)
        names += (names.empty() ? "" : ", ") + name_of_file(texture.file);
    file.figures.push_back({"changed at " + for_people(turn.time_s, Dimension::time), names});
  }
}

// The curves of a session, reduced to a size that does not depend on the number of ticks.
struct TicksShown {
  Envelope drive, position;
  double peak_v = 0, last_s = 0;

  explicit TicksShown(std::uint64_t ticks) : drive(ticks), position(ticks) {}
  void add(const playback::SessionRow& row) {
    drive.add(row.time_s, row.drive_v);
    position.add(row.time_s, 1e3 * row.position_m);
    peak_v = std::max(peak_v, std::abs(row.drive_v));
    last_s = row.time_s;
  }
  void draw(ProjectFile& file) const {
    file.pictures.push_back(drive.picture("Drive", "time (s)", "drive (V)", "V"));
    file.pictures.push_back(position.picture("Finger", "time (s)", "position (mm)", "mm"));
  }
};

// Places and forces of the axes.
Result<void> add_force_session(const std::string& path, const schema::SessionHeader& header,
                               ProjectFile& file) {
  const auto session = playback::read_force_session(path);
  TACTO_TRY(session);
  std::vector<Envelope> places(session->axes.size(), Envelope(session->ticks)), forces = places;
  double last_s = 0;
  const auto add = [&](const schema::SessionTick& tick, double time_s) {
    last_s = time_s;
    for (std::size_t i = 0; i < places.size(); ++i) {
      places[i].add(time_s, 1e3 * tick.counts[i] * header.forces->axes[i].encoder_step_m);
      forces[i].add(time_s, double{tick.force_n[i]});
    }
  };
  TACTO_TRY(playback::read_force_session(path, add));
  file.figures = {{"played", for_people(last_s, Dimension::time)},
                  {"ticks", fmt::format("{}, {} lost, at {}", session->ticks, session->lost,
                                        for_people(header.rate_hz, Dimension::frequency))},
                  {"scene", name_of_file(header.scene_file)}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const playback::ForceSessionAxis& axis = session->axes[i];
    file.figures.push_back(
        {"axis " + axis.name,
         fmt::format("{} to {}; force, RMS and peak: {}, {}", for_people(axis.from_m, Dimension::length),
                     for_people(axis.to_m, Dimension::length), for_people(axis.force_rms_n, Dimension::force),
                     for_people(axis.force_peak_n, Dimension::force))});
    file.pictures.push_back(
        forces[i].picture("Force along " + axis.name, "time (s)", "force on the hand (N)", "N"));
    file.pictures.push_back(places[i].picture("Hand along " + axis.name, "time (s)", "position (mm)", "mm"));
  }
  return {};
}

}  // namespace

Result<void> add_session(const std::string& path, ProjectFile& file, const Progress& progress) {
  const auto reader = schema::SessionReader::open(path);
  TACTO_TRY(reader);
  file.date = reader->header().created;
  file.origin = reader->header().device_uri;
  file.simulated = reader->header().simulated;
  if (reader->header().forces) return add_force_session(path, reader->header(), file);
  const auto overview = playback::session_overview(path, playback::part_of(progress, 0, 0.5));
  TACTO_TRY(overview);
  playback::RowMaker maker(*overview);
  TicksShown ticks(overview->ticks);
  const auto read = playback::read_rows(
      maker, path, [&](const playback::SessionRow& row) { ticks.add(row); },
      playback::part_of(progress, 0.5, 1));
  if (!read) return read;
  const schema::SessionHeader& header = overview->header;
  file.figures = {{"played", for_people(ticks.last_s, Dimension::time)},
                  {"ticks", fmt::format("{}, {} lost, at {}", overview->ticks, overview->lost,
                                        for_people(header.rate_hz, Dimension::frequency))},
                  {"drive, peak", for_people(ticks.peak_v, Dimension::voltage)},
                  {"transducer", header.transducer.name}};
  for (const schema::SessionTexture& texture : header.textures)
    file.figures.push_back({"texture", name_of_file(texture.file)});
  add_turns(maker.turns(), file);
  ticks.draw(file);
  return {};
}

}  // namespace tacto::analysis
