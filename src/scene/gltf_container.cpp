// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The containers that glTF's bytes travel in: .glb chunks (glTF 2.0 specification, section 4) and data URIs (RFC 2397).
#include <fmt/format.h>

#include <array>
#include <cstring>

#include "scene/gltf_document.h"

namespace gloam {
namespace {

std::uint32_t littleEndian32(const std::uint8_t* bytes) {
  return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

constexpr std::uint32_t kChunkJson = 0x4e4f534a, kChunkBinary = 0x004e4942;

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Value of each base64 character, of both alphabets; -1 for others.
std::array<std::int8_t, 256> base64Values() {
  std::array<std::int8_t, 256> values;
  values.fill(-1);
  const char* alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (int i = 0; i < 64; ++i) values[static_cast<unsigned char>(alphabet[i])] = static_cast<std::int8_t>(i);
  values['-'] = 62, values['_'] = 63;
  return values;
}

}  // namespace

GlbChunks splitGlb(ByteSpan file, const std::string& place, Warnings& warnings) {
  if (file.size() < 12)
    throw Error(place, "header: 12 bytes were expected, the file has " + std::to_string(file.size()));
  const std::uint32_t version = littleEndian32(&file[4]), length = littleEndian32(&file[8]);
  if (version != 2)
    throw Error(place, fmt::format("header: version {}, but .glb version 2 is read", version));
  if (length > file.size())
    throw Error(place,
                fmt::format("header: length {}, but the file ends after {} bytes", length, file.size()));
  if (length < file.size())
    warnings.push_back(fmt::format("{} bytes after the end of the .glb are ignored", file.size() - length));

  GlbChunks chunks;
  std::size_t at = 12;
  for (int index = 0; at < length; ++index) {
    if (length - at < 8)
      throw Error(place, fmt::format("chunk {}: its header is cut off at byte {}", index, length));
    const std::uint32_t size = littleEndian32(&file[at]), type = littleEndian32(&file[at + 4]);
    at += 8;
    if (size > length - at)
      throw Error(place,
                  fmt::format("chunk {}: {} bytes are claimed, {} are left", index, size, length - at));
    const ByteSpan data = file.subspan(at, size);
    at += size;
    if (index == 0) {
      if (type != kChunkJson) throw Error(place, "chunk 0: the JSON chunk was expected first");
      chunks.json = {reinterpret_cast<const char*>(data.data()), data.size()};
    } else if (type == kChunkBinary && !chunks.binary) {
      chunks.binary = data;
    } else if (type == kChunkJson || type == kChunkBinary) {
      warnings.push_back(fmt::format("chunk {}: a second chunk of its kind is ignored", index));
    }
  }
  if (chunks.json.empty()) throw Error(place, "chunk 0: the JSON chunk is missing or empty");
  return chunks;
}

std::string percentDecoded(const std::string& uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && hexDigit(uri[i + 1]) >= 0 && hexDigit(uri[i + 2]) >= 0) {
      out.push_back(static_cast<char>(hexDigit(uri[i + 1]) * 16 + hexDigit(uri[i + 2])));
      i += 2;
    } else {
      out.push_back(uri[i]);
    }
  }
  return out;
}

Bytes decodeDataUri(const std::string& uri, const std::string& place, const std::string& where) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos) throw Error(place, where + ": data URI without a comma");
  const std::string_view header(uri.data(), comma);
  if (!header.ends_with(";base64")) {
    const std::string plain = percentDecoded(uri.substr(comma + 1));
    return Bytes(plain.begin(), plain.end());
  }
  static const std::array<std::int8_t, 256> values = base64Values();
  std::string_view text(uri);
  text.remove_prefix(comma + 1);
  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
  if (text.size() % 4 == 1) throw Error(place, where + ": base64 data is cut off");
  Bytes out;
  out.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int value = values[static_cast<unsigned char>(text[i])];
    if (value < 0)
      throw Error(place, fmt::format("{}: character {} of the base64 data is not base64", where, i));
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    if (i % 4 != 0) out.push_back(static_cast<std::uint8_t>(bits >> (6 - i % 4 * 2)));
  }
  return out;
}

}  // namespace gloam
