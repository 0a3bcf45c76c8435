// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/placed_textures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "data-schema/base/unknown_note.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/texture/texture_wav.hpp"
#include "playback/player/served_folder.hpp"
#include "playback/render/loop_seam.hpp"

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;
using schema::Result;
using schema::TextureLayer;

namespace {

constexpr double kUsualGain = 1e-3;           // default; a fingertip has about 1e3 N/m
constexpr double kMostPathSamples = 1 << 24;  // 168 m at 10 um; the limit of all levels together

// The texture with its default gain: that in its file, or kUsualGain.
Result<schema::Scene> scene_of_texture(const ProgramRequest& request,
                                       std::optional<schema::PlaybackGain>& kept_gain) {
  auto kept = schema::read_playback_gain(request.file);
  TACTO_TRY(kept);
  const double usual = *kept ? (*kept)->gain_m_per_n : kUsualGain;
  if (!request.gain) kept_gain = std::move(*kept);
  schema::Scene alone;
  alone.layers = {TextureLayer{request.file, request.at_m.value_or(0), usual, "", "",
                               request.ends.value_or(schema::TextureEnds::stop), ""}};
  return alone;
}

Result<schema::Scene> scene_of(const ProgramRequest& request,
                               std::optional<schema::PlaybackGain>& kept_gain) {
  if (!names_a_scene(request.file)) return scene_of_texture(request, kept_gain);
  if (request.at_m || request.ends || (request.gain && !request.gain->times_default))
    return fail(ErrorKind::usage, "a scene defines the places, gains and ends of its textures", request.file,
                "change the scene, or name a texture; a gain may be a factor, as in 2x");
  return schema::read_scene(request.file);
}

// Applies the requested gain. Returns the largest gain before, with its sign.
double apply_gain(schema::Scene& scene, const std::optional<schema::Gain>& gain) {
  double usual = 0;
  for (schema::Layer& layer : scene.layers)
    layer.visit([&](TextureLayer& texture) {
      if (std::abs(texture.gain_m_per_n) > std::abs(usual)) usual = texture.gain_m_per_n;
      if (gain) texture.gain_m_per_n = gain->m_per_n(texture.gain_m_per_n);
    });
  return usual;
}

// A limit of a newer version must not be ignored.
Result<void> check_choices(const schema::Scene& scene) {
  const auto of_playback = [](const std::string& name) { return name.starts_with("playback/"); };
  const auto choice = std::ranges::find_if(scene.unknown_members, of_playback);
  if (choice == scene.unknown_members.end()) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("is of version {}, and its choice {} is unknown to this program",
                          scene.newer_version, *choice),
              "scene#/playback", "play it with a newer tactograph, or remove it");
}

}  // namespace

bool names_a_scene(const std::string& file) {
  if (file.ends_with(".scene.json") || file.ends_with(".scene")) return true;
  return !schema::is_file(file) && schema::is_file(file + ".scene.json");
}

std::string full_path(const std::string& path) {
  std::error_code ignored;
  const auto full = std::filesystem::absolute(path, ignored);
  return ignored ? path : full.lexically_normal().string();
}

std::vector<PlacedTexture> PlacedTextures::placed() const {
  std::vector<PlacedTexture> list;
  for (std::size_t i = 0; i < layers_.size(); ++i)
    list.push_back({&texture(i), layers_[i].at_m, layers_[i].gain_m_per_n / gain()});
  return list;
}

double PlacedTextures::gain() const {
  double most = 0;
  for (const TextureLayer& layer : layers_) most = std::max(most, std::abs(layer.gain_m_per_n));
  return most;
}

double PlacedTextures::signed_gain() const {
  const auto size = [](const TextureLayer& layer) { return std::abs(layer.gain_m_per_n); };
  return std::ranges::max(layers_, {}, size).gain_m_per_n;
}

Ends PlacedTextures::ends() const {
  return ends_of(layers_.front().ends);
}

double PlacedTextures::start_m() const {
  return std::ranges::min(layers_, {}, &TextureLayer::at_m).at_m;
}

double PlacedTextures::end_m() const {
  double end = layers_.front().at_m;
  for (std::size_t i = 0; i < layers_.size(); ++i)
    end = std::max(end, layers_[i].at_m + texture(i).signal.length_m());
  return end;
}

/// Reads the textures into a PlacedTextures.
class TextureReader {
 public:
  explicit TextureReader(PlacedTextures& laid) : laid_(laid) {}

  Result<void> read(const schema::Scene& scene) {
    TACTO_TRY(schema::check_only_tray(scene, laid_.scene_path_));
    TACTO_TRY(check_choices(scene));
    laid_.choices_ = scene.playback;
    note(schema::unknown_note(laid_.scene_path_, scene));
    for (const schema::Layer& layer : scene.layers) {
      const auto added = layer.visit([&](const TextureLayer& texture) { return add(texture); });
      if (!added) return added;
    }
    if (const auto near = check_reach(); !near) return near;
    if (laid_.gain() == 0)
      return laid_.scene_path_.empty()
                 ? fail(ErrorKind::unsuitable, "the gain is 0: the drive would be 0",
                        laid_.rows().front().file, "give --gain a value above or below 0, for example 1x")
                 : fail(ErrorKind::unsuitable, "every gain is 0: the drive would be 0", laid_.scene_path_,
                        "set a gain of at least one layer");
    return {};
  }
  void keep_gain(std::optional<schema::PlaybackGain> gain, double usual) {
    laid_.kept_gain_ = std::move(gain);
    laid_.default_gain_ = usual;
  }
  void name_scene(const std::string& path) { laid_.scene_path_ = path; }

 private:
  Result<void> add(const TextureLayer& layer) {
    const std::string& scene_path = laid_.scene_path_;
    const std::string file =
        scene_path.empty() ? layer.texture : schema::texture_in_scene(scene_path, layer.texture);
    const std::string stem = schema::stem_of(file, ".texture") + ".texture";
    if (!laid_.files_.contains(stem)) {
      auto texture = schema::read_texture(file);
      TACTO_TRY(texture);
      const auto wav = schema::texture_wav(file);
      TACTO_TRY(wav);
      note(schema::unknown_note(stem + ".json", *texture));
      laid_.files_.emplace(stem, PlacedTextures::File{std::move(*texture), wav->sha256});
    }
    laid_.stems_.push_back(stem);
    laid_.layers_.push_back(layer);
    laid_.rows_.push_back(
        {full_path(stem + ".json"), laid_.files_.at(stem).sum, layer.at_m, layer.gain_m_per_n, layer.ends});
    return {};
  }
  void note(std::string words) {
    if (!words.empty()) laid_.notes_.push_back(std::move(words));
  }
  // Called before memory is allocated for the space between the textures.
  Result<void> check_reach() const {
    double pitch_m = laid_.texture(0).signal.pitch_m, start_m = laid_.layers_.front().at_m, end_m = start_m;
    for (std::size_t i = 0; i < laid_.layers_.size(); ++i) {
      pitch_m = std::min(pitch_m, laid_.texture(i).signal.pitch_m);
      start_m = std::min(start_m, laid_.layers_[i].at_m);
      end_m = std::max(end_m, laid_.layers_[i].at_m + laid_.texture(i).signal.length_m());
      const double reach_m = end_m - start_m;
      if (reach_m / pitch_m <= kMostPathSamples) continue;
      const std::string layer = fmt::format("{}#/layers/{}/at_m", laid_.scene_path_, i);
      return fail(ErrorKind::unsuitable,
                  fmt::format("the textures span {:g} m at a pitch of {:g} um: more than {:.0f} samples",
                              reach_m, 1e6 * pitch_m, kMostPathSamples),
                  laid_.scene_path_.empty() ? laid_.rows_[i].file : layer,
                  "place them closer together, or play a shorter part");
    }
    return {};
  }

  PlacedTextures& laid_;
};

Result<PlacedTextures> place_textures(const ProgramRequest& asked) {
  ProgramRequest request = asked;
  if (asked.only_in) {
    auto served = served_file(*asked.only_in, asked.file);
    TACTO_TRY(served);
    request.file = std::move(*served);
  }
  std::optional<schema::PlaybackGain> kept_gain;
  auto scene = scene_of(request, kept_gain);
  TACTO_TRY(scene);
  const double usual = apply_gain(*scene, request.gain);
  PlacedTextures laid;
  TextureReader reader(laid);
  reader.keep_gain(std::move(kept_gain), usual);
  if (names_a_scene(request.file)) reader.name_scene(schema::scene_path(request.file));
  TACTO_TRY(reader.read(*scene));
  return laid;
}

}  // namespace tacto::playback
