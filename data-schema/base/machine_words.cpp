// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/machine_words.hpp"

#include <fmt/format.h>

#include <fstream>

namespace tacto::schema {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name"))
      if (const auto colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
  return "an unnamed processor";
}

std::string compiler() {
#ifdef __clang__
  return fmt::format("clang {}.{}", __clang_major__, __clang_minor__);
#else
  return fmt::format("gcc {}.{}", __GNUC__, __GNUC_MINOR__);
#endif
}

}  // namespace

std::string machine_words() {
#ifdef NDEBUG
  constexpr const char* kBuild = "release";
#else
  constexpr const char* kBuild = "with assertions";
#endif
  return fmt::format("{}, {}, {}", processor(), compiler(), kBuild);
}

}  // namespace tacto::schema
