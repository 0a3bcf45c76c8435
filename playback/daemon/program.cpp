// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <system_error>

#include "data-schema/creation_time.hpp"
#include "data-schema/files.hpp"
#include "data-schema/texture_wav.hpp"
#include "data-schema/version.hpp"
#include "playback/displacement_limit.hpp"

namespace tacto::playback {
namespace {

using schema::fail;
using schema::Fault;
using schema::Result;
using schema::TextureLayer;

constexpr double kUsualGain = 1e-3;    // of a texture that nobody gave one: a fingertip has about 1e3 N/m
constexpr double kLongestOnsetS = 10;  // the wire's
constexpr double kFarthestSamples = 1 << 29;  // from the encoder's zero: the wire's 2^61, in 2^32 a sample
constexpr double kMostPathSamples = 1 << 24;  // 168 m at 10 um; as many as all levels together may have

bool names_a_scene(const std::string& file) {
  if (file.ends_with(".scene.json") || file.ends_with(".scene")) return true;
  return !schema::is_file(file) && schema::is_file(file + ".scene.json");
}

// What was asked for, else what the texture keeps, else the usual.
Result<schema::Scene> scene_of_texture(const ProgramRequest& request,
                                       std::optional<schema::PlaybackGain>& kept_gain) {
  if (!request.gain_m_per_n) {
    auto kept = schema::read_playback_gain(request.file);
    if (!kept) return schema::forward_error(kept);
    kept_gain = std::move(*kept);
  }
  const double usual = kept_gain ? kept_gain->gain_m_per_n : kUsualGain;
  schema::Scene alone;
  alone.layers = {TextureLayer{request.file, request.at_m.value_or(0), request.gain_m_per_n.value_or(usual),
                               "", "", request.ends.value_or(schema::TextureEnds::stop), ""}};
  return alone;
}

Result<schema::Scene> scene_of(const ProgramRequest& request,
                               std::optional<schema::PlaybackGain>& kept_gain) {
  if (!names_a_scene(request.file)) return scene_of_texture(request, kept_gain);
  if (request.at_m || request.gain_m_per_n || request.ends)
    return fail(Fault::usage, "a scene says itself where its textures lie, with which gains and ends",
                request.file, "change the scene, or name a texture");
  return schema::read_scene(request.file);
}

Ends ends_of(schema::TextureEnds ends) {
  if (ends == schema::TextureEnds::loop) return Ends::loop;
  return ends == schema::TextureEnds::mirror ? Ends::mirror : Ends::stop;
}

// A session is read in other folders too.
std::string full_path(const std::string& path) {
  std::error_code ignored;
  const auto full = std::filesystem::absolute(path, ignored);
  return ignored ? path : full.lexically_normal().string();
}

// The textures of a scene, and what is said of them.
struct Laid {
  struct File {
    schema::Texture texture;
    std::string sum;
  };
  std::map<std::string, File> files;  // by stem: layers that share one share it here
  std::vector<TextureLayer> layers;
  std::vector<schema::SessionTexture> rows;  // of the layers
  std::vector<std::string> stems;

  const schema::Texture& texture(std::size_t layer) const { return files.at(stems[layer]).texture; }

  Result<const File*> read(const std::string& file, const std::string& stem) {
    if (const auto known = files.find(stem); known != files.end()) return &known->second;
    auto texture = schema::read_texture(file);
    if (!texture) return schema::forward_error(texture);
    const auto wav = schema::texture_wav(file);
    if (!wav) return schema::forward_error(wav);
    return &files.emplace(stem, File{std::move(*texture), wav->sha256}).first->second;
  }
  Result<void> add(const TextureLayer& layer, const std::string& file) {
    const std::string stem = schema::stem_of(file, ".texture") + ".texture";
    const auto known = read(file, stem);
    if (!known) return schema::forward_error(known);
    stems.push_back(stem);
    layers.push_back(layer);
    rows.push_back({full_path(stem + ".json"), (*known)->sum, layer.at_m, layer.gain_m_per_n, layer.ends});
    return {};
  }
  double end_m() const {
    double end = layers.front().at_m;
    for (std::size_t i = 0; i < layers.size(); ++i)
      end = std::max(end, layers[i].at_m + texture(i).signal.length_m());
    return end;
  }
  double start_m() const { return std::ranges::min(layers, {}, &TextureLayer::at_m).at_m; }
  /// The gain that all share: weights are the layers' parts of it, with their signs.
  double gain() const {
    double most = 0;
    for (const TextureLayer& layer : layers) most = std::max(most, std::abs(layer.gain_m_per_n));
    return most;
  }
};

// Before memory is taken for all that lies between the textures.
Result<void> check_reach(const Laid& laid, const std::string& scene_path) {
  double pitch_m = laid.texture(0).signal.pitch_m, start_m = laid.layers.front().at_m, end_m = start_m;
  for (std::size_t i = 0; i < laid.layers.size(); ++i) {
    pitch_m = std::min(pitch_m, laid.texture(i).signal.pitch_m);
    start_m = std::min(start_m, laid.layers[i].at_m);
    end_m = std::max(end_m, laid.layers[i].at_m + laid.texture(i).signal.length_m());
    const double reach_m = end_m - start_m;
    if (reach_m / pitch_m <= kMostPathSamples) continue;
    const std::string layer = fmt::format("{}#/layers/{}/at_m", scene_path, i);
    return fail(Fault::unsuitable,
                fmt::format("the textures reach over {:g} m, at a pitch of {:g} um: over {:.0f} samples",
                            reach_m, 1e6 * pitch_m, kMostPathSamples),
                scene_path.empty() ? laid.rows[i].file : layer, "lay them closer, or play a shorter part");
  }
  return {};
}

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
  if (const auto near = check_reach(laid, scene_path); !near) return schema::forward_error(near);
  if (laid.gain() == 0) return fail(Fault::unsuitable, "every gain is 0", scene_path, "give one a gain");
  return laid;
}

std::vector<PlacedTexture> placed(const Laid& laid) {
  std::vector<PlacedTexture> list;
  for (std::size_t i = 0; i < laid.layers.size(); ++i)
    list.push_back({&laid.texture(i), laid.layers[i].at_m, laid.layers[i].gain_m_per_n / laid.gain()});
  return list;
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
  session.choices = choices_in(options);
  session.delay_s = prepared.delay_left_s;
  session.loop_delay_s = options.loop_delay_s;
  session.low_hz = options.band.low_hz;
  session.high_hz = prepared.passes_to_hz;
}

// What the budget chooses goes into the options.
Result<std::optional<TickDecision>> decided(const std::vector<PlacedTexture>& textures,
                                            const schema::Transducer& transducer, const TickBudget& budget,
                                            PrepareOptions& options) {
  if (!budget.asked()) return std::nullopt;
  const auto table = schema::find_trade_table();
  if (!table) return schema::forward_error(table);
  auto decision = decide(textures, transducer, options, budget, *table);
  if (!decision) return schema::forward_error(decision);
  options = decision->chosen.in(options);
  return std::move(*decision);
}

void name_files(Program& program, const Laid& laid) {
  program.session.textures = laid.rows;
  if (program.scene_path.empty()) return;
  program.session.scene_file = full_path(program.scene_path);
  program.session.scene_sha256 = schema::sha256_of_file(program.scene_path).value_or("");
}

// What the device would refuse by numbers of its own.
Result<void> check_onset(const PrepareOptions& options) {
  if (options.onset_s <= kLongestOnsetS) return {};
  return fail(
      Fault::usage, fmt::format("an onset of {:g} s", options.onset_s), {},
      fmt::format("0 s to {:g} s (--onset, or onset_s in the daemon's configuration)", kLongestOnsetS));
}

Result<void> check_place(const Laid& laid, const Prepared& prepared) {
  const double farthest_m = kFarthestSamples * prepared.pitch_m;
  const double at_m = std::max(std::abs(laid.start_m()), std::abs(laid.end_m()));
  if (at_m < farthest_m) return {};
  return fail(Fault::usage, fmt::format("lies as far as {:g} m from the encoder's zero", at_m),
              laid.rows.front().file,
              fmt::format("lay it within {:.4g} m (--at, or at_m in the scene)", farthest_m));
}

// Of a texture by itself the file is known; of several, the scene.
schema::Error naming_the_file(schema::Error error, const Laid& laid, const std::string& scene_path) {
  if (laid.rows.size() == 1 && error.where.starts_with("texture"))
    error.where = laid.rows.front().file + error.where.substr(std::string_view("texture").size());
  if (error.where == "texture") error.where = scene_path;
  return error;
}

// What was named stays, whatever else would be cheaper.
TickBudget budget_of(const ProgramRequest& request, const schema::PlaybackChoices& choices) {
  TickBudget budget = request.budget;
  budget.keep_inverse = budget.keep_inverse || choices.inverse.has_value();
  budget.keep_reading = budget.keep_reading || choices.interpolation.has_value();
  return budget;
}

// A request is held to what it means; a scene or configuration may say more, for those who name what it is
// of.
Result<PrepareOptions> options_of(const ProgramRequest& request, const schema::PlaybackChoices& choices,
                                  const PrepareOptions& options) {
  if (const auto meant = check_meant(request.choices, choices); !meant) return schema::forward_error(meant);
  return with_choices(options, choices);
}

Result<void> prepare_laid(Program& program, const Laid& laid, const TickBudget& budget) {
  PrepareOptions& options = program.options;
  const schema::Transducer& transducer = program.session.transducer;
  options.gain_m_per_n = laid.gain();
  options.ends = ends_of(laid.layers.front().ends);
  if (const auto soft = check_onset(options); !soft) return soft;
  auto decision = decided(placed(laid), transducer, budget, options);
  if (!decision) return schema::forward_error(decision);
  program.decision = std::move(*decision);
  auto prepared = prepare(placed(laid), transducer, options);
  if (!prepared) return tl::unexpected(naming_the_file(prepared.error(), laid, program.scene_path));
  if (const auto near = check_place(laid, *prepared); !near) return near;
  program.prepared = std::move(*prepared);
  program.prepared.built.texture_files = laid.files.size();
  program.tray_peak_m = tray_peak_m(program.prepared, transducer, options);
  program.gain_m_per_n = laid.gain();
  program.length_m = laid.end_m() - laid.start_m();
  return {};
}

}  // namespace

Result<Program> make_program(const ProgramRequest& request, const std::string& transducer_name,
                             PrepareOptions options) {
  Program program;
  const auto scene = scene_of(request, program.kept_gain);
  if (!scene) return schema::forward_error(scene);
  const schema::PlaybackChoices choices = request.choices.over(scene->playback.over(request.defaults));
  const auto chosen = options_of(request, choices, options);
  if (!chosen) return schema::forward_error(chosen);
  if (names_a_scene(request.file)) program.scene_path = schema::scene_path(request.file);
  auto laid = laid_out(*scene, program.scene_path);
  if (!laid) return schema::forward_error(laid);
  const auto transducer = schema::read_transducer(transducer_name);
  if (!transducer) return schema::forward_error(transducer);
  if (const auto usable = schema::check_usable(*transducer, request.force); !usable)
    return schema::forward_error(usable);
  program.session.transducer = *transducer;
  program.session.transducer_sha256 = transducer_sum(transducer_name);
  program.options = *chosen;
  const auto made = prepare_laid(program, *laid, budget_of(request, choices));
  if (!made) return schema::forward_error(made);
  if (request.any_displacement) program.tray_peak_m = 0;
  name_files(program, *laid);
  describe(program.session, program.prepared, program.options);
  if (const auto fits = schema::session_program_text(program.session); !fits)
    return schema::forward_error(fits);
  return program;
}

}  // namespace tacto::playback
