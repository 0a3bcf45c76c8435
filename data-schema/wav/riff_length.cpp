// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/wav/riff_length.hpp"

#include <algorithm>

#include "data-schema/wav/riff_layout.hpp"

namespace tacto::schema {
namespace {

// 0xFFFFFFFF is ffmpeg's value for an unknown size, 0x7FFF.... is sox's.
bool open_ended(std::uint64_t size) {
  return size == 0xFFFFFFFF || size >> 16 == 0x7FFF;
}

}  // namespace

std::optional<RiffLength> riff_length(const std::string& path) {
  const auto layout = riff_layout(path);
  if (!layout || layout->block_bytes == 0) return std::nullopt;
  const bool large = layout->data_bytes == 0xFFFFFFFF && layout->data_bytes_64 > 0;
  if (!large && open_ended(layout->data_bytes)) return std::nullopt;
  const std::uint64_t promised = large ? layout->data_bytes_64 : layout->data_bytes;
  return RiffLength{promised / layout->block_bytes,
                    std::min(layout->present_bytes, promised) / layout->block_bytes};
}

}  // namespace tacto::schema
