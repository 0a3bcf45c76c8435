// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of programs beside their results.
#pragma once

#include <cstdio>
#include <string_view>

namespace tacto::cli {

/// Writes to stderr unchanged. If that fails (closed, a full disk, a pipe without a reader), the work
/// continues without an error: unlike fmt::print this does not throw.
inline void talk(std::string_view text) noexcept {
  [[maybe_unused]] const std::size_t written = std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace tacto::cli
