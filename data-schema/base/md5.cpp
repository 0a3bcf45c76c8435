// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/md5.hpp"

#include <fmt/format.h>
#include <nettle/md5.h>

#include <array>
#include <cstdint>

namespace tacto::schema {

std::string md5_of(std::string_view bytes) {
  md5_ctx context{};
  md5_init(&context);
  md5_update(&context, bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
  std::array<std::uint8_t, MD5_DIGEST_SIZE> digest{};
  md5_digest(&context, digest.size(), digest.data());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

}  // namespace tacto::schema
