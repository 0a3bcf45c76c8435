// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as an X3P file: lines and whole surfaces. First byte 0: the others are the archive. Else they are
// main.xml, a zero, the size of the mask (a byte), the mask, and the points, which are put into an archive
// here: libzip would find nearly every changed byte of one by its checksums.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "data-schema/exchange/x3p_file.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace tacto;

namespace {

void put(std::string& bytes, std::uint64_t number, int count) {
  for (int i = 0; i < count; ++i, number >>= 8U) bytes += static_cast<char>(number);
}

std::uint32_t crc32_of(std::string_view content) {
  std::uint32_t sum = ~0U;
  for (const char each : content) {
    sum ^= static_cast<unsigned char>(each);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1U) ^ ((sum & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~sum;
}

// What a file's own header and that of the list at the end have in common (APPNOTE 4.3.7): not compressed.
std::string zip_member(std::string_view name, std::string_view content) {
  std::string bytes;
  put(bytes, 20, 2), put(bytes, 0, 8), put(bytes, crc32_of(content), 4);
  put(bytes, content.size(), 4), put(bytes, content.size(), 4), put(bytes, name.size(), 2), put(bytes, 0, 2);
  return bytes;
}

std::string zip_of(std::span<const std::pair<std::string_view, std::string_view>> files) {
  std::string archive, list;
  for (const auto& [name, content] : files) {
    const std::string member = zip_member(name, content);
    put(list, 0x02014b50, 4), put(list, 20, 2);
    list += member;
    put(list, 0, 10), put(list, archive.size(), 4);
    list += name;
    put(archive, 0x04034b50, 4);
    archive.append(member).append(name).append(content);
  }
  const std::size_t at = archive.size();
  archive += list;
  put(archive, 0x06054b50, 4), put(archive, 0, 4), put(archive, files.size(), 2),
      put(archive, files.size(), 2);
  put(archive, list.size(), 4), put(archive, at, 4), put(archive, 0, 2);
  return archive;
}

std::string archive_of(std::string_view parts) {
  const std::string_view xml = parts.substr(0, parts.find('\0'));
  parts.remove_prefix(std::min(xml.size() + 1, parts.size()));
  const std::size_t most = parts.empty() ? 0 : static_cast<unsigned char>(parts[0]);
  parts.remove_prefix(parts.empty() ? 0 : 1);
  const std::string_view mask = parts.substr(0, most);
  return zip_of(std::array<std::pair<std::string_view, std::string_view>, 3>{
      {{"main.xml", xml}, {"bindata/valid.bin", mask}, {"bindata/data.bin", parts.substr(mask.size())}}});
}

void read_as(const std::string& path, const schema::X3pChoice& choice) {
  const auto read = schema::read_x3p(path, choice);
  tests::demand(read || read.error().kind != schema::ErrorKind::internal);  // the module with libzip is there
  if (!read) return;
  tests::demand(read->pitch_m > 0 && std::isfinite(read->pitch_m) && std::isfinite(read->origin_m));
  tests::demand(!read->height_m.empty() && read->height_m.size() % read->rows == 0);
  tests::demand(choice.most_points ? read->height_m.size() <= *choice.most_points : read->rows == 1);
  for (const double height_m : read->height_m) tests::demand(!std::isinf(height_m));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string archive = data[0] == 0 ? std::string(bytes) : archive_of(bytes);
  const auto* const content = reinterpret_cast<const std::uint8_t*>(archive.data());
  const std::string path = tests::fuzzed_file("s.x3p", content, archive.size());
  read_as(path, {1, {}, {}});
  read_as(path, {{}, 2, {}});
  read_as(path, {{}, {}, 10'000});
  return 0;
}
