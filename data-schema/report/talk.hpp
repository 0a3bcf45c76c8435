// SPDX-License-Identifier: GPL-3.0-or-later
// What programs say beside their results.
#pragma once

#include <cstdio>
#include <string_view>

namespace tacto::cli {

/// Writes to stderr as it is. Where that fails (closed, a full disk, a pipe without a reader) nobody can be
/// told, and the work goes on: unlike fmt::print this throws nothing.
inline void talk(std::string_view text) noexcept {
  [[maybe_unused]] const std::size_t written = std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace tacto::cli
