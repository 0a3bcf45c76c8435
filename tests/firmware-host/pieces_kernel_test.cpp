// SPDX-License-Identifier: GPL-3.0-or-later
// The bits of a scene of pieces, which cortex_m4_test compares with those of a Cortex-M4F.
#include <gtest/gtest.h>

#include <memory>

#include "tests/firmware-host/pieces_workload.hpp"

namespace tacto::core {
namespace {

TEST(PiecesKernel, TheirBitsAreTheSameEverywhere) {
  auto workload = std::make_unique<tests::PiecesWorkload>();
  tests::DriveFingerprint fingerprint;
  for (std::uint32_t i = 0; i < tests::kWorkloadTicks; ++i) fingerprint.add(workload->tick());
  EXPECT_EQ(fingerprint.value(), tests::kPiecesFingerprint);
  EXPECT_EQ(workload->flags(),
            wire::kTickAmplitudeLimited | wire::kTickSlewLimited | wire::kTickEnergyLimited);
}

}  // namespace
}  // namespace tacto::core
