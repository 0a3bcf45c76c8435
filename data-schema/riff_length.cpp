// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/riff_length.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

namespace tacto::schema {
namespace {

std::uint64_t little_endian(const char* bytes, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

struct Chunk {
  std::array<char, 8> head{};
  std::string_view id() const { return {head.data(), 4}; }
  std::uint64_t size() const { return little_endian(head.data() + 4, 4); }
  bool read_from(std::istream& file) { return static_cast<bool>(file.read(head.data(), head.size())); }
};

// 0xFFFFFFFF is ffmpeg's "not known", 0x7FFF.... is sox's.
bool open_ended(std::uint64_t size) {
  return size == 0xFFFFFFFF || size >> 16 == 0x7FFF;
}

struct Layout {
  std::uint64_t block_bytes = 0;    // of one frame, from "fmt "
  std::uint64_t data_bytes_64 = 0;  // from "ds64"
  std::uint64_t data_bytes = 0;     // as the header says
  std::uint64_t data_at = 0;
};

// Walks the chunks as far as "data".
std::optional<Layout> layout_of(std::istream& file) {
  Layout layout;
  for (Chunk chunk; chunk.read_from(file);) {
    const auto at = static_cast<std::uint64_t>(file.tellg());
    std::array<char, 16> content{};
    if (chunk.id() == "data") {
      layout.data_bytes = chunk.size();
      layout.data_at = at;
      return layout;
    }
    if (chunk.size() >= content.size() && !file.read(content.data(), content.size())) return std::nullopt;
    if (chunk.id() == "fmt ") layout.block_bytes = little_endian(content.data() + 12, 2);
    if (chunk.id() == "ds64") layout.data_bytes_64 = little_endian(content.data() + 8, 8);
    file.seekg(static_cast<std::streamoff>(at + chunk.size() + chunk.size() % 2));
  }
  return std::nullopt;
}

bool is_wave(std::istream& file) {
  std::array<char, 12> head{};
  if (!file.read(head.data(), head.size())) return false;
  const std::string_view text(head.data(), head.size());
  return (text.starts_with("RIFF") || text.starts_with("RF64")) && text.substr(8) == "WAVE";
}

}  // namespace

std::optional<RiffLength> riff_length(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!is_wave(file)) return std::nullopt;
  const auto layout = layout_of(file);
  if (!layout || layout->block_bytes == 0) return std::nullopt;
  const bool large = layout->data_bytes == 0xFFFFFFFF && layout->data_bytes_64 > 0;
  if (!large && open_ended(layout->data_bytes)) return std::nullopt;
  const std::uint64_t promised = large ? layout->data_bytes_64 : layout->data_bytes;
  file.clear();
  file.seekg(0, std::ios::end);
  const auto present = static_cast<std::uint64_t>(file.tellg()) - layout->data_at;
  return RiffLength{promised / layout->block_bytes, std::min(present, promised) / layout->block_bytes};
}

}  // namespace tacto::schema
