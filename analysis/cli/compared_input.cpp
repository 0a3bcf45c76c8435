// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/compared_input.hpp"

#include <fmt/format.h>

#include "data-schema/files/files.hpp"
#include "data-schema/kinds/file_kind.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::Result;

Result<ComparedInput> session_input(const std::string& name, std::size_t stroke,
                                    const std::function<void(double)>& progress) {
  auto played = played_texture(name, stroke, progress);
  TACTO_TRY(played);
  ComparedInput input{
      fmt::format("{}, stroke {}{}", name, played->stroke, stroke == 0 ? ", its longest" : ""),
      "",
      played->texture,
      {}};
  input.played = std::move(*played);
  return input;
}

Result<spatial::NamedTexture> chosen_texture(spatial::TextureInputs& inputs, const std::string& name,
                                             std::size_t stroke) {
  const std::size_t there = inputs.expected();
  if (stroke == 0 && there > 1)
    return schema::fail(ErrorKind::usage, fmt::format("names {} textures", there), name,
                        "name one of them, or choose with --stroke (compare: --stroke-a, --stroke-b)");
  if (stroke > there)
    return schema::fail(ErrorKind::usage,
                        fmt::format("names {} textures, and there is no stroke {}", there, stroke), name);
  for (std::size_t i = 1;; ++i) {
    auto next = inputs.next();
    TACTO_TRY(next);
    if (!*next) return schema::fail(ErrorKind::unsuitable, "has no such texture", name);
    if (i >= stroke) return std::move(**next);
  }
}

}  // namespace

bool names_a_session(const std::string& name) {
  if (name.ends_with(".session")) return true;
  const auto files = schema::stored_files(name);
  return files && files->front().kind == schema::FileKind::session;
}

ComparedInput compared_input(spatial::NamedTexture texture) {
  return {texture.name, texture.stored ? texture.path : "", std::move(texture.texture), {}};
}

Result<ComparedInput> compared_input(const std::string& name, std::size_t stroke,
                                     const std::function<void(double)>& progress) {
  if (names_a_session(name)) return session_input(name, stroke, progress);
  auto inputs = spatial::TextureInputs::find({name}, {});
  TACTO_TRY(inputs);
  auto texture = chosen_texture(*inputs, name, stroke);
  TACTO_TRY(texture);
  return compared_input(std::move(*texture));
}

Result<void> match_session(ComparedInput& a, ComparedInput& b) {
  if (a.played.has_value() == b.played.has_value()) return {};
  ComparedInput& texture = a.played ? b : a;
  const ComparedInput& session = a.played ? a : b;
  if (texture.file.empty())
    return schema::fail(ErrorKind::unsuitable,
                        "is not a stored texture: a session is compared with the texture that it played",
                        texture.name);
  const std::string stem = schema::stem_of(texture.file, ".texture");
  auto target = target_of(texture.texture, stem, *session.played);
  TACTO_TRY(target);
  texture.texture = std::move(*target);
  texture.name += " as the target";
  return {};
}

}  // namespace tacto::analysis
