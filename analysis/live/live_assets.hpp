// SPDX-License-Identifier: GPL-3.0-or-later
// The files of the page, which are in the binary.
#pragma once

#include <span>
#include <string_view>

namespace tacto::analysis {

struct LiveAsset {
  std::string_view name;  ///< "page.js"
  std::string_view bytes;
};

/// Empty if the program was built without the page: without libwebsockets, clang-16 or lld-16.
std::span<const LiveAsset> live_assets();

}  // namespace tacto::analysis
