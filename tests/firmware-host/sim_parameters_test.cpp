// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/sim_parameters.hpp"

#include <gtest/gtest.h>

namespace tacto::firmware_host {
namespace {

TEST(SimParameters, ReadsEveryKey) {
  const auto p = parse_sim_parameters(
      "surface=sine,period=1.76mm,depth=25.6um,length=60mm,speed=64mm/"
      "s,load=0.74N,wander=0.05,strokes=3,seed=12,"
      "person=4,finger=up,noise=off,friction=0.5,static_ratio=1.2,rate=20kHz,encoder_quantum=0.5um,"
      "transducer=mine");
  ASSERT_TRUE(p) << message(p.error());
  EXPECT_EQ(p->surface.name, "sine");
  EXPECT_DOUBLE_EQ(*p->surface.period_m, 1.76e-3);
  EXPECT_DOUBLE_EQ(*p->surface.depth_m, 25.6e-6);
  EXPECT_DOUBLE_EQ(p->surface.length_m, 60e-3);
  EXPECT_DOUBLE_EQ(p->strokes.speed_mps, 64e-3);
  EXPECT_DOUBLE_EQ(p->strokes.wander, 0.05);
  EXPECT_EQ(p->strokes.strokes, 3);
  EXPECT_DOUBLE_EQ(p->load_n, 0.74);
  EXPECT_EQ(p->seed, 12U);
  EXPECT_EQ(p->surface.seed, 12U);
  EXPECT_EQ(p->person, 4U);
  EXPECT_FALSE(p->finger_down);
  EXPECT_FALSE(p->noise);
  EXPECT_DOUBLE_EQ(p->finger.friction, 0.5);
  EXPECT_DOUBLE_EQ(p->finger.static_ratio, 1.2);
  EXPECT_DOUBLE_EQ(p->sample_rate_hz, 20e3);
  EXPECT_DOUBLE_EQ(p->encoder_quantum_m, 0.5e-6);
  EXPECT_EQ(p->transducer, "mine");
}

TEST(SimParameters, NothingAskedIsThePapersBench) {
  const auto p = parse_sim_parameters("");
  ASSERT_TRUE(p);
  EXPECT_EQ(p->strokes.speed_mps, 0.05);
  EXPECT_EQ(p->load_n, 0.5);
  EXPECT_EQ(p->sample_rate_hz, 10e3);
}

struct Refusal {
  const char *text, *where, *says;
};

class SimParametersRefused : public testing::TestWithParam<Refusal> {};

TEST_P(SimParametersRefused, SaysWhereAndWhatThereIs) {
  const auto p = parse_sim_parameters(GetParam().text);
  ASSERT_FALSE(p);
  EXPECT_EQ(p.error().fault, schema::Fault::usage);
  EXPECT_EQ(p.error().where, GetParam().where);
  EXPECT_NE(message(p.error()).find(GetParam().says), std::string::npos) << message(p.error());
}

INSTANTIATE_TEST_SUITE_P(
    All, SimParametersRefused,
    testing::Values(
        Refusal{"magic=on", "sim:", "surface, finger, noise"}, Refusal{"speed", "sim:", "key=value"},
        Refusal{"speed=50", "sim:speed", "mm/s"}, Refusal{"speed=50mm", "sim:speed", "mm/s"},
        Refusal{"speed=0mm/s", "sim:speed", "from 1 mm/s"}, Refusal{"speed=nanmm/s", "sim:speed", "finite"},
        Refusal{"speed=1e99m/s", "sim:speed", "out of range"}, Refusal{"seed=-1", "sim:seed", "whole"},
        Refusal{"seed=1.5", "sim:seed", "whole"}, Refusal{"finger=sideways", "sim:finger", "up or down"},
        Refusal{"seed=1,seed=2", "sim:seed", "twice"}, Refusal{"surface=", "sim:surface", "no value"},
        Refusal{",", "sim:", "key=value"}));

TEST(SimParameters, HelpNamesEveryKey) {
  for (const char* key : {"surface", "finger", "speed", "load", "seed", "person", "encoder_quantum"})
    EXPECT_NE(sim_parameters_help().find(key), std::string::npos) << key;
}

}  // namespace
}  // namespace tacto::firmware_host
