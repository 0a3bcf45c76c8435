// SPDX-License-Identifier: GPL-3.0-or-later
// JSON from outside: the first byte says whether the rest is a line to the daemon's socket ('c') or a scene.
// One program for both, for what they share takes minutes to compile.
//   A line is a request or an error that names a place; a request that was understood is understood again
//   when it is written; replies to it are lines that clients can read. A scene that is read has layers with
//   numbers in their ranges; one that is refused names a place.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "data-schema/control/control.hpp"
#include "data-schema/scene/scene.hpp"

namespace {

using namespace tacto::schema;

void demand(bool holds) {
  if (!holds) std::abort();
}

void demand_one_line(const std::string& line) {
  demand(!line.empty() && line.find('\n') == line.size() - 1);
}

void control_line(const std::string& text) {
  std::string id;
  const auto request = parse_control_request(text, &id);
  (void)parse_control_reply(text);
  if (!request) {
    demand(!request.error().what.empty() && !request.error().where.empty());
    const std::string line = control_error_line(id, request.error());
    demand_one_line(line);
    const auto reply = parse_control_reply(line);
    demand(reply && !reply->ok);
    return;
  }
  const std::string line = control_request_line(*request);
  demand_one_line(line);
  const auto again = parse_control_request(line);
  demand(again.has_value());
  demand(again->verb == request->verb && again->file == request->file && again->gain == request->gain);
  const auto reply = parse_control_reply(
      control_reply_line(request->id_json, {{"file", request->file}, {"not_finite", std::nan("")}}));
  demand(reply && reply->ok && control_text(reply->fields, "file") == request->file);
}

void scene(const std::string& text) {
  const auto read = parse_scene(text, "fuzz");
  if (!read) {
    demand(read.error().where.starts_with("fuzz") && !read.error().what.empty());
    return;
  }
  demand(!read->layers.empty() && read->layers.size() <= 256);
  for (const Layer& layer : read->layers) {
    const auto texture = layer.visit([](const TextureLayer& of) { return of; });
    demand(!texture.texture.empty() && std::abs(texture.at_m) <= 1000);
    demand(std::abs(texture.gain_m_per_n) <= 1 && texture.ends <= TextureEnds::loop);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] == 'c') control_line(text);
  if (data[0] != 'c') scene(text);
  return 0;
}
