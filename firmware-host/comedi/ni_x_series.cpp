// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/comedi/ni_x_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

namespace tacto::firmware_host {
namespace {

namespace fs = std::filesystem;

// pci.ids (Debian's package, 2023-04-11): all are device c4c4 of National Instruments; the subsystem tells
// which.
constexpr unsigned kNationalInstruments = 0x1093, kDevice = 0xc4c4;
constexpr std::pair<unsigned, const char*> kCards[] = {
    {0x7425, "PCIe-6320"}, {0x7427, "PCIe-6321"}, {0x7428, "PXIe-6323"}, {0x7429, "PCIe-6323"},
    {0x742a, "PXIe-6341"}, {0x742b, "PCIe-6341"}, {0x742c, "PXIe-6343"}, {0x742d, "PCIe-6343"},
    {0x742f, "PCIe-6351"}, {0x7431, "PCIe-6353"}, {0x7432, "PXIe-6361"}, {0x7433, "PCIe-6361"},
    {0x7434, "PXIe-6363"}, {0x7435, "PCIe-6363"}, {0x7436, "PXIe-6356"}, {0x7437, "PXIe-6358"},
    {0x7438, "PXIe-6366"}, {0x7439, "PXIe-6368"}, {0x74dd, "PXIe-6376"}, {0x74de, "PXIe-6378"},
    {0x77a5, "PXIe-6345"}, {0x77a6, "PXIe-6355"}, {0x77a7, "PXIe-6365"}, {0x77a8, "PXIe-6375"}};

// The number of one of a PCI device's files, as in "0x1093"; 0 if there is none.
unsigned number_in(const fs::path& file) {
  unsigned number = 0;
  std::ifstream(file) >> std::hex >> number;
  return number;
}

}  // namespace

std::vector<std::string> ni_x_series_cards(const std::string& root) {
  std::vector<fs::path> devices;
  std::error_code error;
  for (fs::directory_iterator entry(fs::path(root) / "sys/bus/pci/devices", error), end;
       !error && entry != end; entry.increment(error))
    devices.push_back(entry->path());
  std::ranges::sort(devices);
  std::vector<std::string> found;
  for (const fs::path& device : devices) {
    if (number_in(device / "vendor") != kNationalInstruments || number_in(device / "device") != kDevice)
      continue;
    const unsigned subsystem = number_in(device / "subsystem_device");
    const auto* const card = std::ranges::find(kCards, subsystem, &std::pair<unsigned, const char*>::first);
    if (card != std::end(kCards))
      found.push_back(fmt::format("{} (PCI {:04x}:{:04x})", card->second, kNationalInstruments, subsystem));
  }
  return found;
}

}  // namespace tacto::firmware_host
