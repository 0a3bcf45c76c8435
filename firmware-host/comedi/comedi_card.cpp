// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/comedi/comedi_card.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "data-schema/base/quantity.hpp"
#include "firmware-host/comedi/ni_x_series.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

std::string in_volts(double from_v, double to_v) {
  return fmt::format("{:g} to {:g} V", from_v, to_v);
}

schema::Channel channel_of(const schema::WiredInput& input, double code_v, unsigned shift) {
  const double per_volt = input.per_volt.value_or(1);
  schema::Channel channel;
  channel.name = input.name;
  channel.quantity = input.quantity;
  channel.unit = input.per_volt
                     ? std::string(schema::si_symbol(schema::quantity_named(input.quantity)->dimension))
                     : "V";
  const double step_v = code_v / std::ldexp(1.0, static_cast<int>(shift));
  channel.scale = per_volt * step_v;
  channel.offset = per_volt * (input.range_from_v + std::ldexp(step_v, 31)) + input.at_zero_volt;
  const double ends[] = {per_volt * input.range_from_v + input.at_zero_volt,
                         per_volt * input.range_to_v + input.at_zero_volt};
  channel.range_min = std::min(ends[0], ends[1]);
  channel.range_max = std::max(ends[0], ends[1]);
  channel.source = fmt::format("input {}, {}, {}", input.input, input.reference,
                               in_volts(input.range_from_v, input.range_to_v));
  return channel;
}

unsigned reference_of(const std::string& name) {
  return name == "differential" ? AREF_DIFF : name == "common" ? AREF_COMMON : AREF_GROUND;
}

}  // namespace

Result<schema::Wiring> read_comedi_wiring(const std::string& uri, std::string_view parameters) {
  if (parameters.empty())
    return fail(ErrorKind::usage, "names no wiring", uri,
                "give for example comedi:bench, with bench.wiring.json");
  return schema::read_wiring(std::string(parameters));
}

Result<ComediCard> open_comedi_card(const schema::Wiring& wiring) {
  comedi_loglevel(0);  // otherwise the library prints errors itself
  errno = 0;
  ComediCard card(comedi_open(wiring.card.c_str()));
  if (card) return card;
  const int why = errno;
  if (why == EACCES || why == EPERM)
    return fail(ErrorKind::not_found, "this user may not open the card", wiring.card,
                "add the user to the group of the file ('iocard' in Debian), then log in again");
  const std::string closed = fmt::format("no card can be opened: {}", std::strerror(why));
  if (const auto without_driver = ni_x_series_cards(); !without_driver.empty())
    return fail(ErrorKind::not_found,
                fmt::format("{}; comedi has no driver for NI's X series: {}", closed,
                            fmt::join(without_driver, ", ")),
                wiring.card, "use a card of NI's M or E series, or of another maker");
  return fail(ErrorKind::not_found, closed, wiring.card,
              "load the card's comedi driver with modprobe, or correct 'card' in the wiring");
}

std::string comedi_version(comedi_t* card) {
  const int version = comedi_get_version_code(card);
  return fmt::format("{}.{}.{}", version >> 16, (version >> 8) & 255, version & 255);
}

Capabilities described(comedi_t* card, const schema::Wiring& wiring, const std::string& uri) {
  Capabilities about;
  about.uri = uri;
  about.name = fmt::format("{} at {}", comedi_get_board_name(card), wiring.card);
  about.serial = wiring.name;
  about.firmware = fmt::format("comedi {}, driver {}", comedi_version(card), comedi_get_driver_name(card));
  about.transducer = wiring.transducer;
  return about;
}

Result<unsigned> comedi_range_of(comedi_t* card, const schema::Wiring& wiring, unsigned subdevice,
                                 unsigned channel, double from_v, double to_v, const std::string& what) {
  std::vector<std::string> known;
  const int ranges = comedi_get_n_ranges(card, subdevice, channel);
  for (int i = 0; i < ranges; ++i) {
    const comedi_range* const range = comedi_get_range(card, subdevice, channel, static_cast<unsigned>(i));
    if (range == nullptr || range->unit != UNIT_volt) continue;
    if (range->min == from_v && range->max == to_v) return static_cast<unsigned>(i);
    known.push_back(in_volts(range->min, range->max));
  }
  return fail(ErrorKind::unsuitable, fmt::format("{} has no range {}", what, in_volts(from_v, to_v)),
              wiring.card, fmt::format("its ranges are: {}", fmt::join(known, ", ")));
}

Result<unsigned> find_comedi_channel(comedi_t* card, const schema::Wiring& wiring,
                                     std::initializer_list<int> types, std::optional<unsigned> asked,
                                     unsigned channel, const std::string& what) {
  int found = -1;
  for (const int type : types) {
    if (found >= 0) break;
    if (!asked) found = comedi_find_subdevice_by_type(card, type, 0);
    if (asked && comedi_get_subdevice_type(card, *asked) == type) found = static_cast<int>(*asked);
  }
  if (found < 0)
    return fail(ErrorKind::unsuitable,
                asked ? fmt::format("subdevice {} of the card has no {}", *asked, what)
                      : fmt::format("the card has no {}", what),
                wiring.card, "correct the wiring, or use another card");
  const int count = comedi_get_n_channels(card, static_cast<unsigned>(found));
  if (std::cmp_less(channel, count)) return static_cast<unsigned>(found);
  return fail(ErrorKind::unsuitable, fmt::format("the card has no {} {}", what, channel), wiring.card,
              fmt::format("they are numbered 0 to {}", count - 1));
}

Result<ComediInput> find_comedi_input(comedi_t* card, const schema::Wiring& wiring, unsigned subdevice,
                                      const schema::WiredInput& input) {
  TACTO_TRY(find_comedi_channel(card, wiring, {COMEDI_SUBD_AI}, subdevice, input.input, "analog input"));
  const auto range = comedi_range_of(card, wiring, subdevice, input.input, input.range_from_v,
                                     input.range_to_v, fmt::format("input {}", input.input));
  TACTO_TRY(range);
  const lsampl_t most = comedi_get_maxdata(card, subdevice, input.input);
  if (most == 0 || !std::has_single_bit(std::uint64_t{most} + 1))
    return fail(ErrorKind::unsuitable, fmt::format("codes of input {} end at {}", input.input, most),
                wiring.card, "a converter whose codes have no whole number of bits is not supported");
  ComediInput found;
  found.shift = static_cast<unsigned>(std::countl_zero(std::uint32_t{most}));
  found.packed = CR_PACK(input.input, *range, reference_of(input.reference));
  found.code_v = (input.range_to_v - input.range_from_v) / most;
  found.channel = channel_of(input, found.code_v, found.shift);
  return found;
}

}  // namespace tacto::firmware_host
