// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/cli/texture_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <set>

#include "data-schema/base/unknown_note.hpp"
#include "data-schema/command/verb.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording.hpp"
#include "spatial/texture/texture_warnings.hpp"

namespace tacto::spatial {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using schema::FileKind;
using schema::Result;
using schema::StoredFile;

std::string name_of(const std::string& path, std::string_view suffix) {
  return fs::path(schema::stem_of(path, suffix)).filename().string();
}

void warn_of(const std::string& note) {
  if (!note.empty()) cli::warn(note);
}

// The number N in "STEM-N.texture.json", two digits or more.
std::optional<int> number_of(const std::string& file, const std::string& stem) {
  constexpr std::string_view kEnding = ".texture.json";
  if (!file.starts_with(stem + "-") || !file.ends_with(kEnding)) return std::nullopt;
  const char* begin = file.data() + stem.size() + 1;
  const char* end = file.data() + file.size() - kEnding.size();
  int number = 0;
  const auto [stop, fault] = std::from_chars(begin, end, number);
  if (fault != std::errc() || stop != end || end - begin < 2) return std::nullopt;
  return number;
}

// The textures that 'tactograph spatial' made of a recording of several strokes, by their numbers.
std::vector<StoredFile> numbered_textures(const std::string& name) {
  const fs::path stem(name);
  std::map<int, std::string> found;
  std::error_code ignored;
  for (const auto& entry :
       fs::directory_iterator(stem.has_parent_path() ? stem.parent_path() : ".", ignored)) {
    const std::string file = entry.path().filename().string();
    if (const auto number = number_of(file, stem.filename().string()))
      found[*number] = (stem.parent_path() / file).string();
  }
  std::vector<StoredFile> files;
  for (auto& [number, path] : found) files.push_back({FileKind::texture, std::move(path)});
  return files;
}

// By name.
std::vector<StoredFile> textures_in(const std::string& folder) {
  std::set<std::string> paths;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().string().ends_with(".texture.json")) paths.insert(entry.path().string());
  std::vector<StoredFile> files;
  for (const std::string& path : paths) files.push_back({FileKind::texture, path});
  return files;
}

std::vector<StoredFile> of_kind(const std::vector<StoredFile>& files, FileKind kind) {
  std::vector<StoredFile> some;
  std::ranges::copy_if(files, std::back_inserter(some),
                       [kind](const auto& file) { return file.kind == kind; });
  return some;
}

Result<NamedTexture> read_texture(const std::string& path) {
  auto texture = schema::read_texture(path);
  TACTO_TRY(texture);
  warn_of(schema::unknown_note(path, *texture));
  return NamedTexture{path, name_of(path, ".texture"), std::move(*texture), true};
}

}  // namespace

Result<TextureInputs> TextureInputs::find(const std::vector<std::string>& names,
                                          const TextureOptions& options) {
  TextureInputs inputs(options);
  for (const std::string& name : names) TACTO_TRY(inputs.add(name, names.size() == 1));
  if (inputs.inputs_.empty())
    return schema::fail(ErrorKind::unsuitable, "none of the given files is a texture");
  // opened now, because the number of its textures has to be known
  TACTO_TRY(inputs.open_if_recording());
  return inputs;
}

Result<void> TextureInputs::add(const std::string& name, bool alone) {
  const auto files = schema::stored_files(name);
  if (files)
    if (const auto textures = of_kind(*files, FileKind::texture); !textures.empty()) {
      for (const StoredFile& file : textures) add(file);
      return {};
    }
  std::error_code ignored;
  if (!fs::is_regular_file(name, ignored))
    if (const auto numbered = numbered_textures(name); !numbered.empty()) {
      for (const StoredFile& file : numbered) add(file);
      return {};
    }
  if (!files && fs::is_directory(name, ignored)) {
    const auto inside = textures_in(name);
    for (const StoredFile& file : inside) add(file);
    if (inside.empty())
      return schema::fail(ErrorKind::unsuitable, "contains no texture", name,
                          "'tactograph spatial' makes textures from recordings");
    return {};
  }
  TACTO_TRY(files);
  if (const auto recordings = of_kind(*files, FileKind::recording); !recordings.empty()) {
    add(recordings.front());
    return {};
  }
  const std::string what = fmt::format("is a {}, not a texture", schema::kind_name(files->front().kind));
  if (alone)
    return schema::fail(ErrorKind::unsuitable, what, name,
                        "'tactograph spatial' makes textures from recordings");
  cli::warn(fmt::format("{}: {}; skipped", name, what));
  return {};
}

void TextureInputs::add(const StoredFile& file) {
  if (named_.insert(schema::canonical_path(file.path)).second) inputs_.push_back(file);
}

// If the next input is a recording, moves it from the inputs to its strokes.
Result<void> TextureInputs::open_if_recording() {
  if (!strokes_.empty() || inputs_.empty() || inputs_.front().kind != FileKind::recording) return {};
  const std::string path = inputs_.front().path;
  inputs_.pop_front();
  const auto recording = schema::open_recording(path);
  TACTO_TRY(recording);
  warn_of(schema::unknown_note(path, recording->header));
  auto maker = TextureMaker::open(*recording, options_);
  TACTO_TRY(maker);
  maker_.reset();
  maker_.emplace(std::move(*maker));
  made_ = false;
  if (const std::string note = channel_note(options_, maker_->record()); !note.empty()) cli::warn(note);
  const auto& strokes = maker_->record().strokes();
  if (strokes.empty())
    return schema::fail(ErrorKind::unsuitable, "no stroke was found", path,
                        "make a texture of a selected time range with 'tactograph spatial --from --to'");
  const std::string name = name_of(path, "");
  int number = 0;
  for (const Stroke& stroke : strokes) {
    ++number;
    if (stroke.finger_up) continue;
    strokes_.push_back({stroke, number, strokes.size() == 1 ? name : fmt::format("{}-{:02}", name, number)});
  }
  const std::size_t up = strokes.size() - strokes_.size();
  if (strokes_.empty())
    return schema::fail(ErrorKind::unsuitable, "the finger does not touch the surface in any stroke", path,
                        "'tactograph spatial --finger-up' makes textures of them nevertheless");
  if (up > 0)
    cli::warn(fmt::format("{}: in {} of {} strokes the finger does not touch the surface; they are excluded",
                          path, up, strokes.size()));
  return {};
}

Result<std::optional<NamedTexture>> TextureInputs::next_stroke() {
  while (!strokes_.empty()) {
    const NumberedStroke stroke = strokes_.front();
    strokes_.pop_front();
    auto texture = maker_->make(stroke.stroke, stroke.number);
    if (texture) {
      made_ = true;
      return NamedTexture{stroke.name, stroke.name, std::move(*texture)};
    }
    const bool is_last = strokes_.empty() && !made_;
    if (texture.error().kind != ErrorKind::unsuitable || is_last) return schema::forward_error(texture);
    cli::warn(fmt::format("{}: no texture was made: {}", stroke.name, schema::message(texture.error())));
  }
  return std::nullopt;
}

Result<std::optional<NamedTexture>> TextureInputs::next() {
  TACTO_TRY(open_if_recording());
  if (!strokes_.empty()) {
    auto texture = next_stroke();
    if (!texture || *texture) return texture;
    return next();  // none of the remaining strokes made a texture
  }
  if (inputs_.empty()) return std::nullopt;
  auto texture = read_texture(inputs_.front().path);
  TACTO_TRY(texture);
  inputs_.pop_front();
  return std::optional(std::move(*texture));
}

Result<std::vector<NamedTexture>> open_textures(const std::vector<std::string>& names) {
  auto inputs = TextureInputs::find(names, {});
  TACTO_TRY(inputs);
  std::vector<NamedTexture> all;
  for (;;) {
    auto next = inputs->next();
    TACTO_TRY(next);
    if (!*next) return all;
    const schema::Texture& first = all.empty() ? (*next)->texture : all.front().texture;
    if ((*next)->texture.quantity != first.quantity || (*next)->texture.unit != first.unit)
      return schema::fail(ErrorKind::unsuitable,
                          fmt::format("contains {}, but {} contains {}", (*next)->texture.quantity,
                                      all.front().path, first.quantity),
                          (*next)->path, "use textures of one quantity");
    all.push_back(std::move(**next));
  }
}

}  // namespace tacto::spatial
