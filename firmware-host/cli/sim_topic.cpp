// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph help sim
#include "firmware-host/cli/verbs.hpp"
#include "firmware-host/sim/device/sim_parameters.hpp"

namespace tacto::firmware_host {
namespace {

std::string sim_text() {
  return "sim: is the emulated device, with a simulated finger on a simulated surface. Its keys, with their "
         "defaults\n"
         "(sim:surface=B,speed=50mm/s,seed=1); a seed gives the same recording on every machine:\n" +
         sim_parameters_help() +
         "Its finger rests 0.1 s, goes to the end of the surface, rests, goes back, and so on until the "
         "recording ends\n"
         "(strokes=2: twice, then it stays). It eases the load at its rests. 40 mm there and back at 50 mm/s "
         "take 1.8 s.\n"
         "Without paced=1 it runs faster than real time, and record needs --time or --strokes.\n";
}

}  // namespace

const cli::HelpTopic kSimTopic{"sim", "the emulated device and its keys", sim_text};

}  // namespace tacto::firmware_host
