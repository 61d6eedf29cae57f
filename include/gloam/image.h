// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pixels in memory and in files. Values are linear Rec. 709 (radiance in EXR and HDR, 0 to 1 in PNG and JPEG)
// unless a channel says something else by its name. Rows run from the top, channels are interleaved.
#pragma once

#include <gloam/error.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gloam {

/// A picture of 1 to 4 channels (Y; Y, A; R, G, B; R, G, B, A), pixels[(y * width + x) * channels + c].
struct Image {
  int width = 0, height = 0;
  int channels = 0;
  std::vector<float> pixels;

  Image() = default;
  Image(int w, int h, int c, float value = 0.0f)
      : width(w), height(h), channels(c), pixels(std::size_t(w) * std::size_t(h) * std::size_t(c), value) {}
  bool empty() const { return pixels.empty(); }
  std::size_t pixelCount() const { return std::size_t(width) * std::size_t(height); }
  float* at(int x, int y) { return &pixels[(std::size_t(y) * width + x) * channels]; }
  const float* at(int x, int y) const { return &pixels[(std::size_t(y) * width + x) * channels]; }
};

enum class ChannelType : std::uint8_t { kHalf, kFloat, kUint };

/// Channels that belong together: "direct" with R, G, B is stored as direct.R, direct.G, direct.B. The layer
/// without a name holds plain R, G, B.
struct Layer {
  std::string name;
  std::vector<std::string> channels;  ///< "R", "G", "B"; "X", "Y", "Z"; "Z"; "id"
  ChannelType type = ChannelType::kHalf;
  std::vector<float> pixels;       ///< interleaved, as in Image; empty where type is kUint
  std::vector<std::uint32_t> ids;  ///< the same for kUint; empty otherwise
};

/// What an EXR file holds: layers of one size. A render's are "" (R G B), "direct" (R G B), "indirect" (R G
/// B), "normal" (X Y Z), "depth" (Z), "albedo" (R G B) and "object" (id, kUint).
struct LayeredImage {
  int width = 0, height = 0;
  std::vector<Layer> layers;
  /// Remarks that travel with the file as string attributes of its header ("gloam.bounces": "1").
  std::map<std::string, std::string> attributes;

  /// The layer of that name, or null.
  const Layer* find(std::string_view name) const;
  /// One layer as a picture, its channels in the order asked for. Throws Error(place, "channel direct.G is
  /// missing; …").
  Image image(std::string_view layer, const std::vector<std::string>& channels,
              const std::string& place) const;
  /// Adds a layer of floats; `image` has as many channels as names. Throws Error where sizes differ.
  void add(std::string name, std::vector<std::string> channels, Image image,
           ChannelType type = ChannelType::kHalf);
  /// Adds a layer of one UINT channel, `ids` in the order of pixels.
  void addIds(std::string name, std::string channel, std::vector<std::uint32_t> ids);
};

/// Reads a picture, of the kind that its first bytes tell: OpenEXR (R, G, B and A, or Y; an environment or a
/// render's sum), Radiance HDR, PNG or JPEG (decoded from sRGB, alpha left linear). EXR and HDR primaries
/// other than Rec. 709 are converted; HDR's EXPOSURE and COLORCORR are divided out. Not-a-number and infinite
/// pixels come back as they are (firstNonFinite finds them). Throws Error(path, what): also for a size above
/// kMaxPixels or one that the file's length cannot hold, before memory is taken.
Image readImage(const std::filesystem::path& path);

/// All channels of an EXR file (scanlines or tiles, first flat part of several, every compression of the
/// library), on the display window; pixels outside the data window are 0. Deep and subsampled files are
/// refused. A layer whose channels are all UINT has type kUint, one with any FLOAT or a mixture is kFloat.
LayeredImage readExr(const std::filesystem::path& path);

/// Radiance RGBE and XYZE: flat, old and new run lengths, eight orientations. Three channels.
Image readHdr(const std::filesystem::path& path);

inline constexpr std::size_t kMaxPixels = std::size_t(1) << 28;

// Writers write beside the target and rename; after a failure neither a new nor a half-written file is left,
// and an Error names the path and the reason (directory missing, no permission, disk full).

/// EXR with ZIP compression, all layers.
void writeExr(const LayeredImage& image, const std::filesystem::path& path);
/// EXR with the channels of the picture (Y; Y, A; R, G, B; R, G, B, A), as half or float. Halfs are clamped
/// to +-65504.
void writeExr(const Image& image, const std::filesystem::path& path, ChannelType type = ChannelType::kHalf);
/// Radiance RGBE, run-length coded, top row first; R, G, B of an image of 3 or 4 channels. Negative values
/// become 0.
void writeHdr(const Image& image, const std::filesystem::path& path);
/// 8-bit PNG: linear 0 to 1 is encoded as sRGB, alpha is not; values outside are clamped, not-a-number
/// becomes 0.
void writePng(const Image& image, const std::filesystem::path& path);
/// By extension: .exr, .hdr or .png. Throws Error for another.
void writeImage(const Image& image, const std::filesystem::path& path);

/// The bytes that writePng stores, interleaved.
std::vector<std::uint8_t> encodeSrgb8(const Image& image);

enum class ToneMap : std::uint8_t { kNone, kAces };

/// How linear radiance becomes light of a display: times 2^exposure_stops, then the curve (src/image/tonemap.h).
struct DisplayOptions {
  ToneMap tone_map = ToneMap::kAces;
  float exposure_stops = 0.0f;
  bool auto_exposure = false;  ///< first brings the log-average luminance to middle grey
};
/// Linear 0 to 1, as writePng takes it (which encodes sRGB). Alpha is kept.
Image toneMapped(const Image& radiance, const DisplayOptions& options);

/// The first pixel that is infinite or not a number, in the order of storage.
struct PixelPlace {
  int x, y, channel;
  float value;
};
std::optional<PixelPlace> firstNonFinite(const Image& image);

}  // namespace gloam
