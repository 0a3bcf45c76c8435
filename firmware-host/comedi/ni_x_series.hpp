// SPDX-License-Identifier: GPL-3.0-or-later
// Cards of NI's X series in this computer, for which the kernel's comedi has no driver.
#pragma once

#include <string>
#include <vector>

namespace tacto::firmware_host {

/// As in "PCIe-6363 (PCI 1093:7435)", in the order of the bus; by the kernel's list below
/// `root`/sys/bus/pci/devices and the names of pci.ids.
std::vector<std::string> ni_x_series_cards(const std::string& root = "/");

}  // namespace tacto::firmware_host
