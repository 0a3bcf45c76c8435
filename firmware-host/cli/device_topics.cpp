// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph help devices, tactograph help sim
#include "firmware-host/cli/verbs.hpp"
#include "firmware-host/sim/device/sim_parameters.hpp"

namespace tacto::firmware_host {
namespace {

std::string sim_text() {
  return "sim: is the emulated device, with a simulated finger on a simulated surface. Its keys, with their "
         "defaults "
         "(sim:surface=B,speed=50mm/s,seed=1); recordings with equal seeds are equal on every machine:\n" +
         sim_parameters_help() +
         "The finger rests for 0.1 s, moves to the end of the surface, rests, moves back, and so on until "
         "the recording ends (strokes=2: it stops after two strokes). Its load is lower at rest. 40 mm "
         "forth and back at 50 mm/s take 1.8 s.\n"
         "Without paced=1 it runs faster than real time, and record needs --time or --strokes.\n"
         "\nsim:planar is an emulated force device, which plays scenes with force patches. Its keys:\n"
         "  device=  a preset or NAME.device.json; default: sandpaper-1990\n"
         "  hand=    a preset or NAME.hand.json; default: none, the device moves along the path\n"
         "sim:arm is the same with device=arm: three axes, for scenes with pieces in space.\n";
}

std::string devices_text() {
  return "The devices, as option -d takes them:\n"
         "  usb:                    the only board on USB\n"
         "  usb:serial=XYZ          a board by its serial number\n"
         "  usb:port=1-2            a board by its port\n"
         "  tty:                    the only board on the USB serial ports\n"
         "  tty:/dev/ttyACM0        a board by its serial port\n"
         "  tty:PATH,baud=2000000   the same at another baud rate than 1000000\n"
         "  comedi:NAME             a data acquisition card, wired as NAME.wiring.json says\n"
         "  sim:KEY=VALUE,...       the emulated device; the keys: tactograph help sim\n"
         "  sim:planar,KEY=VALUE    the emulated force device, for scenes with force patches\n"
         "  sim:arm,KEY=VALUE       the same with three axes, for scenes with pieces in space\n"
         "  replay:NAME             a recording as a device, as fast as possible\n"
         "  replay:NAME,paced=1     the same in real time\n"
         "tactograph scan lists the devices that answer.\n";
}

}  // namespace

const cli::HelpTopic kDevicesTopic{
    "devices", "how devices are named: USB, serial port, emulated, a recording", devices_text};
const cli::HelpTopic kSimTopic{"sim", "the emulated device and its keys", sim_text};

}  // namespace tacto::firmware_host
