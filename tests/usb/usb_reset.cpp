// SPDX-License-Identifier: GPL-3.0-or-later
// Another program that resets a device while it is in use: usb_reset BUS DEVICE, as in
// /dev/bus/usb/BUS/DEVICE.
#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

#include <cstdio>
#include <string>

int main(int count, char** values) {
  if (count != 3) return 2;
  const std::string path = std::string("/dev/bus/usb/") + values[1] + "/" + values[2];
  const int device = open(path.c_str(), O_WRONLY);
  if (device >= 0 && ioctl(device, USBDEVFS_RESET, nullptr) == 0) return 0;
  std::perror(path.c_str());
  return 1;
}
