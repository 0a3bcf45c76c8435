// SPDX-License-Identifier: GPL-3.0-or-later
// The bits of scenes of pieces, which cortex_m4_test compares with those of a Cortex-M4F.
#include <gtest/gtest.h>

#include <memory>

#include "tests/firmware-host/pieces_workload.hpp"
#include "tests/firmware-host/volume_workload.hpp"

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

TEST(PiecesKernel, ThoseOfVolumesAreTheSameEverywhere) {
  auto workload = std::make_unique<tests::VolumeWorkload>();
  tests::DriveFingerprint fingerprint;
  int touched = 0;
  for (std::uint32_t i = 0; i < tests::kWorkloadTicks; ++i) {
    const float force_n = workload->tick();
    touched += force_n != 0;
    fingerprint.add(force_n);
  }
  EXPECT_EQ(fingerprint.value(), tests::kVolumeFingerprint);
  EXPECT_GT(touched, 1000);
}

}  // namespace
}  // namespace tacto::core
