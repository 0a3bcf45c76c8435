// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/job/too_short.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tacto::spatial {
namespace {

std::string number_of(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

std::string words_of(const TooShort& one) {
  std::vector<std::string> parts;
  if (!one.strokes.empty())
    parts.push_back(
        fmt::format("stroke{} {}", one.strokes.size() == 1 ? "" : "s", fmt::join(one.strokes, ", ")));
  if (one.motions > 0) parts.push_back(number_of(one.motions, "motion"));
  return fmt::format("{}: {}", one.recording, fmt::join(parts, " and "));
}

std::optional<std::string> too_short_sentence(std::span<const TooShort> all) {
  std::size_t strokes = 0, motions = 0;
  std::vector<std::string> which, empty, reasons, remedies;
  for (const TooShort& one : all) {
    if (!one.any()) continue;
    strokes += one.strokes.size(), motions += one.motions;
    which.push_back(words_of(one));
    if (one.nothing_left) empty.push_back(one.recording);
  }
  if (which.empty()) return std::nullopt;
  if (strokes > 0) {
    reasons.push_back(number_of(strokes, "stroke") + " shorter than a period of the band's lowest frequency");
    remedies.emplace_back("use a higher --low, or --band off");
  }
  if (motions > 0) {
    reasons.push_back(number_of(motions, "motion") +
                      " shorter than a stroke (5 mm, and 5 % of the recording's longest motion)");
    remedies.emplace_back("select a motion with --from and --to");
  }
  const std::string none = empty.empty() ? "" : fmt::format("; no texture of {}", fmt::join(empty, ", "));
  return fmt::format("skipped because too short for a texture: {} ({}){}; {}", fmt::join(reasons, ", "),
                     fmt::join(which, "; "), none, fmt::join(remedies, "; "));
}

}  // namespace tacto::spatial
