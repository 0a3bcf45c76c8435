// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/control/control_token.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include "data-schema/files/files.hpp"

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr std::size_t kLeastToken = 16, kMostToken = 200;
constexpr mode_t kOfOthers = 077;

std::string how_to_make(const std::string& path) {
  return fmt::format("make one: (umask 077; od -An -tx1 -N16 /dev/urandom | tr -d ' \\n' >{})", path);
}

}  // namespace

Result<std::string> read_control_token(const std::string& path) {
  const auto text = schema::read_file(path);
  if (!text) return fail(text.error().kind, text.error().what, path, how_to_make(path));
  struct stat status {};
  if (stat(path.c_str(), &status) != 0 || (status.st_mode & kOfOthers) != 0)
    return fail(ErrorKind::unsuitable, "others than its owner may read the token", path, "chmod 600 " + path);
  std::string token = text->substr(0, text->find_first_of("\r\n"));
  const bool plain = token.find_first_of(" \t\"\\") == std::string::npos;
  if (plain && token.size() >= kLeastToken && token.size() <= kMostToken) return token;
  return fail(ErrorKind::unsuitable,
              fmt::format("a token has {} to {} characters and no blanks", kLeastToken, kMostToken), path,
              how_to_make(path));
}

bool is_token(std::string_view said, std::string_view token) {
  unsigned differs = said.size() == token.size() ? 0 : 1;
  for (std::size_t i = 0; i < said.size(); ++i)
    differs |= static_cast<unsigned char>(said[i]) ^ static_cast<unsigned char>(token[i % token.size()]);
  return differs == 0;
}

}  // namespace tacto::playback
