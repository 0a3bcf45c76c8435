// SPDX-License-Identifier: Apache-2.0
// Fields to bytes and bytes to fields, little-endian on every machine. A message lists its fields once, for
// both directions.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace tacto::wire {

/// The result of parsing a payload.
enum class Parse : uint8_t {
  ok,
  truncated,     ///< shorter than its message
  out_of_range,  ///< a count is larger than its message allows
};

template <size_t kSize>
struct UnsignedOf;
template <>
struct UnsignedOf<1> {
  using Type = uint8_t;
};
template <>
struct UnsignedOf<2> {
  using Type = uint16_t;
};
template <>
struct UnsignedOf<4> {
  using Type = uint32_t;
};
template <>
struct UnsignedOf<8> {
  using Type = uint64_t;
};

/// Appends fields to a buffer. Fields that do not fit are left out, and ok() is false. Floats are written as
/// their IEEE-754 bits.
class FieldWriter {
 public:
  FieldWriter(uint8_t* bytes, size_t capacity) noexcept : bytes_(bytes), capacity_(capacity) {}

  template <class... Fields>
  void operator()(const Fields&... fields) noexcept {
    (put(fields), ...);
  }
  template <class T>
  void array(const T* values, size_t count) noexcept {
    for (size_t i = 0; i < count; ++i) put(values[i]);
  }
  /// Returns how many elements to process: none if `value` is larger than `most`.
  template <class T>
  size_t count(const T& value, size_t most) noexcept {
    ok_ = ok_ && value <= most;
    put(value);
    return ok_ ? value : 0;
  }
  bool ok() const noexcept { return ok_; }
  size_t size() const noexcept { return size_; }

 private:
  template <class T>
  void put(const T& value) noexcept {
    typename UnsignedOf<sizeof(T)>::Type bits;
    ok_ = ok_ && capacity_ - size_ >= sizeof bits;
    if (!ok_) return;
    __builtin_memcpy(&bits, &value, sizeof bits);
    for (size_t i = 0; i < sizeof bits; ++i) bytes_[size_++] = static_cast<uint8_t>(bits >> (8 * i));
  }
  template <size_t kSize>
  void put(const char (&text)[kSize]) noexcept {
    array(text, kSize);
  }

  uint8_t* bytes_;
  size_t capacity_, size_ = 0;
  bool ok_ = true;
};

/// Reads fields from a payload. Fields beyond its end are zero. Bytes after the last field belong to a newer
/// minor version and are ignored.
class FieldReader {
 public:
  FieldReader(const uint8_t* bytes, size_t size) noexcept : bytes_(bytes), left_(size) {}

  template <class... Fields>
  void operator()(Fields&... fields) noexcept {
    (get(fields), ...);
  }
  template <class T>
  void array(T* values, size_t count) noexcept {
    for (size_t i = 0; i < count; ++i) get(values[i]);
  }
  /// Returns how many elements to process; `value` is set to zero if it was larger than `most`.
  template <class T>
  size_t count(T& value, size_t most) noexcept {
    get(value);
    if (value <= most) return value;
    if (parse_ == Parse::ok) parse_ = Parse::out_of_range;
    return value = 0;
  }
  Parse parse() const noexcept { return parse_; }

 private:
  template <class T>
  void get(T& value) noexcept {
    typename UnsignedOf<sizeof(T)>::Type bits = 0;
    if (left_ < sizeof bits) return fall_short(value);
    for (size_t i = 0; i < sizeof bits; ++i)
      bits = static_cast<decltype(bits)>(bits | (static_cast<decltype(bits)>(bytes_[i]) << (8 * i)));
    bytes_ += sizeof bits;
    left_ -= sizeof bits;
    __builtin_memcpy(&value, &bits, sizeof bits);
  }
  // The last byte of a text is always set to zero.
  template <size_t kSize>
  void get(char (&text)[kSize]) noexcept {
    array(text, kSize);
    text[kSize - 1] = 0;
  }
  template <class T>
  void fall_short(T& value) noexcept {
    value = {};
    left_ = 0;
    if (parse_ == Parse::ok) parse_ = Parse::truncated;
  }

  const uint8_t* bytes_;
  size_t left_;
  Parse parse_ = Parse::ok;
};

/// A message from its payload.
template <class Message>
Parse parse(const uint8_t* payload, size_t size, Message& message) noexcept {
  FieldReader reader(payload, size);
  Message::fields(reader, message);
  return reader.parse();
}

}  // namespace tacto::wire
