// SPDX-License-Identifier: GPL-3.0-or-later
// The textures that the user named: read from files, or made of a recording's strokes, one at a time.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/texture/make_texture.hpp"

namespace tacto::spatial {

/// What a name on the command line may refer to, for the help.
inline constexpr const char* kTextureInputs =
    "Textures, recordings (each stroke becomes a texture) or folders of textures, by stem or file. If there "
    "is no texture NAME, "
    "NAME means NAME-01, NAME-02 ...";

/// `path` is for messages, `name` for titles and reports. `stored`: the path is that of the sidecar, not a
/// stroke's name.
struct NamedTexture {
  std::string path, name;
  schema::Texture texture;
  bool stored = false;
};

/// Holds one recording at a time.
class TextureInputs {
 public:
  /// A name refers to a texture, else to NAME-01, NAME-02 ..., else to a recording whose strokes become
  /// textures as in 'tactograph spatial' (`options`). Among several names, files of other kinds are skipped
  /// with a warning. Errors: not_found, unsuitable, malformed; of opening a recording that is named first.
  static schema::Result<TextureInputs> find(const std::vector<std::string>& names,
                                            const TextureOptions& options);

  /// Whether more than one texture is expected, and about how many.
  bool several() const { return expected() > 1; }
  std::size_t expected() const { return inputs_.size() + strokes_.size(); }

  /// The next texture, or nothing at the end. If one of several strokes makes no texture, it is skipped with
  /// a warning. Errors: of reading and making.
  schema::Result<std::optional<NamedTexture>> next();

 private:
  explicit TextureInputs(const TextureOptions& options) : options_(options) {}
  schema::Result<void> add(const std::string& name, bool alone);
  void add(const schema::StoredFile& file);
  schema::Result<void> open_if_recording();
  schema::Result<std::optional<NamedTexture>> next_stroke();

  struct NumberedStroke {
    Stroke stroke;
    int number = 0;
    std::string name;
  };

  TextureOptions options_;
  std::deque<schema::StoredFile> inputs_;  // not yet read
  std::set<std::string> named_;  // canonical paths so far, so that a file with two spellings is used once
  std::optional<TextureMaker> maker_;   // of the current recording
  std::deque<NumberedStroke> strokes_;  // of that recording, not yet made
  bool made_ = false;                   // whether that recording has made a texture
};

/// All of them at once; they must have one quantity and unit. Errors: of find() and next(); unsuitable, if
/// they differ.
schema::Result<std::vector<NamedTexture>> open_textures(const std::vector<std::string>& names);

/// The error of a library about a texture, with the texture's file.
template <class T>
tl::unexpected<schema::Error> with_file(const NamedTexture& input, const schema::Result<T>& failed) {
  schema::Error error = failed.error();
  if (error.kind == schema::ErrorKind::unsuitable)
    error.where = error.where.empty() ? input.path : input.path + ": " + error.where;
  return tl::unexpected(error);
}

}  // namespace tacto::spatial
