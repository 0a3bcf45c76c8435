// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/played_texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "analysis/compare/along_path.hpp"
#include "data-schema/texture_wav.hpp"
#include "playback/daemon/session_columns.hpp"
#include "playback/daemon/stroke_report.hpp"

namespace tacto::analysis {
namespace {

using playback::SessionColumns;
using playback::StrokeRange;
using schema::Fault;
using schema::Result;

double length_of(const SessionColumns& columns, const StrokeRange& range) {
  return std::abs(columns.position_m[range.last] - columns.position_m[range.first]);
}

Result<std::size_t> chosen(const SessionColumns& columns, const std::vector<StrokeRange>& ranges,
                           std::size_t stroke, const std::string& session) {
  if (ranges.empty())
    return schema::fail(Fault::unsuitable, "holds no stroke of 5 mm while it plays", session);
  if (stroke > ranges.size())
    return schema::fail(Fault::usage, fmt::format("has {} strokes, and no stroke {}", ranges.size(), stroke),
                        session);
  if (stroke > 0) return stroke - 1;
  const auto longest = std::ranges::max_element(
      ranges, {}, [&](const StrokeRange& range) { return length_of(columns, range); });
  return static_cast<std::size_t>(longest - ranges.begin());
}

Result<void> check_steady_gain(const SessionColumns& columns, const StrokeRange& range,
                               const std::string& session) {
  const auto first = columns.gain.begin() + static_cast<std::ptrdiff_t>(range.first);
  const auto last = columns.gain.begin() + static_cast<std::ptrdiff_t>(range.last);
  if (std::any_of(first, last, [&](double gain) { return gain != *first; }))
    return schema::fail(Fault::unsuitable, "the gain changes within the stroke", session,
                        "name another stroke");
  const auto turns = std::ranges::any_of(columns.turns, [&](const playback::TextureTurn& turn) {
    const double felt_to = static_cast<double>(turn.row) + turn.fade_ticks + columns.look_ahead_ticks;
    return turn.row <= range.last && felt_to >= static_cast<double>(range.first);
  });
  if (turns)
    return schema::fail(Fault::unsuitable, "the texture changes within the stroke", session,
                        "name another stroke");
  return {};
}

// With the textures that the whole stroke is of.
Result<schema::SessionHeader> header_of(const SessionColumns& columns, const StrokeRange& range,
                                        const std::string& session) {
  if (const auto steady = check_steady_gain(columns, range, session); !steady)
    return schema::forward_error(steady);
  schema::SessionHeader header = columns.header;
  const auto later = std::ranges::find_if(
      columns.turns, [&](const playback::TextureTurn& turn) { return turn.row > range.first; });
  if (later == columns.turns.begin()) return header;
  const auto& brings = std::prev(later)->brings;
  if (!brings)
    return schema::fail(Fault::unsuitable,
                        "the texture changes before the stroke, the session does not say to what", session,
                        "name an earlier stroke");
  static_cast<schema::SessionProgram&>(header) = *brings;
  return header;
}

Result<schema::Texture> along(const SessionColumns& columns, const StrokeRange& range) {
  const auto received = playback::received_displacement_m(columns);
  const std::size_t count = range.last - range.first + 1;
  SignalAlongPath signal;
  signal.values = std::span(received).subspan(range.first, count);
  signal.position_m = std::span(columns.position_m).subspan(range.first, count);
  signal.rate_hz = columns.header.rate_hz;
  signal.quantum_m = columns.header.metres_per_count;
  signal.band = {columns.header.low_hz, columns.header.high_hz};
  signal.quantity = "displacement";
  signal.unit = "m";
  return texture_along(signal);
}

}  // namespace

Result<PlayedTexture> played_texture(const std::string& session, std::size_t stroke) {
  const auto columns = playback::read_session_columns(session);
  if (!columns) return schema::forward_error(columns);
  if (columns->lost_at)
    return schema::fail(Fault::unsuitable, fmt::format("{} ticks are missing", columns->lost), session,
                        "compare a session that is whole");
  const auto ranges = playback::stroke_ranges(*columns);
  const auto which = chosen(*columns, ranges, stroke, session);
  if (!which) return schema::forward_error(which);
  auto header = header_of(*columns, ranges[*which], session);
  if (!header) return schema::forward_error(header);
  auto texture = along(*columns, ranges[*which]);
  if (!texture) return schema::forward_error(texture);
  PlayedTexture played{std::move(*texture), std::move(*header), *which + 1, ranges.size(),
                       columns->gain[ranges[*which].first]};
  played.texture.simulated = columns->header.simulated;
  return played;
}

Result<schema::Texture> wanted_of(const schema::Texture& texture, const std::string& file,
                                  const PlayedTexture& played) {
  const auto wav = schema::texture_wav(file);
  if (!wav) return schema::forward_error(wav);
  const auto row = std::ranges::find(played.header.textures, wav->sha256, &schema::SessionTexture::sha256);
  if (row == played.header.textures.end())
    return schema::fail(
        Fault::unsuitable,
        fmt::format("is not what the session played, which is {}", played.header.textures.front().file), file,
        "compare the session with its own texture");
  schema::Texture wanted = texture;
  for (double& value : wanted.signal.values) value *= row->gain_m_per_n * played.gain;
  wanted.quantity = "displacement";
  wanted.unit = "m";
  wanted.source_origin_m = row->at_m;
  return wanted;
}

}  // namespace tacto::analysis
