// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/wav/riff_repair.hpp"

#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "data-schema/wav/riff_layout.hpp"

namespace tacto::schema {
namespace {

constexpr std::uint64_t kUnknown = 0xFFFFFFFF;  // of a 32-bit size that is in "ds64"

tl::unexpected<Error> unwritable_header(const std::string& path) {
  return fail(ErrorKind::cannot_write, "its header cannot be written", path);
}

// Overwrites bytes of an existing file.
class BytePatch {
 public:
  explicit BytePatch(const std::string& path)
      : path_(path), file_(path, std::ios::binary | std::ios::in | std::ios::out) {}

  void text(std::uint64_t at, std::string_view text) {
    file_.seekp(static_cast<std::streamoff>(at));
    file_.write(text.data(), static_cast<std::streamsize>(text.size()));
  }
  void number(std::uint64_t at, std::uint64_t value, int bytes) {
    std::string little;
    for (int i = 0; i < bytes; ++i) little += static_cast<char>(value >> (8 * i) & 0xFF);
    text(at, little);
  }
  Result<void> done() {
    file_.close();
    return file_ ? Result<void>{} : unwritable_header(path_);
  }

 private:
  const std::string& path_;
  std::fstream file_;
};

Result<RiffLayout> layout_of(const std::string& path) {
  const auto layout = riff_layout(path);
  if (layout && layout->format_at > 0 && layout->block_bytes > 0) return *layout;
  return fail(ErrorKind::malformed, "is not a WAV file, or its header is incomplete", path);
}

void set_sizes(BytePatch& patch, const RiffLayout& layout, std::uint64_t data_bytes) {
  const std::uint64_t riff_bytes = layout.data_at + data_bytes - 8;
  const bool wide = riff_bytes >= kUnknown;
  patch.text(0, wide ? "RF64" : "RIFF");
  patch.number(4, wide ? kUnknown : riff_bytes, 4);
  patch.number(layout.data_at - 4, wide ? kUnknown : data_bytes, 4);
  if (layout.ds64_at == 0) return;
  patch.text(layout.ds64_at - 8, wide ? "ds64" : "JUNK");
  patch.number(layout.ds64_at, riff_bytes, 8);
  patch.number(layout.ds64_at + 8, data_bytes, 8);
  patch.number(layout.ds64_at + 16, data_bytes / layout.block_bytes, 8);
}

}  // namespace

Result<void> set_riff_rate(const std::string& path, std::uint32_t sample_rate_hz) {
  const auto layout = layout_of(path);
  TACTO_TRY(layout);
  BytePatch patch(path);
  patch.number(layout->format_at + 4, sample_rate_hz, 4);
  patch.number(layout->format_at + 8, sample_rate_hz * layout->block_bytes, 4);
  return patch.done();
}

Result<std::uint64_t> repair_riff(const std::string& path) {
  const auto layout = layout_of(path);
  TACTO_TRY(layout);
  const std::uint64_t frames = layout->present_bytes / layout->block_bytes;
  std::error_code failed;
  std::filesystem::resize_file(path, layout->data_at + frames * layout->block_bytes, failed);
  if (failed) return unwritable_header(path);
  BytePatch patch(path);
  set_sizes(patch, *layout, frames * layout->block_bytes);
  TACTO_TRY(patch.done());
  return frames;
}

}  // namespace tacto::schema
