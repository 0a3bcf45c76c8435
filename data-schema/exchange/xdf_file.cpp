// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/exchange/xdf_file.hpp"

#include <fmt/format.h>
#include <pugixml.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>

#include <sys/stat.h>

namespace tacto::schema {
namespace {

static_assert(std::endian::native == std::endian::little, "XDF is little-endian");

constexpr std::string_view kXdf = "XDF:";
constexpr std::uint64_t kLargestXml = std::uint64_t{64} << 20;
constexpr std::size_t kBlockNumbers = 65536;

enum XdfTag : std::uint16_t {
  kFileHeader = 1,
  kStreamHeader = 2,
  kSamples = 3,
  kClockOffset = 4,
  kBoundary = 5,
  kStreamFooter = 6
};

constexpr std::array<unsigned char, 16> kBoundaryBytes = {0x43, 0xA5, 0x46, 0xDC, 0xCB, 0xF5, 0x41, 0x0F,
                                                          0xB3, 0x0E, 0xD5, 0x46, 0x73, 0x83, 0xCB, 0xE4};

template <class Number>
Number number_from(const char* raw) {
  Number number;
  std::memcpy(&number, raw, sizeof number);
  return number;
}

// A number of a sample; NaN for an integer that has no exact double.
template <class Number>
double number_at(const char* raw) {
  const auto number = number_from<Number>(raw);
  if constexpr (std::is_same_v<Number, std::int64_t>) {
    constexpr std::int64_t kLargestExact = std::int64_t{1} << 53;
    if (number > kLargestExact || number < -kLargestExact) return std::numeric_limits<double>::quiet_NaN();
  }
  return static_cast<double>(number);
}

struct NumberFormat {
  std::string_view name;
  std::size_t bytes;
  double (*number_at)(const char* raw);
};

constexpr NumberFormat kNumberFormats[] = {
    {"int8", 1, number_at<std::int8_t>},   {"int16", 2, number_at<std::int16_t>},
    {"int32", 4, number_at<std::int32_t>}, {"int64", 8, number_at<std::int64_t>},
    {"float32", 4, number_at<float>},      {"double64", 8, number_at<double>},
};

const NumberFormat* number_format(std::string_view name) {
  const auto* const found = std::ranges::find(kNumberFormats, name, &NumberFormat::name);
  return found == std::end(kNumberFormats) ? nullptr : found;
}

// The chunks of a file, one after the other. A chunk: [length of the length: 1, 4 or 8] [length] [tag]
// [content]; the length counts tag and content.
class XdfChunks {
 public:
  static Result<XdfChunks> open(const std::string& path) {
    XdfChunks chunks;
    chunks.path_ = path;
    chunks.file_.reset(std::fopen(path.c_str(), "rbe"));
    struct stat status {};
    if (chunks.file_ == nullptr || fstat(fileno(chunks.file_.get()), &status) != 0 ||
        !S_ISREG(status.st_mode))
      return fail(ErrorKind::not_found, "cannot be opened", path);
    chunks.size_ = static_cast<std::uint64_t>(status.st_size);
    char magic[kXdf.size()];
    if (chunks.size_ < sizeof magic || !chunks.read(magic, sizeof magic) ||
        std::string_view(magic, sizeof magic) != kXdf)
      return fail(ErrorKind::malformed, "is no XDF file", path);
    chunks.end_ = chunks.at_;
    return chunks;
  }

  // Moves to the next chunk; false at the end of the file, or where it was cut.
  Result<bool> next() {
    if (at_ != end_ && fseeko(file_.get(), static_cast<off_t>(end_), SEEK_SET) != 0)
      return fail(ErrorKind::not_found, "cannot be read", path_);
    at_ = end_;
    const std::uint64_t begin = at_;
    const auto cut_here = [&] {
      cut_ = fmt::format("ends inside chunk {}: its last {} bytes, from byte {} on, are not read", number_,
                         size_ - begin, begin);
      return false;
    };
    if (at_ == size_) return false;
    ++number_;
    char width = 0;
    TACTO_TRY(read(&width, 1));
    if (width != 1 && width != 4 && width != 8)
      return broken(fmt::format("the length of a chunk has 1, 4 or 8 bytes, not {}", int{width}));
    if (size_ - at_ < static_cast<std::uint64_t>(width)) return cut_here();
    char raw[8] = {};
    TACTO_TRY(read(raw, static_cast<std::uint64_t>(width)));
    const auto length = number_from<std::uint64_t>(raw);
    if (length < sizeof tag_) return broken(fmt::format("a chunk cannot have {} bytes", length));
    if (size_ - at_ < length) return cut_here();
    end_ = at_ + length;
    const auto tag = take<std::uint16_t>();
    TACTO_TRY(tag);
    tag_ = *tag;
    return true;
  }

  std::uint16_t tag() const { return tag_; }
  std::uint64_t left() const { return end_ - at_; }  // bytes of the chunk
  double fraction() const { return static_cast<double>(at_) / static_cast<double>(size_); }
  const std::string& cut() const { return cut_; }

  // The next bytes of the chunk.
  Result<void> take(char* bytes, std::uint64_t count) {
    if (count > left())
      return broken(fmt::format("the chunk ends {} bytes too early for its content", count - left()));
    return read(bytes, count);
  }

  template <class Number>
  Result<Number> take() {
    char raw[sizeof(Number)];
    TACTO_TRY(take(raw, sizeof raw));
    return number_from<Number>(raw);
  }
  Result<std::uint64_t> take_length() {
    const auto width = take<std::uint8_t>();
    TACTO_TRY(width);
    if (*width != 1 && *width != 4 && *width != 8)
      return broken(fmt::format("a length has 1, 4 or 8 bytes, not {}", *width));
    char raw[8] = {};
    TACTO_TRY(take(raw, *width));
    return number_from<std::uint64_t>(raw);
  }

  Result<std::string> take_xml() {
    if (left() > kLargestXml) return broken(fmt::format("a header of {} bytes is not read", left()));
    std::string text(left(), '\0');
    TACTO_TRY(take(text.data(), text.size()));
    return text;
  }

  tl::unexpected<Error> broken(std::string what) const {
    return fail(ErrorKind::malformed, std::move(what),
                fmt::format("{}: chunk {}, byte {}", path_, number_, at_),
                "the file is damaged: copy it again from the recording computer");
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  Result<void> read(char* bytes, std::uint64_t count) {
    if (std::fread(bytes, 1, count, file_.get()) != count)
      return fail(ErrorKind::not_found, "cannot be read to its end", path_, "is the disk in order?");
    at_ += count;
    return {};
  }

  std::unique_ptr<std::FILE, Close> file_;
  std::string path_, cut_;
  std::uint64_t size_ = 0, at_ = 0, end_ = 0;  // bytes: of the file, read so far, at the chunk's end
  std::uint64_t number_ = 0;                   // of the chunk, from 1
  std::uint16_t tag_ = 0;
};

template <class Number>
std::optional<Number> number_in(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return std::nullopt;
  text = text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

Result<pugi::xml_node> info_of(XdfChunks& chunks, pugi::xml_document& document) {
  const auto text = chunks.take_xml();
  TACTO_TRY(text);
  const auto read = document.load_buffer(text->data(), text->size());
  const pugi::xml_node info = document.child("info");
  if (!read || !info) return chunks.broken("its XML cannot be read");
  return info;
}

Result<void> check_version(XdfChunks& chunks, const std::string& path) {
  pugi::xml_document document;
  const auto info = info_of(chunks, document);
  TACTO_TRY(info);
  const std::string version = info->child_value("version");
  if (version.starts_with("1.")) return {};
  return fail(ErrorKind::unsuitable, fmt::format("has version '{}'; version 1.0 is read", version), path);
}

void add_labels(XdfStream& stream, const pugi::xml_node& info) {
  for (const pugi::xml_node& channel : info.child("desc").child("channels").children("channel")) {
    if (stream.labels.size() == stream.channels) break;
    stream.labels.emplace_back(channel.child_value("label"));
    stream.units.emplace_back(channel.child_value("unit"));
  }
  stream.labels.resize(stream.channels);
  stream.units.resize(stream.channels);
  for (std::size_t k = 0; k < stream.channels; ++k)
    if (stream.labels[k].empty()) stream.labels[k] = fmt::format("ch{}", k + 1);
}

Result<void> add_stream(XdfChunks& chunks, XdfStream& stream) {
  pugi::xml_document document;
  const auto info = info_of(chunks, document);
  TACTO_TRY(info);
  stream.name = info->child_value("name");
  stream.type = info->child_value("type");
  stream.format = info->child_value("channel_format");
  const auto channels = number_in<std::uint64_t>(info->child_value("channel_count"));
  const auto rate_hz = number_in<double>(info->child_value("nominal_srate"));
  if (channels && *channels <= kMostXdfChannels) stream.channels = *channels;
  if (stream.is_text())
    stream.refusal = "is text, which becomes marks of the recording of another stream";
  else if (stream.format != "string" && number_format(stream.format) == nullptr)
    stream.refusal = fmt::format("has the unknown format '{}'", stream.format);
  else if (!channels || *channels == 0)
    stream.refusal = "has a channel_count that is not a whole number above 0";
  else if (*channels > kMostXdfChannels)
    stream.refusal = fmt::format("has {} channels; at most {} are read", *channels, kMostXdfChannels);
  else if (!rate_hz || !(*rate_hz >= 0) || std::isinf(*rate_hz))
    stream.refusal = "has a nominal_srate that is not a rate in Hz, or 0";
  if (rate_hz && std::isfinite(*rate_hz)) stream.nominal_rate_hz = *rate_hz;
  add_labels(stream, *info);
  return {};
}

// Counts the samples of a chunk; read_xdf() reads them.
Result<void> count_samples(XdfChunks& chunks, XdfStream& stream) {
  const auto count = chunks.take_length();
  TACTO_TRY(count);
  const NumberFormat* const format = number_format(stream.format);
  const std::uint64_t least = 1 + stream.channels * (format == nullptr ? 1 : format->bytes);
  if (*count > chunks.left() / least)
    return chunks.broken(fmt::format("{} samples do not fit into {} bytes", *count, chunks.left()));
  stream.samples += *count;
  return {};
}

Result<void> add_clock_offset(XdfChunks& chunks, XdfStream& stream) {
  const auto time_s = chunks.take<double>();
  TACTO_TRY(time_s);
  const auto ahead_s = chunks.take<double>();
  TACTO_TRY(ahead_s);
  if (!std::isfinite(*time_s) || !std::isfinite(*ahead_s))
    return chunks.broken("a clock offset is not finite");
  stream.clock_offsets.push_back({*time_s, *ahead_s});
  return {};
}

Result<void> add_footer(XdfChunks& chunks, XdfStream& stream) {
  pugi::xml_document document;
  const auto info = info_of(chunks, document);
  TACTO_TRY(info);
  stream.stated_samples = number_in<std::uint64_t>(info->child_value("sample_count"));
  return {};
}

Result<void> check_boundary(XdfChunks& chunks) {
  std::array<unsigned char, kBoundaryBytes.size()> bytes{};
  TACTO_TRY(chunks.take(reinterpret_cast<char*>(bytes.data()), bytes.size()));
  return bytes == kBoundaryBytes ? Result<void>{} : chunks.broken("a boundary has other bytes than XDF's");
}

Result<void> add_chunk(XdfChunks& chunks, XdfContents& contents, const std::string& path) {
  const std::uint16_t tag = chunks.tag();
  if (tag == kFileHeader) return check_version(chunks, path);
  if (tag == kBoundary) return check_boundary(chunks);
  if (tag != kStreamHeader && tag != kSamples && tag != kClockOffset && tag != kStreamFooter) return {};
  const auto id = chunks.take<std::uint32_t>();
  TACTO_TRY(id);
  const auto stream = std::ranges::find(contents.streams, *id, &XdfStream::id);
  const bool known = stream != contents.streams.end();
  if (tag == kStreamHeader) {
    if (known) return chunks.broken(fmt::format("the stream {} has two headers", *id));
    contents.streams.emplace_back().id = *id;
    return add_stream(chunks, contents.streams.back());
  }
  if (!known) return chunks.broken(fmt::format("the stream {} has no header before this", *id));
  if (tag == kSamples) return count_samples(chunks, *stream);
  return tag == kClockOffset ? add_clock_offset(chunks, *stream) : add_footer(chunks, *stream);
}

// The times of consecutive samples of a stream.
class XdfTimes {
 public:
  explicit XdfTimes(const XdfStream& stream) : stream_(stream) {}

  // Periods are counted from the last stated time: their sum would round at each sample.
  Result<double> next(XdfChunks& chunks) {
    const auto width = chunks.take<std::uint8_t>();
    TACTO_TRY(width);
    if (*width == sizeof(double)) {
      const auto stamp_s = chunks.take<double>();
      TACTO_TRY(stamp_s);
      if (!std::isfinite(*stamp_s))
        return chunks.broken(fmt::format("the time of sample {} is not finite", done_));
      stamp_s_ = *stamp_s, after_stamp_ = 0, ++done_;
      return stamp_s_;
    }
    if (*width != 0) return chunks.broken(fmt::format("a time has 0 or 8 bytes, not {}", *width));
    if (done_ == 0 || !(stream_.nominal_rate_hz > 0))
      return chunks.broken(fmt::format("sample {} of the stream '{}' has no time", done_, stream_.name));
    ++done_;
    return stamp_s_ + ++after_stamp_ / stream_.nominal_rate_hz;
  }
  std::uint64_t done() const { return done_; }

 private:
  const XdfStream& stream_;
  std::uint64_t done_ = 0;
  double stamp_s_ = 0, after_stamp_ = 0;  // the last stated time, and the samples since
};

// The samples of one stream, passed on in blocks.
class XdfSamples {
 public:
  XdfSamples(const std::string& path, const XdfStream& stream, const NumberFormat& format,
             std::span<const std::size_t> channels, const XdfHandler& take)
      : path_(path),
        stream_(stream),
        format_(format),
        channels_(channels),
        take_(take),
        raw_(stream.channels * format.bytes),
        sample_times_(stream) {}

  Result<void> read(XdfChunks& chunks) {
    const auto count = chunks.take_length();
    TACTO_TRY(count);
    for (std::uint64_t i = 0; i < *count; ++i) {
      const auto time_s = sample_times_.next(chunks);
      TACTO_TRY(time_s);
      times_s_.push_back(*time_s);
      TACTO_TRY(chunks.take(raw_.data(), raw_.size()));
      TACTO_TRY(add_numbers());
      if (times_s_.size() + numbers_.size() >= kBlockNumbers) TACTO_TRY(pass_on());
    }
    if (chunks.left() > 0)
      return chunks.broken(fmt::format("the chunk has {} bytes more than its samples", chunks.left()));
    return {};
  }

  Result<void> pass_on() {
    if (times_s_.empty()) return {};
    TACTO_TRY(take_(times_s_, numbers_));
    times_s_.clear();
    numbers_.clear();
    return {};
  }

 private:
  Result<void> add_numbers() {
    for (const std::size_t k : channels_) {
      const char* const at = raw_.data() + k * format_.bytes;
      numbers_.push_back(format_.number_at(at));
      if (std::isnan(numbers_.back()) && format_.name == "int64")
        return fail(ErrorKind::unsuitable,
                    fmt::format("{} is beyond 2^53 and has no exact double", number_from<std::int64_t>(at)),
                    fmt::format("{}: stream '{}', channel '{}', sample {}", path_, stream_.name,
                                stream_.labels[k], sample_times_.done() - 1),
                    "let the sending program subtract an offset");
    }
    return {};
  }

  const std::string& path_;
  const XdfStream& stream_;
  const NumberFormat& format_;
  std::span<const std::size_t> channels_;
  const XdfHandler& take_;
  std::vector<char> raw_;  // of one sample
  std::vector<double> times_s_, numbers_;
  XdfTimes sample_times_;
};

Result<std::string> text_of(XdfChunks& chunks) {
  const auto length = chunks.take_length();
  TACTO_TRY(length);
  if (*length > chunks.left())
    return chunks.broken(fmt::format("a text of {} bytes does not fit into {}", *length, chunks.left()));
  std::string text(*length, '\0');
  TACTO_TRY(chunks.take(text.data(), text.size()));
  return text;
}

Result<void> read_markers(XdfChunks& chunks, const XdfStream& stream, XdfTimes& times,
                          std::vector<XdfMarker>& markers) {
  const auto count = chunks.take_length();
  TACTO_TRY(count);
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto time_s = times.next(chunks);
    TACTO_TRY(time_s);
    XdfMarker marker{*time_s, {}};
    for (std::size_t k = 0; k < stream.channels; ++k) {
      const auto text = text_of(chunks);
      TACTO_TRY(text);
      marker.label += (k == 0 ? "" : " ") + *text;
    }
    markers.push_back(std::move(marker));
  }
  if (chunks.left() > 0)
    return chunks.broken(fmt::format("the chunk has {} bytes more than its samples", chunks.left()));
  return {};
}

// Calls `take` for each chunk of samples of a stream, behind its number.
template <class Take>
Result<void> each_chunk(const std::string& path, const XdfStream& stream, Take take) {
  auto chunks = XdfChunks::open(path);
  TACTO_TRY(chunks);
  for (;;) {
    const auto more = chunks->next();
    TACTO_TRY(more);
    if (!*more) return {};
    if (chunks->tag() != kSamples) continue;
    const auto id = chunks->take<std::uint32_t>();
    TACTO_TRY(id);
    if (*id == stream.id) TACTO_TRY(take(*chunks));
  }
}

}  // namespace

bool is_xdf(std::string_view beginning) {
  return beginning.starts_with(kXdf);
}

Result<XdfContents> xdf_contents(const std::string& path) {
  auto chunks = XdfChunks::open(path);
  TACTO_TRY(chunks);
  XdfContents contents;
  for (;;) {
    const auto more = chunks->next();
    TACTO_TRY(more);
    if (!*more) break;
    TACTO_TRY(add_chunk(*chunks, contents, path));
  }
  contents.cut = chunks->cut();
  if (contents.streams.empty())
    return fail(ErrorKind::malformed, "has no stream", path,
                contents.cut.empty()
                    ? "it was recorded without a stream: select the streams in the recorder and record again"
                    : "it was cut: copy it again from the recording computer");
  return contents;
}

Result<void> read_xdf(const std::string& path, const XdfStream& stream, std::span<const std::size_t> channels,
                      const XdfHandler& take, const std::function<void(double)>& progress) {
  const NumberFormat* const format = number_format(stream.format);
  if (format == nullptr || !stream.refusal.empty())
    return fail(ErrorKind::unsuitable, stream.refusal, fmt::format("{}: stream '{}'", path, stream.name));
  XdfSamples samples(path, stream, *format, channels, take);
  const auto pass = [&](XdfChunks& chunks) -> Result<void> {
    TACTO_TRY(samples.read(chunks));
    progress(chunks.fraction());
    return {};
  };
  TACTO_TRY(each_chunk(path, stream, pass));
  return samples.pass_on();
}

Result<std::vector<XdfMarker>> read_xdf_markers(const std::string& path, const XdfStream& stream) {
  std::vector<XdfMarker> markers;
  XdfTimes times(stream);
  std::size_t bytes = 0, counted = 0;
  const auto add = [&](XdfChunks& chunks) -> Result<void> {
    TACTO_TRY(read_markers(chunks, stream, times, markers));
    for (; counted < markers.size(); ++counted) bytes += sizeof(XdfMarker) + markers[counted].label.size();
    if (bytes <= kMostXdfMarkerBytes) return {};
    return fail(ErrorKind::unsuitable, fmt::format("has more than {} MiB of text", kMostXdfMarkerBytes >> 20),
                fmt::format("{}: stream '{}'", path, stream.name));
  };
  TACTO_TRY(each_chunk(path, stream, add));
  return markers;
}

}  // namespace tacto::schema
