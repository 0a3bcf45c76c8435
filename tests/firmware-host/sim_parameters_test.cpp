// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/device/sim_parameters.hpp"

#include <gtest/gtest.h>

namespace tacto::firmware_host {
namespace {

TEST(SimParameters, ReadsEveryKey) {
  const auto p = parse_sim_parameters(
      "surface=sine,period=1.76mm,depth=25.6um,length=60mm,speed=64mm/"
      "s,load=0.74N,wander=0.05,strokes=3,seed=12,"
      "person=4,finger=up,noise=off,friction=0.5,static_ratio=1.2,rate=20kHz,encoder_quantum=0.5um,"
      "transducer=mine,position=lvdt,lvdt_range=80mm,lvdt_bandwidth=100Hz,lvdt_noise=3um,force=chirp,"
      "force_amplitude=30mN,force_low=20Hz,force_high=400Hz,force_sweep=2s,hysteresis=0.12,second_mode=900Hz,"
      "second_mode_damping=0.05,second_mode_share=0.2,finger_load=on,finger_load_compliance=2mm/N,"
      "finger_load_corner=70Hz,finger_load_mass=0.02,source=counter,channels=8,paced=1,link_buffer=250ms");
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
  EXPECT_TRUE(p->has_lvdt);
  EXPECT_DOUBLE_EQ(p->lvdt.range_m, 80e-3);
  EXPECT_DOUBLE_EQ(p->lvdt.bandwidth_hz, 100);
  EXPECT_DOUBLE_EQ(p->lvdt.noise_m, 3e-6);
  EXPECT_TRUE(p->known_force);
  EXPECT_EQ(p->force.shape, ForceShape::chirp);
  EXPECT_DOUBLE_EQ(p->force.amplitude_n, 30e-3);
  EXPECT_DOUBLE_EQ(p->force.low_hz, 20);
  EXPECT_DOUBLE_EQ(p->force.high_hz, 400);
  EXPECT_DOUBLE_EQ(p->force.sweep_s, 2);
  EXPECT_DOUBLE_EQ(p->tray().hysteresis, 0.12);
  EXPECT_DOUBLE_EQ(p->tray().second_mode->frequency_hz, 900);
  EXPECT_DOUBLE_EQ(p->tray().second_mode->damping_ratio, 0.05);
  EXPECT_DOUBLE_EQ(p->tray().second_mode->mass_share, 0.2);
  EXPECT_DOUBLE_EQ(p->tray().finger_load->compliance_m_per_n, 2e-3);
  EXPECT_DOUBLE_EQ(p->tray().finger_load->corner_hz, 70);
  EXPECT_DOUBLE_EQ(p->tray().finger_load->mass_share, 0.02);
  EXPECT_TRUE(p->counter);
  EXPECT_EQ(p->channels, 8);
  EXPECT_DOUBLE_EQ(*p->link_buffer_s, 0.25);
}

TEST(SimParameters, NothingAskedIsThePapersBench) {
  const auto p = parse_sim_parameters("");
  ASSERT_TRUE(p);
  EXPECT_EQ(p->strokes.speed_mps, 0.05);
  EXPECT_EQ(p->load_n, 0.5);
  EXPECT_EQ(p->sample_rate_hz, 10e3);
  EXPECT_FALSE(p->known_force || p->has_lvdt || p->counter || p->link_buffer_s);
  EXPECT_FALSE(p->tray().second_mode || p->tray().finger_load);
  EXPECT_EQ(p->tray().hysteresis, 0);
}

// In either order of the keys.
TEST(SimParameters, TheSurfaceHasItsOwnSeed) {
  for (const char* text : {"seed=12,surface_seed=3", "surface_seed=3,seed=12"}) {
    const auto p = parse_sim_parameters(text);
    ASSERT_TRUE(p) << message(p.error());
    EXPECT_EQ(p->seed, 12U);
    EXPECT_EQ(p->surface.seed, 3U);
  }
  EXPECT_EQ(parse_sim_parameters("surface_seed=3")->seed, 1U);
}

struct Refusal {
  const char *text, *where, *says;
};

class SimParametersRefused : public testing::TestWithParam<Refusal> {};

TEST_P(SimParametersRefused, SaysWhereAndWhatThereIs) {
  const auto p = parse_sim_parameters(GetParam().text);
  ASSERT_FALSE(p);
  EXPECT_EQ(p.error().kind, schema::ErrorKind::usage);
  EXPECT_EQ(p.error().where, GetParam().where);
  EXPECT_NE(message(p.error()).find(GetParam().says), std::string::npos) << message(p.error());
  EXPECT_EQ(message(p.error()).find("::"), std::string::npos) << message(p.error());
}

INSTANTIATE_TEST_SUITE_P(
    All, SimParametersRefused,
    testing::Values(Refusal{"magic=on", "sim:", "tactograph help sim"},
                    Refusal{"surfice=C", "sim:", "'surface'"}, Refusal{"speed", "sim:", "key=value"},
                    Refusal{"speed=50", "sim:speed", "mm/s"}, Refusal{"speed=50mm", "sim:speed", "mm/s"},
                    Refusal{"speed=0mm/s", "sim:speed", "from 1 mm/s"},
                    Refusal{"speed=nanmm/s", "sim:speed", "finite"},
                    Refusal{"speed=1e99m/s", "sim:speed", "out of range"},
                    Refusal{"seed=-1", "sim:seed", "whole"}, Refusal{"seed=1.5", "sim:seed", "whole"},
                    Refusal{"finger=sideways", "sim:finger", "up or down"},
                    Refusal{"seed=1,seed=2", "sim:seed", "twice"},
                    Refusal{"surface=", "sim:surface", "not a possible value"},
                    Refusal{",", "sim:", "key=value"}, Refusal{"hysteresis=0.5", "sim:hysteresis", "to 0.3"},
                    Refusal{"hysteresis=16um", "sim:hysteresis", "number"},
                    Refusal{"second_mode=20kHz", "sim:second_mode", "5 kHz"},
                    Refusal{"second_mode_share=0.2", "sim:second_mode_share", "add second_mode=800Hz"},
                    Refusal{"finger_load_corner=90Hz", "sim:finger_load_corner", "add finger_load=on"},
                    Refusal{"force=pull", "sim:force", "multisine"},
                    Refusal{"force_low=20Hz", "sim:force_low", "add force=multisine"},
                    Refusal{"lvdt_noise=1um", "sim:lvdt_noise", "add position=lvdt"},
                    Refusal{"position=gps", "sim:position", "encoder or lvdt"},
                    Refusal{"cutoff=500Hz", "sim:cutoff", "add reconstruction=butterworth3"},
                    Refusal{"reconstruction=rc", "sim:reconstruction", "none or butterworth3"},
                    Refusal{"reconstruction=butterworth3,cutoff=6kHz", "sim:cutoff", "from 10 Hz to 5 kHz"},
                    Refusal{"channels=8", "sim:channels", "add source=counter"},
                    Refusal{"source=counter,channels=17", "sim:channels", "from 1 to 16"},
                    Refusal{"link_buffer=1s", "sim:link_buffer", "add paced=1"}));

class SimParametersAgainst : public testing::TestWithParam<Refusal> {};

TEST_P(SimParametersAgainst, IsRefusedWithWhatWouldDo) {
  const auto p = parse_sim_parameters(GetParam().text);
  ASSERT_TRUE(p) << message(p.error());
  const auto fits = check_against(*p, *schema::read_transducer("wiertlewski2011"), p->surface.length_m);
  ASSERT_FALSE(fits);
  EXPECT_EQ(fits.error().kind, schema::ErrorKind::usage);
  EXPECT_EQ(fits.error().where, GetParam().where);
  EXPECT_NE(message(fits.error()).find(GetParam().says), std::string::npos) << message(fits.error());
}

INSTANTIATE_TEST_SUITE_P(All, SimParametersAgainst,
                         testing::Values(Refusal{"second_mode=560Hz", "sim:second_mode", "at least 623.7 Hz"},
                                         Refusal{"force=multisine,force_low=600Hz", "sim:force_low",
                                                 "above the higher one"},
                                         Refusal{"force=sine,force_low=5kHz", "sim:force_low", "below 5 kHz"},
                                         Refusal{"position=lvdt,length=100mm", "sim:lvdt_range", "100 mm"}));

TEST(SimParameters, TheEndsOfARangeAreInIt) {
  for (const char* ends :
       {"period=50um", "period=0.05mm", "period=20mm", "depth=1000um", "length=10mm", "encoder_quantum=1nm",
        "lvdt_range=10mm,position=lvdt", "speed=1mm/s", "pull=-10N"})
    EXPECT_TRUE(parse_sim_parameters(ends)) << ends;
  EXPECT_FALSE(parse_sim_parameters("period=49.999um"));
  EXPECT_EQ(*parse_sim_parameters("period=50um")->surface.period_m, 50e-6);
}

TEST(SimParameters, HelpNamesEveryKey) {
  for (const char* key : {"surface", "finger", "speed", "load", "seed", "person", "encoder_quantum",
                          "hysteresis", "second_mode", "finger_load", "position", "lvdt_range", "force_low",
                          "source", "channels", "link_buffer", "reconstruction", "cutoff"})
    EXPECT_NE(sim_parameters_help().find(key), std::string::npos) << key;
}

}  // namespace
}  // namespace tacto::firmware_host
