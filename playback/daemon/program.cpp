// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/creation_time.hpp"
#include "data-schema/files.hpp"
#include "data-schema/version.hpp"

namespace tacto::playback {
namespace {

using schema::fail;
using schema::Fault;
using schema::Result;
using schema::TextureLayer;

constexpr double kUsualGain = 1e-3;  // of a texture that nobody gave one: a fingertip has about 1e3 N/m

bool names_a_scene(const std::string& file) {
  if (file.ends_with(".scene.json") || file.ends_with(".scene")) return true;
  return !schema::is_file(file) && schema::is_file(file + ".scene.json");
}

Result<schema::Scene> scene_of(const ProgramRequest& request) {
  if (!names_a_scene(request.file)) {
    schema::Scene alone;
    alone.layers = {TextureLayer{request.file, request.at_m.value_or(0),
                                 request.gain_m_per_n.value_or(kUsualGain), "", "",
                                 request.ends.value_or(schema::TextureEnds::stop), ""}};
    return alone;
  }
  if (request.at_m || request.gain_m_per_n || request.ends)
    return fail(Fault::usage, "a scene says itself where its textures lie, with which gains and ends",
                request.file, "change the scene, or name a texture");
  return schema::read_scene(request.file);
}

Ends ends_of(schema::TextureEnds ends) {
  if (ends == schema::TextureEnds::loop) return Ends::loop;
  return ends == schema::TextureEnds::mirror ? Ends::mirror : Ends::stop;
}

// The textures of a scene, and what is said of them.
struct Laid {
  std::vector<schema::Texture> textures;
  std::vector<TextureLayer> layers;
  std::vector<schema::SessionTexture> rows;

  Result<void> add(const TextureLayer& layer, const std::string& file) {
    auto texture = schema::read_texture(file);
    if (!texture) return schema::forward_error(texture);
    const std::string stem = schema::stem_of(file, ".texture") + ".texture";
    const auto sum = schema::sha256_of_file(stem + ".wav");
    if (!sum) return schema::forward_error(sum);
    textures.push_back(std::move(*texture));
    layers.push_back(layer);
    rows.push_back({stem + ".json", *sum, layer.at_m, layer.gain_m_per_n, layer.ends});
    return {};
  }
  double end_m() const {
    double end = layers.front().at_m;
    for (std::size_t i = 0; i < layers.size(); ++i)
      end = std::max(end, layers[i].at_m + textures[i].signal.length_m());
    return end;
  }
  double start_m() const { return std::ranges::min(layers, {}, &TextureLayer::at_m).at_m; }
  /// The gain that all share: weights are the layers' parts of it.
  double gain() const {
    double most = 0;
    for (const TextureLayer& layer : layers)
      if (std::abs(layer.gain_m_per_n) > std::abs(most)) most = layer.gain_m_per_n;
    return most;
  }
};

Result<Laid> laid_out(const schema::Scene& scene, const std::string& scene_path) {
  Laid laid;
  for (const schema::Layer& layer : scene.layers) {
    const auto added = std::visit(
        [&](const TextureLayer& texture) {
          const std::string file =
              scene_path.empty() ? texture.texture : schema::texture_in_scene(scene_path, texture.texture);
          return laid.add(texture, file);
        },
        layer);
    if (!added) return schema::forward_error(added);
  }
  const bool several = laid.layers.size() > 1;
  for (std::size_t i = 0; several && i < laid.layers.size(); ++i)
    if (laid.layers[i].ends != schema::TextureEnds::stop)
      return fail(Fault::unsuitable, "one of several textures can't go on beyond its ends",
                  fmt::format("{}#/layers/{}/ends", scene_path, i), "make it \"stop\"");
  if (laid.gain() == 0) return fail(Fault::unsuitable, "every gain is 0", scene_path, "give one a gain");
  return laid;
}

std::vector<PlacedTexture> placed(const Laid& laid) {
  std::vector<PlacedTexture> list;
  for (std::size_t i = 0; i < laid.layers.size(); ++i)
    list.push_back({&laid.textures[i], laid.layers[i].at_m, laid.layers[i].gain_m_per_n / laid.gain()});
  return list;
}

const char* word_of(Inverse inverse) {
  switch (inverse) {
    case Inverse::full:
      return "full";
    case Inverse::magnitude:
      return "magnitude";
    case Inverse::gain:
      return "gain";
    case Inverse::none:
      break;
  }
  return "none";
}

std::string transducer_sum(const std::string& name) {
  for (const std::string& path : {name, name + ".transducer.json"})
    if (schema::is_file(path)) return schema::sha256_of_file(path).value_or("");
  return {};
}

void describe(schema::SessionHeader& session, const Prepared& prepared, const PrepareOptions& options) {
  session.created = schema::creation_time();
  session.creator = kCreator;
  session.build = __VERSION__;
  session.rate_hz = options.rate_hz;
  session.metres_per_count = options.metres_per_count;
  session.inverse = word_of(options.inverse);
  session.delay_s = prepared.delay_left_s;
  session.low_hz = options.band.low_hz;
  session.high_hz = prepared.passes_to_hz;
}

void name_files(Program& program, const Laid& laid) {
  program.session.textures = laid.rows;
  program.session.scene_file = program.scene_path;
  if (program.scene_path.empty()) return;
  program.session.scene_sha256 = schema::sha256_of_file(program.scene_path).value_or("");
}

}  // namespace

Result<Program> make_program(const ProgramRequest& request, const std::string& transducer_name,
                             PrepareOptions options) {
  const auto scene = scene_of(request);
  if (!scene) return schema::forward_error(scene);
  Program program;
  if (names_a_scene(request.file)) program.scene_path = schema::scene_path(request.file);
  auto laid = laid_out(*scene, program.scene_path);
  if (!laid) return schema::forward_error(laid);
  const auto transducer = schema::read_transducer(transducer_name);
  if (!transducer) return schema::forward_error(transducer);
  if (const auto usable = schema::check_usable(*transducer, request.force); !usable)
    return schema::forward_error(usable);
  options.gain_m_per_n = laid->gain();
  options.ends = ends_of(laid->layers.front().ends);
  auto prepared = prepare(placed(*laid), *transducer, options);
  if (!prepared) return schema::forward_error(prepared);
  program.prepared = std::move(*prepared);
  program.length_m = laid->end_m() - laid->start_m();
  program.session.transducer = *transducer;
  program.session.transducer_sha256 = transducer_sum(transducer_name);
  name_files(program, *laid);
  describe(program.session, program.prepared, options);
  return program;
}

}  // namespace tacto::playback
