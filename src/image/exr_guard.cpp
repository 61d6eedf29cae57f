// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The layout of an EXR file: "OpenEXR File Layout" (openexr.com). The library bounds sizes only through
// settings that are global to a process, which belong to the program that uses us; hence this walk over the
// headers.
#include "image/exr_guard.h"

#include <fmt/format.h>
#include <gloam/error.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "image/limits.h"

namespace gloam {
namespace {

constexpr std::uint32_t kTiledFlag = 0x200, kDeepFlag = 0x800, kMultiPartFlag = 0x1000;

/// Bytes of one attribute, little endian.
class Cursor {
 public:
  Cursor(const std::vector<char>& bytes, std::string place) : bytes_(bytes), place_(std::move(place)) {}
  std::size_t left() const { return bytes_.size() - at_; }
  template <typename T>
  T number() {
    T value;
    need(sizeof value);
    std::memcpy(&value, &bytes_[at_], sizeof value);
    at_ += sizeof value;
    return value;
  }
  void skip(std::uint64_t count) {
    need(count);
    at_ += count;
  }
  std::string text() {
    const auto end = std::find(bytes_.begin() + std::ptrdiff_t(at_), bytes_.end(), '\0');
    if (end == bytes_.end()) throw Error(place_, "a text has no end");
    std::string result(bytes_.begin() + std::ptrdiff_t(at_), end);
    at_ += result.size() + 1;
    return result;
  }

 private:
  void need(std::uint64_t count) const {
    if (count > left())
      throw Error(place_, fmt::format("{} more bytes were expected, {} are left", count, left()));
  }
  const std::vector<char>& bytes_;
  std::string place_;
  std::size_t at_ = 0;
};

class Walker {
 public:
  Walker(std::istream& stream, std::uint64_t file_bytes, const std::string& place)
      : stream_(stream), left_(file_bytes), file_bytes_(file_bytes), place_(place) {}
  std::vector<ExrPart> parts();

 private:
  void read(void* bytes, std::uint64_t count) {
    if (count > left_) throw Error(place_, "the file ends inside its header");
    stream_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(count));
    if (!stream_) throw Error(place_, "the header cannot be read");
    left_ -= count;
  }
  std::string name();
  bool readHeader(ExrPart& part);
  void readAttribute(const std::string& name, const std::string& type, Cursor cursor, ExrPart& part) const;
  void checkNested(const std::string& type, Cursor cursor, const std::string& place) const;
  void checkPart(const ExrPart& part, const std::string& place) const;

  std::istream& stream_;
  std::uint64_t left_;
  const std::uint64_t file_bytes_;
  const std::string& place_;
};

std::string Walker::name() {
  constexpr std::size_t kMaxName = 255;
  std::string result;
  for (char c = 0;; result += c) {
    read(&c, 1);
    if (c == '\0') return result;
    if (result.size() >= kMaxName) throw Error(place_, "a name in the header is longer than 255 bytes");
  }
}

// Attributes whose inner sizes the library would believe.
void Walker::checkNested(const std::string& type, Cursor cursor, const std::string& place) const {
  if (type == "preview") {
    const std::uint64_t width = cursor.number<std::uint32_t>(), height = cursor.number<std::uint32_t>();
    if (width * height > cursor.left() / 4)
      throw Error(place, fmt::format("a preview of {} x {} does not fit into {} bytes", width, height,
                                     cursor.left()));
  } else if (type == "stringvector") {
    while (cursor.left() > 0) cursor.skip(cursor.number<std::uint32_t>());
  } else if (type == "idmanifest") {
    const std::uint64_t unpacked = cursor.number<std::uint32_t>();
    if (unpacked > 1100 * std::uint64_t(cursor.left() + 64))
      throw Error(place, fmt::format("{} bytes cannot unpack to {}", cursor.left(), unpacked));
  }
}

void Walker::readAttribute(const std::string& name, const std::string& type, Cursor cursor,
                           ExrPart& part) const {
  if (name == "channels" && type == "chlist") {
    part.channels.clear();
    for (std::string channel = cursor.text(); !channel.empty(); channel = cursor.text()) {
      ExrChannel& added = part.channels.emplace_back();
      added.name = channel;
      added.type = cursor.number<std::int32_t>();
      cursor.skip(4);  // whether it is perceptually linear, reserved
      added.x_sampling = cursor.number<std::int32_t>();
      added.y_sampling = cursor.number<std::int32_t>();
      if (added.type < 0 || added.type > 2 || added.x_sampling < 1 || added.y_sampling < 1)
        throw Error(place_ + ": channel " + oneLine(channel),
                    fmt::format("type {} with sampling {}, {} is not known", added.type, added.x_sampling,
                                added.y_sampling));
    }
  } else if ((name == "dataWindow" || name == "displayWindow") && type == "box2i") {
    ExrWindow& window = name == "dataWindow" ? part.data : part.display;
    for (std::int32_t* corner : {&window.min_x, &window.min_y, &window.max_x, &window.max_y})
      *corner = cursor.number<std::int32_t>();
  } else if (name == "compression" && type == "compression") {
    part.compression = cursor.number<std::uint8_t>();
  } else if (name == "tiles" && type == "tiledesc") {
    part.has_tiles = true;
    part.tile_width = cursor.number<std::uint32_t>();
    part.tile_height = cursor.number<std::uint32_t>();
  } else if (name == "type" && type == "string") {
    part.type.resize(std::min<std::size_t>(cursor.left(), 64));
    for (char& c : part.type) c = cursor.number<char>();
  }
}

// False for the empty header that ends the list of a file of several parts.
bool Walker::readHeader(ExrPart& part) {
  for (int count = 0;; ++count) {
    const std::string attribute = name();
    if (attribute.empty()) return count > 0;
    const std::string type = name();
    const std::string place = place_ + ": attribute " + oneLine(attribute);
    std::int32_t size = 0;
    read(&size, 4);
    if (size < 0 || std::uint64_t(size) > left_)
      throw Error(place, fmt::format("{} bytes were claimed, {} are left in the file", size, left_));
    std::vector<char> bytes(static_cast<std::size_t>(size));
    read(bytes.data(), bytes.size());
    const Cursor cursor(bytes, place);
    checkNested(type, cursor, place);
    readAttribute(attribute, type, cursor, part);
  }
}

// How many bytes of pixels one byte of the file can hold, by the coding's best case.
double bytesPerByte(int compression) {
  // none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB: run lengths of 128 in 2 bytes; zlib 1032 to 1;
  // Huffman runs of 16-bit words; 4 x 4 halfs in 3 bytes; one zlib-packed value for a block of 8 x 8.
  constexpr std::array<double, 10> kBest{1.0,    64.0, 1100.0, 1100.0,  1100.0,
                                         2200.0, 16.0, 16.0,   65536.0, 65536.0};
  return compression >= 0 && compression < int(kBest.size()) ? kBest[std::size_t(compression)] : 0.0;
}

void Walker::checkPart(const ExrPart& part, const std::string& place) const {
  constexpr std::int64_t kMaxSide = 1 << 17;
  constexpr std::size_t kMaxChannels = 1024;
  if (part.channels.empty()) throw Error(place, "attribute channels is missing or empty");
  if (part.channels.size() > kMaxChannels)
    throw Error(place, fmt::format("{} channels; at most {} are read", part.channels.size(), kMaxChannels));
  if (part.compression < 0) throw Error(place, "attribute compression is missing");
  if (bytesPerByte(part.compression) == 0.0)
    throw Error(place, fmt::format("compression {} is not known", part.compression));
  for (const ExrWindow* window : {&part.data, &part.display}) {
    const char* name = window == &part.data ? "dataWindow" : "displayWindow";
    checkPictureSize(place + ": " + name, window->width(), window->height(), file_bytes_, 1e12);
    if (std::max(window->width(), window->height()) > kMaxSide)
      throw Error(place, fmt::format("{} {} x {}: sides of at most {} are read", name, window->width(),
                                     window->height(), kMaxSide));
  }
  double bytes_a_pixel = 0.0;
  for (const ExrChannel& channel : part.channels)
    bytes_a_pixel += (channel.type == 1 ? 2.0 : 4.0) / (double(channel.x_sampling) * channel.y_sampling);
  if (!part.deep)
    checkPictureSize(place + ": dataWindow", part.data.width(), part.data.height(), file_bytes_,
                     bytesPerByte(part.compression) / bytes_a_pixel);
  // The table of chunks has 8 bytes for each; a chunk is a tile, or 1 to 256 scanlines.
  double chunks = double(part.data.height()) / 256.0;
  if (part.has_tiles) {
    constexpr std::uint32_t kMaxTile = 1 << 13;
    if (part.tile_width < 1 || part.tile_height < 1 || part.tile_width > kMaxTile ||
        part.tile_height > kMaxTile)
      throw Error(place, fmt::format("tiles of {} x {}: 1 to {} were expected", part.tile_width,
                                     part.tile_height, kMaxTile));
    chunks =
        double(part.data.width()) * double(part.data.height()) / (double(part.tile_width) * part.tile_height);
  }
  if (chunks * 8.0 > double(file_bytes_))
    throw Error(
        place, fmt::format("{:.0f} tiles or blocks do not fit into a file of {} bytes", chunks, file_bytes_));
}

std::vector<ExrPart> Walker::parts() {
  std::uint32_t start[2] = {};
  read(start, sizeof start);
  constexpr std::uint32_t kMagic = 20000630;
  if (start[0] != kMagic) throw Error(place_, "not an OpenEXR file");
  const std::uint32_t flags = start[1];
  if ((flags & 0xff) != 1 && (flags & 0xff) != 2)
    throw Error(place_, fmt::format("OpenEXR version 1 or 2 was expected, not {}", flags & 0xff));
  const bool several = (flags & kMultiPartFlag) != 0;
  std::vector<ExrPart> parts;
  while (true) {
    ExrPart part;
    if (!readHeader(part)) break;
    part.deep = part.type.compare(0, 4, "deep") == 0 || (!several && (flags & kDeepFlag) != 0);
    // A scanline part may carry a tile description that means nothing; a part that says nothing goes by the
    // flag.
    const bool tiled =
        part.type.empty() ? (flags & kTiledFlag) != 0 : part.type.find("tile") != std::string::npos;
    if (tiled && !part.has_tiles) throw Error(place_, "attribute tiles is missing");
    checkPart(part, several ? fmt::format("{}: part {}", place_, parts.size()) : place_);
    parts.push_back(std::move(part));
    if (!several) break;
  }
  if (parts.empty()) throw Error(place_, "the file holds no picture");
  return parts;
}

}  // namespace

std::vector<ExrPart> checkExrHeaders(std::istream& stream, std::uint64_t file_bytes,
                                     const std::string& place) {
  return Walker(stream, file_bytes, place).parts();
}

}  // namespace gloam
