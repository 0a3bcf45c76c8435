// SPDX-License-Identifier: GPL-3.0-or-later
// A fake libcomedi, to be preloaded: a card whose counter follows an encoder, which the kernel's comedi_test
// does not have. As in that module, analog input N reads what was written to output N. It logs each
// instruction that changes or counts something, as a line: "count VALUE", "ao CODE", "dio LEVEL", "config
// WHAT VALUE". The environment:
//   FAKE_COMEDI_LOG          the log's file
//   FAKE_COMEDI_DRIVER       its driver's name
//   FAKE_COMEDI_WITHOUT      the type of subdevice (comedi.h) that the card lacks
//   FAKE_COMEDI_TAKES_US     what each instruction takes
//   FAKE_COMEDI_FAILS_AFTER  so many reads of the counter; all later ones fail
//   FAKE_COMEDI_LOCKED       another program has the output
#include <comedilib.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

struct comedi_t_struct {
  int log = -1;
};

namespace {

// The finger moves 25 counts per reading, forth and back over 20,000. The counter of 24 bits begins below 0.
constexpr lsampl_t kCounterMost = 0xFFFFFF, kCounterBegins = kCounterMost - 999, kAnalogMost = 0xFFFF;
constexpr long kCountsPerRead = 25, kReadsOneWay = 800;
constexpr int kTypes[] = {COMEDI_SUBD_AI, COMEDI_SUBD_AO, COMEDI_SUBD_DIO, COMEDI_SUBD_COUNTER};
constexpr int kChannels[] = {8, 2, 8, 1};
comedi_range ranges[] = {{-10, 10, UNIT_volt}, {-1, 1, UNIT_volt}};
long reads = 0;
lsampl_t held[2] = {kAnalogMost / 2, kAnalogMost / 2};

long setting(const char* name, long otherwise) {
  const char* const text = std::getenv(name);
  return text != nullptr ? std::atol(text) : otherwise;
}

void log_line(comedi_t* card, const char* what, long value) {
  char line[64];
  const int size = std::snprintf(line, sizeof line, "%s %ld\n", what, value);
  if (card->log >= 0 && ::write(card->log, line, static_cast<std::size_t>(size)) != size) std::abort();
}

void take_time() {
  static const long us = setting("FAKE_COMEDI_TAKES_US", 0);
  const auto until = std::chrono::steady_clock::now() + std::chrono::microseconds(us);
  while (std::chrono::steady_clock::now() < until) {
  }
}

bool is(unsigned subdevice, int type) {
  return subdevice < 4 && kTypes[subdevice] == type && setting("FAKE_COMEDI_WITHOUT", -1) != type;
}

lsampl_t read_analog(unsigned channel) {
  return channel < 2 ? held[channel] : kAnalogMost / 2;
}

int failed(int why) {
  errno = why;
  return -1;
}

int read_counter(comedi_t* card, lsampl_t* data) {
  static const long fails_after = setting("FAKE_COMEDI_FAILS_AFTER", -1);
  if (reads == fails_after) return failed(ENODEV);
  const long along = reads++ % (2 * kReadsOneWay);
  const long way = kCountsPerRead * (along < kReadsOneWay ? along : 2 * kReadsOneWay - along);
  *data = (kCounterBegins + static_cast<lsampl_t>(way)) & kCounterMost;
  log_line(card, "count", static_cast<long>(*data));
  return 1;
}

int config(comedi_t* card, const char* what, unsigned value) {
  char words[40];
  std::snprintf(words, sizeof words, "config %s", what);
  log_line(card, words, static_cast<long>(value));
  return 0;
}

}  // namespace

extern "C" {

comedi_t* comedi_open(const char*) {
  auto* const card = new comedi_t_struct;
  if (const char* const log = std::getenv("FAKE_COMEDI_LOG"))
    card->log = ::open(log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  return card;
}
int comedi_close(comedi_t* card) {
  if (card->log >= 0) ::close(card->log);
  delete card;
  return 0;
}
int comedi_loglevel(int) {
  return 0;
}
int comedi_errno() {
  return errno;
}
const char* comedi_strerror(int number) {
  return std::strerror(number);
}
int comedi_fileno(comedi_t*) {
  return -1;
}
int comedi_get_version_code(comedi_t*) {
  return COMEDI_VERSION_CODE(0, 7, 76);
}
const char* comedi_get_driver_name(comedi_t*) {
  const char* const name = std::getenv("FAKE_COMEDI_DRIVER");
  return name != nullptr ? name : "fake";
}
const char* comedi_get_board_name(comedi_t*) {
  return "fake card";
}
int comedi_get_subdevice_type(comedi_t*, unsigned subdevice) {
  return subdevice < 4 && is(subdevice, kTypes[subdevice]) ? kTypes[subdevice] : COMEDI_SUBD_UNUSED;
}
int comedi_find_subdevice_by_type(comedi_t*, int type, unsigned first) {
  for (unsigned i = first; i < 4; ++i)
    if (is(i, type)) return static_cast<int>(i);
  return failed(ENOENT);
}
int comedi_get_subdevice_flags(comedi_t*, unsigned) {
  return SDF_CMD_READ;
}
int comedi_get_n_channels(comedi_t*, unsigned subdevice) {
  return kChannels[subdevice];
}
lsampl_t comedi_get_maxdata(comedi_t*, unsigned subdevice, unsigned) {
  return is(subdevice, COMEDI_SUBD_COUNTER) ? kCounterMost : kAnalogMost;
}
int comedi_get_n_ranges(comedi_t*, unsigned, unsigned) {
  return 2;
}
comedi_range* comedi_get_range(comedi_t*, unsigned, unsigned, unsigned range) {
  return &ranges[range];
}
int comedi_set_read_subdevice(comedi_t*, unsigned) {
  return 0;
}
int comedi_get_max_buffer_size(comedi_t*, unsigned) {
  return 1 << 16;
}
int comedi_set_buffer_size(comedi_t*, unsigned, unsigned size) {
  return static_cast<int>(size);
}
int comedi_get_cmd_generic_timed(comedi_t*, unsigned, comedi_cmd* command, unsigned, unsigned period_ns) {
  *command = {};
  command->scan_begin_src = TRIG_TIMER;
  command->scan_begin_arg = period_ns;
  return 0;
}
int comedi_command_test(comedi_t*, comedi_cmd*) {
  return 0;
}
int comedi_command(comedi_t*, comedi_cmd*) {
  return failed(EIO);
}
int comedi_cancel(comedi_t*, unsigned) {
  return 0;
}
int comedi_lock(comedi_t*, unsigned) {
  return setting("FAKE_COMEDI_LOCKED", 0) != 0 ? failed(EBUSY) : 0;
}

int comedi_data_read(comedi_t* card, unsigned subdevice, unsigned channel, unsigned, unsigned,
                     lsampl_t* data) {
  take_time();
  if (is(subdevice, COMEDI_SUBD_COUNTER)) return read_counter(card, data);
  *data = read_analog(channel);
  return 1;
}
int comedi_do_insnlist(comedi_t*, comedi_insnlist* list) {
  take_time();
  for (unsigned i = 0; i < list->n_insns; ++i)
    list->insns[i].data[0] = read_analog(CR_CHAN(list->insns[i].chanspec));
  return static_cast<int>(list->n_insns);
}
int comedi_data_write(comedi_t* card, unsigned subdevice, unsigned channel, unsigned, unsigned,
                      lsampl_t code) {
  take_time();
  if (!is(subdevice, COMEDI_SUBD_AO) || channel > 1 || code > kAnalogMost) return failed(EINVAL);
  held[channel] = code;
  log_line(card, "ao", static_cast<long>(code));
  return 1;
}
int comedi_dio_config(comedi_t* card, unsigned, unsigned line, unsigned direction) {
  return direction == COMEDI_OUTPUT ? config(card, "line", line) : failed(EINVAL);
}
int comedi_dio_write(comedi_t* card, unsigned, unsigned, unsigned level) {
  take_time();
  log_line(card, "dio", level);
  return 1;
}
int comedi_reset_channel(comedi_t* card, unsigned, unsigned channel) {
  return config(card, "reset", channel);
}
int comedi_set_gate_source(comedi_t* card, unsigned, unsigned, unsigned, unsigned source) {
  return config(card, "gate", source);
}
int comedi_set_other_source(comedi_t* card, unsigned, unsigned, unsigned, unsigned source) {
  return config(card, "source", source);
}
int comedi_set_counter_mode(comedi_t* card, unsigned, unsigned, unsigned mode) {
  return config(card, "mode", mode);
}
int comedi_arm_channel(comedi_t* card, unsigned, unsigned, unsigned source) {
  return config(card, "arm", source);
}

}  // extern "C"
