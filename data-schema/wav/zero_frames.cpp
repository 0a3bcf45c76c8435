// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/wav/zero_frames.hpp"

#include <algorithm>
#include <fstream>

namespace tacto::schema {
namespace {

constexpr std::uint64_t kPieceFrames = 16384;

// Whole frames, piece by piece.
class FrameBytes {
 public:
  FrameBytes(const std::string& path, const RiffLayout& layout)
      : file_(path, std::ios::binary), layout_(layout) {}

  std::uint64_t frames() const { return layout_.present_bytes / layout_.block_bytes; }
  std::uint64_t frame_of(std::size_t byte) const { return byte / layout_.block_bytes; }
  // Empty if it cannot be read.
  std::string piece(std::uint64_t first, std::uint64_t count) {
    std::string bytes(count * layout_.block_bytes, '\0');
    file_.seekg(static_cast<std::streamoff>(layout_.data_at + first * layout_.block_bytes));
    if (!file_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) bytes.clear();
    return bytes;
  }

 private:
  std::ifstream file_;
  const RiffLayout& layout_;
};

}  // namespace

std::uint64_t zero_frames_at_start(const std::string& path, const RiffLayout& layout) {
  FrameBytes bytes(path, layout);
  for (std::uint64_t first = 0; first < bytes.frames(); first += kPieceFrames) {
    const std::string piece = bytes.piece(first, std::min(kPieceFrames, bytes.frames() - first));
    if (piece.empty()) return first;
    const std::size_t found = piece.find_first_not_of('\0');
    if (found != std::string::npos) return first + bytes.frame_of(found);
  }
  return bytes.frames();
}

std::uint64_t zero_frames_at_end(const std::string& path, const RiffLayout& layout) {
  FrameBytes bytes(path, layout);
  for (std::uint64_t end = bytes.frames(); end > 0;) {
    const std::uint64_t count = std::min(kPieceFrames, end);
    const std::string piece = bytes.piece(end - count, count);
    const std::size_t found = piece.find_last_not_of('\0');
    if (piece.empty() || found != std::string::npos)
      return bytes.frames() - (piece.empty() ? end : end - count + bytes.frame_of(found) + 1);
    end -= count;
  }
  return bytes.frames();
}

}  // namespace tacto::schema
