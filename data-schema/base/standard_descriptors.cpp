// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/standard_descriptors.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace tacto::schema {

// open() returns the lowest free number.
void open_closed_descriptors() noexcept {
  int opened = 0;
  while (opened >= 0 && opened <= STDERR_FILENO) opened = open("/dev/null", O_RDWR);
  if (opened > STDERR_FILENO) close(opened);
}

}  // namespace tacto::schema
