// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// OFF as in Geomview's manual, PLY as in Turk's description of 1994, as far as their counts go.
#include "scene/mesh_file_claims.h"

#include <fmt/format.h>
#include <gloam/error.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include "image/limits.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;

/// The next line that holds more than a comment.
bool nextLine(std::istream& in, std::string& line) {
  while (std::getline(in, line)) {
    line.resize(std::min(line.size(), line.find('#')));
    if (line.find_first_not_of(" \t\r") != std::string::npos) return true;
  }
  return false;
}

struct OffCounts {
  std::uint64_t vertices = 0, faces = 0;
};

/// From "OFF", "COFF 8 6 12", "OFF8 6 0" and the like, or the line after it. Nothing where the form is another.
std::optional<OffCounts> readOffHeader(std::istream& in) {
  std::string line;
  if (!nextLine(in, line)) return std::nullopt;
  if (const std::size_t word = line.find("OFF"); word != std::string::npos) {
    if (line.find('n') < word) return std::nullopt;  // of other dimensions
    line.erase(0, word + 3);
    if (line.find("BINARY") != std::string::npos) return std::nullopt;
    if (line.find_first_not_of(" \t\r") == std::string::npos && !nextLine(in, line)) return std::nullopt;
  }
  OffCounts counts;
  std::istringstream words(line);
  if (!(words >> counts.vertices >> counts.faces)) return std::nullopt;
  return counts;
}

void checkOffFace(const fs::path& path, const std::string& line, std::uint64_t face, std::uint64_t vertices) {
  std::istringstream words(line);
  std::uint64_t corners = 0;
  words >> corners;
  for (std::uint64_t i = 0; words && i < corners; ++i) {
    std::int64_t index = 0;
    if (!(words >> index))
      throw Error(path.string(), fmt::format("face {} holds {} of its {} vertices", face, i, corners));
    if (index < 0 || std::uint64_t(index) >= vertices)
      throw Error(path.string(), fmt::format("face {} names vertex {}, there are {}", face, index, vertices));
  }
}

/// Least bytes that a value of this PLY type takes; of one in text, a digit and what parts it from the next.
std::uint64_t plyBytes(const std::string& type, bool text) {
  if (text) return 2;
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  return type == "double" || type == "float64" ? 8 : 4;
}

}  // namespace

void checkOffFile(const fs::path& path) {
  std::uint64_t file_bytes = 0;
  std::ifstream in = openForReading(path, &file_bytes);
  const std::optional<OffCounts> counts = readOffHeader(in);
  if (!counts) return;
  std::string line;
  for (std::uint64_t i = 0; i < counts->vertices; ++i) {
    if (!nextLine(in, line))
      throw Error(path.string(), fmt::format("claims {} vertices, holds {}", counts->vertices, i));
  }
  for (std::uint64_t i = 0; i < counts->faces; ++i) {
    if (!nextLine(in, line))
      throw Error(path.string(), fmt::format("claims {} faces, holds {}", counts->faces, i));
    checkOffFace(path, line, i, counts->vertices);
  }
}

void checkPlyFile(const fs::path& path) {
  std::uint64_t file_bytes = 0;
  std::ifstream in = openForReading(path, &file_bytes);
  std::string line, element;
  std::uint64_t count = 0, bytes = 0;
  bool text = false;
  double needed = 0.0;  // counts of 2^64 must not wrap around
  const auto endElement = [&] {
    needed += double(count) * double(bytes);
    if (needed <= double(file_bytes) + 1.0) return;  // the last line of a text may lack its end
    throw Error(path.string(), fmt::format("claims {} elements '{}', more than a file of {} bytes can hold",
                                           count, oneLine(element), file_bytes));
  };
  constexpr int kMostLines = 100000;
  for (int i = 0; i < kMostLines && std::getline(in, line); ++i) {
    std::istringstream words(line);
    std::string word, type;
    words >> word >> type;
    if (word == "format") text = type == "ascii";
    if (word == "element") {
      endElement();
      element = type, count = 0, bytes = 0;
      words >> count;  // 2^64 and more: the greatest that there is
    } else if (word == "property") {
      if (type == "list") words >> type;  // an empty one still has its length
      bytes += plyBytes(type, text);
    } else if (word == "end_header") {
      return endElement();
    }
  }
}

}  // namespace gloam
