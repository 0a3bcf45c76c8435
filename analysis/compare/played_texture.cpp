// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/played_texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "analysis/compare/along_path.hpp"
#include "data-schema/texture/texture_wav.hpp"
#include "playback/strokes/session_stroke.hpp"

namespace tacto::analysis {
namespace {

using playback::SessionStroke;
using schema::ErrorKind;
using schema::Result;

Result<void> check_steady(const SessionStroke& stroke, const std::string& session) {
  const double gain = stroke.rows.front().gain;
  if (std::ranges::any_of(stroke.rows, [&](const playback::SessionRow& row) { return row.gain != gain; }))
    return schema::fail(ErrorKind::unsuitable, "the gain changes within the stroke", session,
                        "name another stroke");
  const auto first = static_cast<double>(stroke.first_row);
  const std::uint64_t last = stroke.first_row + stroke.rows.size() - 1;
  const auto turns = std::ranges::any_of(stroke.turns, [&](const playback::TextureChange& turn) {
    const double played_to =
        static_cast<double>(turn.row) + turn.fade_ticks + stroke.overview.look_ahead_ticks;
    return turn.row <= last && played_to >= first;
  });
  if (turns)
    return schema::fail(ErrorKind::unsuitable, "the texture changes within the stroke", session,
                        "name another stroke");
  return {};
}

Result<void> check_reach(const SessionStroke& stroke, const playback::ProfileReach& reach,
                         const std::string& session) {
  const auto held = [&](const playback::SessionRow& row) { return reach.holds(row.encoder); };
  if (std::ranges::all_of(stroke.rows, held)) return {};
  return schema::fail(ErrorKind::unsuitable,
                      "the stroke goes beyond the range in which the device reads the texture (`tactograph "
                      "session` reports it)",
                      session, "name another stroke");
}

// The session's header with the textures that apply to the whole stroke.
Result<schema::SessionHeader> header_of(const SessionStroke& stroke, const std::string& session) {
  TACTO_TRY(check_steady(stroke, session));
  schema::SessionHeader header = stroke.overview.header;
  const auto later = std::ranges::find_if(
      stroke.turns, [&](const playback::TextureChange& turn) { return turn.row > stroke.first_row; });
  const auto& reach = later == stroke.turns.begin() ? stroke.overview.reach : std::prev(later)->reach;
  TACTO_TRY(check_reach(stroke, reach, session));
  if (later == stroke.turns.begin()) return header;
  const auto& brings = std::prev(later)->brings;
  if (!brings)
    return schema::fail(ErrorKind::unsuitable,
                        "the texture changes before the stroke, and the session does not name the new one",
                        session, "name an earlier stroke");
  static_cast<schema::SessionProgram&>(header) = *brings;
  return header;
}

Result<schema::Texture> along(const SessionStroke& stroke) {
  const schema::SessionHeader& header = stroke.overview.header;
  std::vector<double> position_m(stroke.rows.size());
  std::ranges::transform(stroke.rows, position_m.begin(), &playback::SessionRow::position_m);
  SignalAlongPath signal;
  signal.values = stroke.predicted_m;
  signal.position_m = position_m;
  signal.rate_hz = header.rate_hz;
  signal.quantum_m = header.metres_per_count;
  signal.band = {header.low_hz, header.high_hz};
  signal.quantity = "displacement";
  signal.unit = "m";
  return texture_along(signal);
}

}  // namespace

Result<PlayedTexture> played_texture(const std::string& session, std::size_t stroke,
                                     const std::function<void(double)>& progress) {
  const auto found = playback::read_session_stroke(session, stroke, progress);
  TACTO_TRY(found);
  auto header = header_of(*found, session);
  TACTO_TRY(header);
  auto texture = along(*found);
  TACTO_TRY(texture);
  PlayedTexture played{std::move(*texture), std::move(*header), found->stroke, found->strokes,
                       found->rows.front().gain};
  played.texture.simulated = found->overview.header.simulated;
  return played;
}

Result<schema::Texture> target_of(const schema::Texture& texture, const std::string& file,
                                  const PlayedTexture& played) {
  const auto wav = schema::texture_wav(file);
  TACTO_TRY(wav);
  const auto row = std::ranges::find(played.header.textures, wav->sha256, &schema::SessionTexture::sha256);
  if (row == played.header.textures.end())
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("is not the texture that the session played, which is {}",
                                    played.header.textures.front().file),
                        file, "compare the session with its own texture");
  schema::Texture target = texture;
  for (double& value : target.signal.values) value *= row->gain_m_per_n * played.gain;
  target.quantity = "displacement";
  target.unit = "m";
  target.source_origin_m = row->at_m;
  return target;
}

}  // namespace tacto::analysis
