// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/comedi/ni_x_series.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::firmware_host {
namespace {

TEST(NiXSeries, IsNamedByItsPciNumbers) {
  const tests::TemporaryFolder root;
  EXPECT_TRUE(ni_x_series_cards(root / "").empty());
  const auto card = [&](const std::string& place, const char* vendor, const char* device,
                        const char* subsystem) {
    const std::string folder = root / ("sys/bus/pci/devices/" + place);
    std::filesystem::create_directories(folder);
    std::ofstream(folder + "/vendor") << vendor << '\n';
    std::ofstream(folder + "/device") << device << '\n';
    std::ofstream(folder + "/subsystem_device") << subsystem << '\n';
  };
  card("0000:00:02.0", "0x8086", "0xc4c4", "0x7435");
  card("0000:03:00.0", "0x1093", "0x70b7", "0x70b7");  // PCI-6254, M series
  card("0000:04:00.0", "0x1093", "0xc4c4", "0x7435");
  card("0000:05:00.0", "0x1093", "0xc4c4", "0x7425");
  EXPECT_EQ(ni_x_series_cards(root / ""),
            (std::vector<std::string>{"PCIe-6363 (PCI 1093:7435)", "PCIe-6320 (PCI 1093:7425)"}));
}

}  // namespace
}  // namespace tacto::firmware_host
