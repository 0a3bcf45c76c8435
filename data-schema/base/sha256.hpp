// SPDX-License-Identifier: GPL-3.0-or-later
// SHA-256 of bytes that arrive in parts; MD5 as X3P files contain it.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace tacto::schema {

class Sha256 {
 public:
  Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  ~Sha256();

  void add(std::string_view bytes);
  /// Of all bytes since the beginning, in lower-case hexadecimal; then it starts again.
  std::string hexadecimal();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// MD5 in lower-case hexadecimal, the checksum inside other programs' files. It finds damage, and does not
/// protect from forgery.
std::string md5_of(std::string_view bytes);

}  // namespace tacto::schema
