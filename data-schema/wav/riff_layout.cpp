// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/wav/riff_layout.hpp"

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

void take_chunk(RiffLayout& layout, const Chunk& chunk, std::uint64_t at,
                const std::array<char, 16>& content) {
  if (chunk.id() == "fmt ") {
    layout.format_at = at;
    layout.block_bytes = little_endian(content.data() + 12, 2);
  }
  if (chunk.id() == "ds64") {
    layout.ds64_at = at;
    layout.data_bytes_64 = little_endian(content.data() + 8, 8);
  }
}

// Reads the chunks as far as "data".
bool find_data(std::istream& file, RiffLayout& layout) {
  for (Chunk chunk; chunk.read_from(file);) {
    const auto at = static_cast<std::uint64_t>(file.tellg());
    std::array<char, 16> content{};
    if (chunk.id() == "data") {
      layout.data_bytes = chunk.size();
      layout.data_at = at;
      return true;
    }
    if (chunk.size() >= content.size() && !file.read(content.data(), content.size())) return false;
    take_chunk(layout, chunk, at, content);
    file.seekg(static_cast<std::streamoff>(at + chunk.size() + chunk.size() % 2));
  }
  return false;
}

}  // namespace

std::optional<RiffLayout> riff_layout(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 12> head{};
  if (!file.read(head.data(), head.size())) return std::nullopt;
  const std::string_view text(head.data(), head.size());
  RiffLayout layout;
  layout.wide = text.starts_with("RF64");
  if ((!layout.wide && !text.starts_with("RIFF")) || text.substr(8) != "WAVE") return std::nullopt;
  if (!find_data(file, layout)) return std::nullopt;
  file.clear();
  file.seekg(0, std::ios::end);
  layout.present_bytes = static_cast<std::uint64_t>(file.tellg()) - layout.data_at;
  return layout;
}

}  // namespace tacto::schema
