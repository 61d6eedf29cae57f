// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Radiance pictures. Ward, "Real Pixels", Graphics Gems II, 1991; the file format as in Radiance's "File
// Formats" (filefmts.pdf): header variables, resolution string, flat, old and new run lengths.
//
// This reader is our own because no packaged library reads every form: stb_image and OpenCV know neither old
// run lengths, XYZE, most orientations nor EXPOSURE; FreeImage and ImageMagick lack orientations. A mantissa
// m and exponent e mean m * 2^(e - 136), as everyone but Radiance itself reads them (it adds 0.5 to m, which
// would turn a map of ones into 1.004).
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <sstream>

#include "image/color.h"
#include "image/formats.h"
#include "image/limits.h"

namespace gloam {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

struct Header {
  glm::vec3 radiance_from_stored{1.0f};  ///< EXPOSURE and COLORCORR, undone
  glm::mat3 rec709_from_stored{1.0f};
  bool xyz = false;
  int width = 0, height = 0;
  bool columns = false;                 ///< scanlines run down or up instead of across
  bool flip_x = false, flip_y = false;  ///< stored right to left, bottom to top
};

class Reader {
 public:
  Reader(const std::vector<std::uint8_t>& bytes, const std::string& place) : bytes_(bytes), place_(place) {}

  Header readHeader();
  /// One scanline in the file's order. `where` names it in errors.
  void readScanline(std::vector<Rgbe>& line, int index, int count);

 private:
  [[noreturn]] void fail(const std::string& message) const { throw Error(place_, message); }
  [[noreturn]] void failAt(const std::string& message) const { throw Error(scanline_, message); }
  std::size_t left() const { return bytes_.size() - at_; }
  std::uint8_t next() {
    if (at_ >= bytes_.size()) failAt("the file ends");
    return bytes_[at_++];
  }
  std::string headerLine(const char* what);
  void readVariable(const std::string& line, Header& header);
  std::vector<double> numbers(const std::string& line, std::size_t expected);
  void readResolution(Header& header);
  void readNewRuns(std::vector<Rgbe>& line);
  void readFlatOrOldRuns(std::vector<Rgbe>& line);

  const std::vector<std::uint8_t>& bytes_;
  const std::string& place_;
  std::string scanline_;
  std::size_t at_ = 0;
};

std::string Reader::headerLine(const char* what) {
  constexpr std::size_t kMaxLine = 1 << 16;
  std::string line;
  while (true) {
    if (at_ >= bytes_.size()) fail(fmt::format("the file ends before {}", what));
    const char c = static_cast<char>(bytes_[at_++]);
    if (c == '\n') break;
    if (line.size() >= kMaxLine) fail("the header has a line of more than 65536 bytes");
    line += c;
  }
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

std::vector<double> Reader::numbers(const std::string& line, std::size_t expected) {
  const std::size_t equals = line.find('=');
  std::istringstream text(line.substr(equals + 1));
  text.imbue(std::locale::classic());
  std::vector<double> values(expected);
  for (double& value : values)
    if (!(text >> value) || !std::isfinite(value))
      fail(fmt::format("{}: {} numbers were expected, not '{}'", line.substr(0, equals), expected,
                       oneLine(line.substr(equals + 1))));
  return values;
}

void Reader::readVariable(const std::string& line, Header& header) {
  const auto is = [&](const char* name) { return line.compare(0, std::strlen(name), name) == 0; };
  if (is("FORMAT=")) {
    std::string format = line.substr(7);
    format.erase(0, format.find_first_not_of(" \t"));
    format.erase(format.find_last_not_of(" \t") + 1);
    if (format != "32-bit_rle_rgbe" && format != "32-bit_rle_xyze")
      fail("FORMAT: 32-bit_rle_rgbe or 32-bit_rle_xyze was expected, not '" + oneLine(format) + "'");
    header.xyz = format == "32-bit_rle_xyze";
  } else if (is("EXPOSURE=") || is("COLORCORR=")) {
    // Both may stand several times; the products count.
    const std::vector<double> values = numbers(line, is("EXPOSURE=") ? 1 : 3);
    for (int i = 0; i < 3; ++i) {
      const double value = values.size() == 1 ? values[0] : values[i];
      header.radiance_from_stored[i] = static_cast<float>(header.radiance_from_stored[i] / value);
      if (!(value > 0.0) || !std::isnormal(header.radiance_from_stored[i]))
        fail(
            fmt::format("{}: a positive factor was expected, not {}", line.substr(0, line.find('=')), value));
    }
  } else if (is("PRIMARIES=")) {
    const std::vector<double> v = numbers(line, 8);
    header.rec709_from_stored = rec709From({{{v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}, {v[6], v[7]}}});
    if (header.rec709_from_stored == glm::mat3(0.0f))
      fail("PRIMARIES: '" + oneLine(line.substr(10)) + "' span no colour space");
  }
}

// "-Y 512 +X 1024": the first axis is the slow one. -Y: from the top; +X: from the left.
void Reader::readResolution(Header& header) {
  const std::string line = headerLine("the resolution");
  char sign[2] = {}, axis[2] = {}, rest = 0;
  long long size[2] = {};
  const int fields = line.size() > 80 ? 0
                                      : std::sscanf(line.c_str(), "%c%c %12lld %c%c %12lld %c", &sign[0],
                                                    &axis[0], &size[0], &sign[1], &axis[1], &size[1], &rest);
  const auto valid = [&](int i) {
    return (sign[i] == '+' || sign[i] == '-') && (axis[i] == 'X' || axis[i] == 'Y');
  };
  if (fields != 6 || !valid(0) || !valid(1) || axis[0] == axis[1])
    fail("resolution: a line like '-Y 512 +X 1024' was expected, not '" + oneLine(line) + "'");
  header.columns = axis[0] == 'X';
  const int x = header.columns ? 0 : 1, y = 1 - x;
  // New runs hold 16 pixels a byte at best; old ones of a long scanline of one colour a few thousand.
  constexpr double kPixelsPerByte = 4096.0;
  checkPictureSize(place_, size[x], size[y], bytes_.size(), kPixelsPerByte);
  if (static_cast<std::uint64_t>(size[0]) > left() / 4)
    fail(fmt::format("size {} x {}: {} bytes of pixels cannot hold {} scanlines", size[x], size[y], left(),
                     size[0]));
  header.width = static_cast<int>(size[x]);
  header.height = static_cast<int>(size[y]);
  header.flip_x = sign[x] == '-';
  header.flip_y = sign[y] == '+';
}

Header Reader::readHeader() {
  Header header;
  const std::string magic = headerLine("the end of its first line");
  if (magic.compare(0, 2, "#?") != 0) fail("a Radiance picture starts with '#?RADIANCE'");
  for (std::string line = headerLine("its header's empty line"); !line.empty();
       line = headerLine("its header's empty line"))
    if (line[0] != '#') readVariable(line, header);
  if (header.xyz) header.rec709_from_stored = rec709FromXyz();
  readResolution(header);
  return header;
}

void Reader::readScanline(std::vector<Rgbe>& line, int index, int count) {
  scanline_ = fmt::format("{}: scanline {} of {}", place_, index + 1, count);
  constexpr std::size_t kMinNewRuns = 8, kMaxNewRuns = 0x7fff;
  const std::uint8_t* p = bytes_.data() + at_;
  const bool new_runs = line.size() >= kMinNewRuns && line.size() <= kMaxNewRuns && left() >= 4 &&
                        p[0] == 2 && p[1] == 2 && p[2] < 128;
  if (!new_runs) return readFlatOrOldRuns(line);
  const std::size_t length = std::size_t(p[2]) << 8 | p[3];
  if (length != line.size())
    failAt(fmt::format("{} pixels were expected, its run lengths say {}", line.size(), length));
  at_ += 4;
  readNewRuns(line);
}

// Each channel by itself: 129…255 repeat the next byte 1…127 times, 1…128 bytes follow as they are.
void Reader::readNewRuns(std::vector<Rgbe>& line) {
  for (std::size_t channel = 0; channel < 4; ++channel) {
    for (std::size_t x = 0; x < line.size();) {
      const unsigned code = next();
      const bool repeat = code > 128;
      const std::size_t run = repeat ? code & 127 : code;
      if (run == 0 || run > line.size() - x)
        failAt(fmt::format("a run of {} where {} pixels are left", run, line.size() - x));
      const std::uint8_t value = repeat ? next() : 0;
      for (std::size_t i = 0; i < run; ++i) line[x++][channel] = repeat ? value : next();
    }
  }
}

// Pixels as they are; (1, 1, 1, n) repeats the pixel before n times, several in a row are the bytes of one
// number.
void Reader::readFlatOrOldRuns(std::vector<Rgbe>& line) {
  int shift = 0;
  for (std::size_t x = 0; x < line.size();) {
    Rgbe pixel;
    for (std::uint8_t& byte : pixel) byte = next();
    if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
      line[x++] = pixel;
      shift = 0;
      continue;
    }
    if (x == 0) failAt("it starts with a run that repeats no pixel");
    const std::size_t run = shift > 24 ? line.size() + 1 : std::size_t(pixel[3]) << shift;
    if (run > line.size() - x)
      failAt(fmt::format("a run of {} where {} pixels are left", run, line.size() - x));
    const Rgbe before = line[x - 1];
    for (std::size_t i = 0; i < run; ++i) line[x++] = before;
    shift += 8;
  }
}

}  // namespace

Image decodeHdr(const std::vector<std::uint8_t>& bytes, const std::string& place) {
  Reader reader(bytes, place);
  const Header header = reader.readHeader();
  const int line_count = header.columns ? header.width : header.height;
  const int line_length = header.columns ? header.height : header.width;
  const bool plain = header.rec709_from_stored == glm::mat3(1.0f);

  std::array<float, 256> scales{};  // an exponent of 0 is black
  for (int e = 1; e < 256; ++e) scales[static_cast<std::size_t>(e)] = std::ldexp(1.0f, e - 136);

  Image image;
  image.width = header.width;
  image.height = header.height;
  image.channels = 3;
  std::vector<Rgbe> line(static_cast<std::size_t>(line_length));
  reader.readScanline(line, 0,
                      line_count);  // a file that lies about its size fails here, before the picture is made
  image.pixels.resize(image.pixelCount() * 3);
  for (int slow = 0; slow < line_count; ++slow) {
    if (slow > 0) reader.readScanline(line, slow, line_count);
    for (int fast = 0; fast < line_length; ++fast) {
      const int file_x = header.columns ? slow : fast, file_y = header.columns ? fast : slow;
      const Rgbe& stored = line[static_cast<std::size_t>(fast)];
      const float scale = scales[stored[3]];
      glm::vec3 color = glm::vec3(stored[0], stored[1], stored[2]) * scale * header.radiance_from_stored;
      if (!plain) color = header.rec709_from_stored * color;
      float* pixel = image.at(header.flip_x ? header.width - 1 - file_x : file_x,
                              header.flip_y ? header.height - 1 - file_y : file_y);
      for (int c = 0; c < 3; ++c) pixel[c] = color[c];
    }
  }
  return image;
}

Image readHdr(const std::filesystem::path& path) {
  try {
    return decodeHdr(readBytes(path), path.string());
  } catch (const std::bad_alloc&) {
    throw Error(path.string(), "not enough memory for this picture");
  }
}

}  // namespace gloam
