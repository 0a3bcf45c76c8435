// SPDX-License-Identifier: GPL-3.0-or-later
// The textures that the user named: read from their files, or made from a recording's strokes, one at a time.
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

/// What the names on a command line may stand for, as its help says it.
inline constexpr const char* kTextureInputs =
    "Textures, or recordings of which each stroke becomes one, by stem or file. NAME means NAME-01, "
    "NAME-02 ... where there is no texture NAME";

/// `path` for messages, `name` for titles and reports. `stored`: path is that of its sidecar, not a stroke's
/// name.
struct NamedTexture {
  std::string path, name;
  schema::Texture texture;
  bool stored = false;
};

/// Holds one recording at a time.
class TextureInputs {
 public:
  /// A name stands for a texture; else for NAME-01, NAME-02 ...; else for a recording, whose strokes become
  /// textures as by 'tactograph spatial' (`options`). Among several names, other kinds are passed over with a
  /// warning. Errors: not_found, unsuitable, malformed; of opening a recording that is named first.
  static schema::Result<TextureInputs> find(const std::vector<std::string>& names,
                                            const TextureOptions& options);

  /// Whether more than one texture may come, and about how many.
  bool several() const { return expected() > 1; }
  std::size_t expected() const { return inputs_.size() + strokes_.size(); }

  /// The next texture, or nothing at the end. A stroke among several that makes no texture is passed over
  /// with a warning. Errors: of reading and making.
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
  std::deque<schema::StoredFile> inputs_;  // still to come
  std::set<std::string> named_;            // so far, by canonical paths: a file by two spellings comes once
  std::optional<TextureMaker> maker_;      // of the recording whose turn it is
  std::deque<NumberedStroke> strokes_;     // of that recording, still to come
  bool made_ = false;                      // a texture, of that recording
};

/// All of them at once, of one quantity and unit. Errors: of find() and next(); unsuitable, where they
/// differ.
schema::Result<std::vector<NamedTexture>> open_textures(const std::vector<std::string>& names);

/// What a library said of a texture, with its file.
template <class T>
tl::unexpected<schema::Error> said_of(const NamedTexture& input, const schema::Result<T>& failed) {
  schema::Error error = failed.error();
  if (error.kind == schema::ErrorKind::unsuitable)
    error.where = error.where.empty() ? input.path : input.path + ": " + error.where;
  return tl::unexpected(error);
}

}  // namespace tacto::spatial
