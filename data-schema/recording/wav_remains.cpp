// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/recording/wav_remains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "data-schema/files/files.hpp"
#include "data-schema/wav/riff_layout.hpp"
#include "data-schema/wav/riff_length.hpp"

namespace tacto::schema {
namespace {

namespace fs = std::filesystem;

constexpr double kOnItsWay_s = 0.1;         // events are in the journal before their frames are in the WAV
constexpr std::size_t kFormatBytes = 48;    // "fmt " with its size and content
constexpr std::uint64_t kPageBytes = 4096;  // a file system loses whole pages

// What tactograph's writer puts before the first sample.
struct EmptyWav {
  std::string bytes;
  RiffLayout layout;
  std::string_view format() const {
    return std::string_view(bytes).substr(layout.format_at - 8, kFormatBytes);
  }
};

// Taken from the writer itself: another version of libsndfile may write another header.
Result<EmptyWav> empty_wav(const std::string& wav, const RecordingHeader& header) {
  PendingFiles beside;  // never committed
  const auto path = beside.add(wav);
  TACTO_TRY(path);
  auto writer = WavWriter::create(*path, header.sample_rate_hz, header.channels.size(), header.format);
  TACTO_TRY(writer);
  TACTO_TRY(writer->close());
  const auto layout = riff_layout(*path);
  auto bytes = read_file(*path);
  TACTO_TRY(bytes);
  if (!layout || layout->format_at < 8 || layout->data_at < layout->format_at + kFormatBytes - 8)
    return fail(ErrorKind::internal, "an empty WAV has an unknown header", *path);
  return EmptyWav{std::move(*bytes), *layout};
}

std::string first_bytes(const std::string& path, std::size_t count) {
  std::string bytes(count, '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(count));
  return bytes;
}

bool is_sound(const std::string& wav, const EmptyWav& empty) {
  const auto layout = riff_layout(wav);
  if (!layout || layout->data_at > kPageBytes || layout->format_at < 8) return false;
  return first_bytes(wav, layout->data_at).substr(layout->format_at - 8, kFormatBytes) == empty.format();
}

bool same_or_lost(std::string_view found, std::string_view ours) {
  return std::ranges::equal(found, ours, [](char a, char b) { return a == b || a == '\0'; });
}

// Zeros in place of its header; the first bytes of the header, which change, may contain anything.
bool is_remnant(const std::string& wav, const EmptyWav& empty) {
  const std::string head = first_bytes(wav, empty.layout.data_at);
  const std::string_view found = head, ours = std::string_view(empty.bytes);
  return same_or_lost(found.substr(8, 4), ours.substr(8, 4)) &&
         same_or_lost(found.substr(empty.layout.format_at - 8, kFormatBytes), empty.format()) &&
         same_or_lost(found.substr(empty.layout.data_at - 8, 4), ours.substr(empty.layout.data_at - 8, 4));
}

tl::unexpected<Error> unknown_content(const std::string& wav, const EmptyWav& empty) {
  const auto bytes = empty.layout.data_at;
  return fail(ErrorKind::malformed,
              fmt::format("is not the WAV of this recording: its first {} bytes are neither its header nor "
                          "zeros; nothing was changed",
                          bytes),
              wav,
              fmt::format("if the frames after them are intact, use 'dd if=/dev/zero of={} bs={} count=1 "
                          "conv=notrunc' on a copy, then recover it",
                          wav, bytes));
}

Result<void> write_header(const std::string& wav, const EmptyWav& empty) {
  std::fstream file(wav, std::ios::binary | std::ios::in | std::ios::out);
  file.write(empty.bytes.data(), static_cast<std::streamsize>(empty.layout.data_at));
  file.close();
  return file ? Result<void>{} : fail(ErrorKind::cannot_write, "its header cannot be written", wav);
}

Result<void> cut_off_at(const std::string& wav, std::uint64_t bytes) {
  std::error_code failed;
  fs::resize_file(wav, bytes, failed);
  return failed ? fail(ErrorKind::cannot_write, "cannot be shortened: " + failed.message(), wav)
                : Result<void>{};
}

std::uint64_t size_of(const std::string& path) {
  std::error_code unknown;
  const auto size = fs::file_size(path, unknown);
  return unknown ? 0 : size;
}

std::string stretch(std::uint64_t frames, const RecordingHeader& header) {
  return fmt::format("{} frames ({:.3g} s)", frames, static_cast<double>(frames) / header.sample_rate_hz);
}

Result<void> check_holds_something(const std::string& wav, const EmptyWav& empty,
                                   const RecordingHeader& header, std::uint64_t known_frames) {
  const std::uint64_t block = empty.layout.block_bytes;
  const bool early = static_cast<double>(known_frames) <= kOnItsWay_s * header.sample_rate_hz;
  if (early || size_of(wav) >= empty.layout.data_at + block) return {};
  return fail(ErrorKind::malformed,
              fmt::format("contains no frames, but its journal lists {}; nothing was changed", known_frames),
              wav, "look for the WAV elsewhere (lost+found, a backup) and copy it here");
}

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

// The number of frames from the first on with zeros in all their bytes. Only whole frames count; 0 for a
// file that cannot be read.
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

// The same up to the last whole frame.
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

// The header's sizes are written after the frames that they count.
Result<void> cut_unwritten(const std::string& wav, const RecordingHeader& header, WavRemains& remains) {
  const auto layout = riff_layout(wav);
  const auto length = riff_length(wav);
  if (!length) return {};
  const std::uint64_t frames = layout->present_bytes / layout->block_bytes;
  const std::uint64_t written = frames - zero_frames_at_end(wav, *layout);
  const std::uint64_t kept = std::clamp(length->promised_frames, std::min(written, frames), frames);
  if (kept == frames) return {};
  remains.notes.push_back(fmt::format("its last {} were zeros that had not been written: they were removed",
                                      stretch(frames - kept, header)));
  return cut_off_at(wav, layout->data_at + kept * layout->block_bytes);
}

void note_zeros(const std::string& wav, const RiffLayout& layout, const RecordingHeader& header,
                WavRemains& remains) {
  const std::uint64_t first = zero_frames_at_start(wav, layout), last = zero_frames_at_end(wav, layout);
  const auto note = [&](const char* where, std::uint64_t frames) {
    remains.notes.push_back(
        fmt::format("its {} {} are zeros: they may be lost", where, stretch(frames, header)));
  };
  if ((first + 1) * layout.block_bytes > kPageBytes - layout.data_at) note("first", first);
  if (last * layout.block_bytes >= kPageBytes && last < remains.frames) note("last", last);
}

void note_what_is_missing(const RecordingHeader& header, std::uint64_t known_frames, WavRemains& remains) {
  if (known_frames > remains.frames)
    remains.notes.push_back(fmt::format("its journal lists frame {}, but it ends at {}: at least {} are lost",
                                        known_frames, remains.frames,
                                        stretch(known_frames - remains.frames, header)));
}

Result<void> make_header_sound(const std::string& wav, const EmptyWav& empty, WavRemains& remains) {
  if (!is_remnant(wav, empty)) return unknown_content(wav, empty);
  if (size_of(wav) >= empty.layout.data_at)
    remains.notes.push_back(
        "the header of its WAV was damaged and was rewritten: frames near it may be damaged, too");
  return write_header(wav, empty);
}

}  // namespace

Result<WavRemains> salvage_wav(const std::string& wav, const RecordingHeader& header,
                               std::uint64_t known_frames) {
  if (!is_file(wav))
    return fail(ErrorKind::not_found, "is missing: only its journal exists", wav,
                "copy it to the folder of the journal; if nothing was recorded, delete the journal");
  const auto empty = empty_wav(wav, header);
  TACTO_TRY(empty);
  TACTO_TRY(check_holds_something(wav, *empty, header, known_frames));
  WavRemains remains;
  const bool sound = is_sound(wav, *empty);
  TACTO_TRY(sound ? Result<void>{} : make_header_sound(wav, *empty, remains));
  // A lost header states no length.
  TACTO_TRY(sound ? cut_unwritten(wav, header, remains) : Result<void>{});
  const auto layout = riff_layout(wav);
  if (!layout) return fail(ErrorKind::malformed, "is not a WAV file", wav);
  remains.frames = layout->present_bytes / layout->block_bytes;
  note_zeros(wav, *layout, header, remains);
  if (const auto left = layout->present_bytes % layout->block_bytes; left != 0)
    remains.notes.push_back(fmt::format("its last frame was incomplete: its {} bytes were removed", left));
  note_what_is_missing(header, known_frames, remains);
  return remains;
}

}  // namespace tacto::schema
