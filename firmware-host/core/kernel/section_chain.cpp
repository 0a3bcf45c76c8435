// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/kernel/section_chain.hpp"

#include "firmware-host/core/kernel/finite.hpp"

namespace tacto::core {

bool is_stable(const wire::Section& s) noexcept {
  const bool finite = is_finite(s.b0) && is_finite(s.b1) && is_finite(s.b2);
  return finite && s.a2 > -1 && s.a2 < 1 && s.a1 < 1 + s.a2 && s.a1 > -1 - s.a2;
}

}  // namespace tacto::core
