// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/exchange/mat5_check.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace tacto::schema {
namespace {

constexpr std::uint64_t kHeaderBytes = 128;
constexpr std::size_t kPiece = std::size_t{1} << 15;
constexpr int kDeepest = 64;                      // arrays within arrays
constexpr std::uint64_t kMostArrays = 1'000'000;  // matio allocates some 300 bytes for each

enum Type : std::uint32_t { kInt32 = 5, kUint32 = 6, kMatrix = 14, kCompressed = 15 };
enum Class : std::uint32_t { kCell = 1, kStruct, kObject, kChar, kSparse, kDouble, kUint64 = 15 };

// The bytes of a number of a storage type; 0 for one that holds no numbers.
std::uint64_t number_bytes(std::uint32_t type) {
  constexpr std::array<std::uint8_t, 14> kBytes = {0, 1, 1, 2, 2, 4, 4, 4, 0, 8, 0, 0, 8, 8};
  return type < kBytes.size() ? kBytes[type] : 0;
}

std::uint64_t padded_to_8(std::uint64_t bytes) {
  return (bytes + 7) / 8 * 8;
}

class Bytes {
 public:
  Bytes() = default;
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;
  virtual ~Bytes() = default;
  // Fills `out`, or returns false.
  virtual bool take(std::span<unsigned char> out) = 0;
  virtual bool skip(std::uint64_t count) = 0;
};

class FileBytes : public Bytes {
 public:
  explicit FileBytes(std::FILE* file) : file_(file) {}
  bool take(std::span<unsigned char> out) override {
    return std::fread(out.data(), 1, out.size(), file_) == out.size();
  }
  // The length of the file was compared before.
  bool skip(std::uint64_t count) override { return fseeko(file_, static_cast<off_t>(count), SEEK_CUR) == 0; }

 private:
  std::FILE* file_;
};

// What a compressed element of `left` bytes holds.
class InflatedBytes : public Bytes {
 public:
  InflatedBytes(std::FILE* file, std::uint64_t left) : file_(file), left_(left) {
    ready_ = inflateInit(&stream_) == Z_OK;
  }
  InflatedBytes(const InflatedBytes&) = delete;
  InflatedBytes& operator=(const InflatedBytes&) = delete;
  ~InflatedBytes() override { inflateEnd(&stream_); }

  bool take(std::span<unsigned char> out) override { return inflated(out) == out.size(); }
  bool skip(std::uint64_t count) override {
    std::array<unsigned char, kPiece> scratch;
    for (; count > 0; count -= std::min<std::uint64_t>(count, kPiece))
      if (!take(std::span(scratch).first(std::min<std::uint64_t>(count, kPiece)))) return false;
    return true;
  }
  // Whether nothing follows, and the checksum is right.
  bool ends() {
    std::array<unsigned char, 1> more;
    return inflated(more) == 0 && ended_;
  }

 private:
  std::size_t inflated(std::span<unsigned char> out) {
    stream_.next_out = out.data();
    stream_.avail_out = static_cast<uInt>(out.size());
    while (ready_ && !ended_ && stream_.avail_out > 0) {
      if (stream_.avail_in == 0 && !refill()) break;
      const int status = inflate(&stream_, Z_NO_FLUSH);
      ended_ = status == Z_STREAM_END;
      ready_ = ended_ || status == Z_OK;
    }
    return out.size() - stream_.avail_out;
  }
  bool refill() {
    const std::size_t count = std::min<std::uint64_t>(left_, kPiece);
    const std::size_t got = std::fread(packed_.data(), 1, count, file_);
    left_ -= got;
    stream_.next_in = packed_.data();
    stream_.avail_in = static_cast<uInt>(got);
    return got > 0;
  }

  std::FILE* file_;
  std::uint64_t left_;
  z_stream stream_ = {};
  bool ready_ = false, ended_ = false;
  std::array<unsigned char, kPiece> packed_ = {};
};

struct Tag {
  std::uint32_t type = 0;
  std::uint64_t bytes = 0;
  std::array<unsigned char, 4> small = {};  // the data of an element of at most 4 bytes
  bool is_small = false;
};

class Check {
 public:
  Check(std::FILE* file, std::uint64_t size, const std::string& path)
      : file_(file), size_(size), path_(path) {}

  Result<void> run() {
    std::array<unsigned char, kHeaderBytes> header = {};
    if (size_ < kHeaderBytes || !FileBytes(file_).take(header)) return broken("has an incomplete header");
    const std::string_view order(reinterpret_cast<const char*>(header.data()) + 126, 2);
    if (order != "IM" && order != "MI") return broken("has a header without a byte order");
    swapped_ = (order == "IM") != (std::endian::native == std::endian::little);
    for (at_ = kHeaderBytes; at_ < size_; ++variable_) TACTO_TRY(variable());
    return {};
  }

 private:
  tl::unexpected<Error> broken(std::string_view what) const {
    return fail(ErrorKind::malformed, std::string(what),
                fmt::format("{}: variable {}, at byte {}", path_, variable_, at_),
                "the file was cut or is damaged: copy it again, or save it again in MATLAB");
  }
  std::uint32_t word(const unsigned char* bytes) const {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes, sizeof value);
    return swapped_ ? __builtin_bswap32(value) : value;
  }
  Result<void> variable() {
    FileBytes file(file_);
    std::array<unsigned char, 8> raw = {};
    if (size_ - at_ < raw.size() || !file.take(raw)) return broken("ends inside a tag");
    const std::uint32_t type = word(raw.data());
    const std::uint64_t bytes = word(raw.data() + 4);
    if (type != kMatrix && type != kCompressed) return broken("has a tag that is no array");
    if (bytes > size_ - at_ - raw.size())
      return broken(
          fmt::format("ends early: the array has {} bytes, and {} follow", bytes, size_ - at_ - raw.size()));
    TACTO_TRY(type == kMatrix ? matrix(file, bytes, 0) : compressed(bytes));
    at_ += raw.size() + bytes;
    if (fseeko(file_, static_cast<off_t>(at_), SEEK_SET) != 0) return broken("cannot be read");
    return {};
  }
  Result<void> compressed(std::uint64_t bytes) {
    InflatedBytes inflated(file_, bytes);
    std::array<unsigned char, 8> raw = {};
    if (!inflated.take(raw) || word(raw.data()) != kMatrix)
      return broken("has a compressed part that is no array");
    TACTO_TRY(matrix(inflated, word(raw.data() + 4), 0));
    if (!inflated.ends()) return broken("has a compressed part with a wrong length or checksum");
    return {};
  }
  // Takes an element's tag out of the `left` bytes of an array; the data of a larger one follow.
  Result<Tag> tag(Bytes& bytes, std::uint64_t& left) {
    std::array<unsigned char, 8> raw = {};
    if (left < raw.size() || !bytes.take(raw)) return broken("has an array that ends early");
    left -= raw.size();
    const std::uint32_t first = word(raw.data());
    Tag tag{first & 0xffffU, first >> 16U, {}, first >> 16U != 0};
    if (tag.is_small) {
      if (tag.bytes > tag.small.size()) return broken("has a small element of more than 4 bytes");
      std::copy_n(raw.data() + 4, tag.small.size(), tag.small.begin());
      return tag;
    }
    tag.bytes = word(raw.data() + 4);
    if (padded_to_8(tag.bytes) > left)
      return broken(fmt::format("has an element of {} bytes in an array with {} left", tag.bytes, left));
    return tag;
  }
  Result<void> skip(Bytes& bytes, const Tag& tag, std::uint64_t& left) {
    if (tag.is_small) return {};
    if (!bytes.skip(padded_to_8(tag.bytes))) return broken("has an array that ends early");
    left -= padded_to_8(tag.bytes);
    return {};
  }
  Result<Tag> skipped(Bytes& bytes, std::uint64_t& left) {
    const auto element = tag(bytes, left);
    TACTO_TRY(element);
    TACTO_TRY(skip(bytes, *element, left));
    return element;
  }
  // The 32-bit numbers of an element of one of two types.
  Result<std::vector<std::uint32_t>> words(Bytes& bytes, std::uint64_t& left, std::uint32_t type) {
    constexpr std::uint64_t kMost = 128;
    const auto element = tag(bytes, left);
    TACTO_TRY(element);
    if ((element->type != kInt32 && element->type != type) || element->bytes % 4 != 0 ||
        element->bytes > kMost)
      return broken("has an array with a damaged header");
    std::array<unsigned char, kMost> raw = {};
    std::copy_n(element->small.begin(), element->small.size(), raw.begin());
    if (!element->is_small) {
      const std::uint64_t all = padded_to_8(element->bytes);
      if (!bytes.take(std::span(raw).first(all))) return broken("has an array that ends early");
      left -= all;
    }
    std::vector<std::uint32_t> values;
    for (std::uint64_t i = 0; i < element->bytes; i += 4) values.push_back(word(raw.data() + i));
    return values;
  }
  Result<void> numbers(Bytes& bytes, std::uint64_t& left, std::uint64_t count) {
    const auto element = skipped(bytes, left);
    TACTO_TRY(element);
    const std::uint64_t each = number_bytes(element->type);
    if (each == 0 || element->bytes % each != 0 || element->bytes / each != count)
      return broken(fmt::format("has an array of {} numbers in {} bytes of type {}", count, element->bytes,
                                element->type));
    return {};
  }
  Result<void> arrays(Bytes& bytes, std::uint64_t& left, std::uint64_t count, int depth) {
    if (count > left / 8) return broken(fmt::format("has {} parts in {} bytes", count, left));
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto element = tag(bytes, left);
      TACTO_TRY(element);
      if (element->type != kMatrix || element->is_small) return broken("has a part that is no array");
      TACTO_TRY(matrix(bytes, element->bytes, depth + 1));
      const std::uint64_t pad = padded_to_8(element->bytes) - element->bytes;
      if (!bytes.skip(pad)) return broken("has an array that ends early");
      left -= padded_to_8(element->bytes);
    }
    return {};
  }
  Result<void> fields(Bytes& bytes, std::uint64_t& left, std::uint64_t count, int depth) {
    const auto length = words(bytes, left, kInt32);
    TACTO_TRY(length);
    const auto names = skipped(bytes, left);
    TACTO_TRY(names);
    if (length->size() != 1 || (*length)[0] == 0 || names->bytes % (*length)[0] != 0)
      return broken("has a struct with damaged names of fields");
    const std::uint64_t each = names->bytes / (*length)[0];
    if (each > 0 && count > left / each) return broken("has a struct that ends early");
    return arrays(bytes, left, count * each, depth);
  }
  // An array of `left` bytes.
  Result<void> matrix(Bytes& bytes, std::uint64_t left, int depth) {
    if (++arrays_ > kMostArrays || depth > kDeepest)
      return fail(ErrorKind::unsuitable,
                  depth > kDeepest ? fmt::format("has arrays nested deeper than {}", kDeepest)
                                   : fmt::format("has more than {} arrays", kMostArrays),
                  path_, "in MATLAB save only the variables to import: save('trial.mat', 'data')");
    if (left == 0) return {};  // an empty cell or field
    const auto flags = words(bytes, left, kUint32);
    TACTO_TRY(flags);
    if (flags->size() != 2) return broken("has an array with damaged flags");
    const std::uint32_t kind = (*flags)[0] & 0xffU;
    const bool complex = ((*flags)[0] & 0x0800U) != 0;
    if (kind > kUint64) return rest(bytes, left);  // functions and opaque objects
    const auto dims = words(bytes, left, kInt32);
    TACTO_TRY(dims);
    std::uint64_t count = 1;
    for (const std::uint32_t dim : *dims)
      if (dim > INT32_MAX || __builtin_mul_overflow(count, dim, &count))
        return broken("has impossible dimensions");
    if (dims->size() < 2) return broken("has fewer than two dimensions");
    TACTO_TRY(skipped(bytes, left));                       // its name
    if (kind == kObject) TACTO_TRY(skipped(bytes, left));  // its class
    if (kind == kCell) TACTO_TRY(arrays(bytes, left, count, depth));
    if (kind == kStruct || kind == kObject) TACTO_TRY(fields(bytes, left, count, depth));
    if (kind >= kDouble) TACTO_TRY(numbers(bytes, left, count));
    if (kind >= kDouble && complex) TACTO_TRY(numbers(bytes, left, count));
    return rest(bytes, left);
  }
  // Text and sparse arrays, which are not imported, and padding.
  Result<void> rest(Bytes& bytes, std::uint64_t left) {
    if (!bytes.skip(left)) return broken("has an array that ends early");
    return {};
  }

  std::FILE* file_;
  std::uint64_t size_, at_ = 0, variable_ = 1, arrays_ = 0;
  const std::string& path_;
  bool swapped_ = false;
};

struct CloseMat5 {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

Result<void> check_mat5(const std::string& path) {
  const std::unique_ptr<std::FILE, CloseMat5> file(std::fopen(path.c_str(), "rbe"));
  if (!file || fseeko(file.get(), 0, SEEK_END) != 0)
    return fail(ErrorKind::not_found, "cannot be read", path);
  const off_t size = ftello(file.get());
  std::rewind(file.get());
  return Check(file.get(), static_cast<std::uint64_t>(size), path).run();
}

}  // namespace tacto::schema
