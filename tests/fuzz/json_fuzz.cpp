// SPDX-License-Identifier: GPL-3.0-or-later
// JSON from outside: the first byte selects whether the rest is a line to the daemon's socket ('c'), a
// message of the page of `tactograph live` ('l') or a scene. All are in one program because their common code
// takes minutes to compile. A line gives a request or an error with a place; a valid request, written again,
// is still valid; replies to it are lines that clients can parse. A valid scene has layers with numbers in
// their ranges, and one with patches or pieces reads the same after it is written; an invalid one gives an
// error with a place.
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>

#include "data-schema/control/control.hpp"
#include "data-schema/control/live_request.hpp"
#include "data-schema/scene/scene.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

namespace {

using namespace tacto::schema;
using tacto::tests::demand;

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

void live_message(const std::string& text) {
  const auto request = parse_live_request(text);
  if (!request) {
    demand(request.error().kind == ErrorKind::malformed && !request.error().what.empty() &&
           request.error().where.starts_with("request"));
    return;
  }
  demand(request->verb <= LiveVerb::save && std::abs(request->times) <= kMostTimes &&
         request->files.size() <= 2);
  demand(request->verb != LiveVerb::load || request->texture.has_value());
  demand(request->verb != LiveVerb::gain || std::isfinite(request->times_default.value()));
}

void number(const LayerNumber& number) {
  demand(std::isfinite(number.value));
  if (number.slider) demand(number.slider->from <= number.value && number.value <= number.slider->to);
}

std::size_t patch(const Patch& patch) {
  demand(!patch.name.empty() && patch.width_m > 0 && patch.height_m > 0 && !patch.layers.empty());
  for (const ForceLayer& layer : patch.layers) {
    demand(!type_of(layer).empty());
    for (const NamedLayerNumber& named : numbers_of(layer)) number(named.number);
  }
  return patch.layers.size();
}

std::string written(const std::string& stem, const Scene& scene) {
  demand(write_scene(stem, scene).has_value());
  std::ifstream file(scene_path(stem), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// What was read is written, and read again, with the same numbers; written once more, it is the same file.
void written_again(const Scene& scene) {
  const std::string stem = (tacto::tests::fuzz_folder() / "again").string();
  const std::string first = written(stem, scene);
  const auto again = read_scene(stem);
  demand(again && again->patches.size() == scene.patches.size() &&
         again->pieces.size() == scene.pieces.size());
  demand(written(stem + "2", *again) == first);
  for (std::size_t i = 0; i < scene.patches.size(); ++i)
    for (std::size_t j = 0; j < scene.patches[i].layers.size(); ++j) {
      const auto ours = numbers_of(scene.patches[i].layers[j]),
                 theirs = numbers_of(again->patches[i].layers[j]);
      demand(ours.size() == theirs.size());
      for (std::size_t k = 0; k < ours.size(); ++k) demand(ours[k].number == theirs[k].number);
    }
}

void scene(const std::string& text) {
  const auto read = parse_scene(text, "fuzz");
  if (!read) {
    demand(read.error().where.starts_with("fuzz") && !read.error().what.empty());
    return;
  }
  demand(!read->layers.empty() || !read->patches.empty() || !read->pieces.empty());
  demand(read->layers.size() <= kMostLayers);
  for (const Layer& layer : read->layers) {
    const auto texture = layer.visit([](const TextureLayer& of) { return of; });
    demand(!texture.texture.empty() && std::abs(texture.at_m) <= 1000);
    demand(std::abs(texture.gain_m_per_n) <= 1 && texture.ends <= TextureEnds::loop);
  }
  std::size_t layers = read->layers.size();
  for (const Patch& of : read->patches) layers += patch(of);
  demand(layers <= kMostLayers);
  if (!read->patches.empty() || !read->pieces.empty()) written_again(*read);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] == 'c') control_line(text);
  if (data[0] == 'l') live_message(text);
  if (data[0] != 'c' && data[0] != 'l') scene(text);
  return 0;
}
