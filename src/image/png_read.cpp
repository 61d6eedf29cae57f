// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// libpng reports errors by longjmp: the function that calls setjmp holds nothing that would need a destructor.
#include <gloam/error.h>
#include <png.h>

#include <cstring>

#include "image/limits.h"
#include "image/raster.h"

namespace gloam {
namespace {

struct Job {
  std::span<const std::uint8_t> bytes;
  std::size_t at = 0;
  const std::string* place;
  const SizeCheck* accept;
  Raster raster;
  std::vector<png_bytep> rows;
  std::string failure;
};

void readBytes(png_structp png, png_bytep to, png_size_t count) {
  Job& job = *static_cast<Job*>(png_get_io_ptr(png));
  if (count > job.bytes.size() - job.at) png_error(png, "the file ends");
  std::memcpy(to, &job.bytes[job.at], count);
  job.at += count;
}

void keepError(png_structp png, png_const_charp message) {
  static_cast<Job*>(png_get_error_ptr(png))->failure = message;
  png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

// Asks for 8 or 16 bits a channel, no palette, alpha where a colour is transparent.
void askForPlainChannels(png_structp png, png_infop info) {
  png_set_expand(png);
  const std::uint16_t one = 1;
  if (*reinterpret_cast<const std::uint8_t*>(&one) == 1) png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
}

// Throws: only outside of libpng's calls.
void makeRows(Job& job, png_structp png, png_infop info) {
  Raster& raster = job.raster;
  raster.channels = png_get_channels(png, info);
  const bool wide = png_get_bit_depth(png, info) == 16;
  const std::size_t values =
      std::size_t(raster.width) * std::size_t(raster.height) * std::size_t(raster.channels);
  if (wide)
    raster.words.resize(values);
  else
    raster.bytes.resize(values);
  auto* first = wide ? reinterpret_cast<png_bytep>(raster.words.data()) : raster.bytes.data();
  const std::size_t stride = std::size_t(raster.width) * std::size_t(raster.channels) * (wide ? 2 : 1);
  for (int y = 0; y < raster.height; ++y) job.rows.push_back(first + std::size_t(y) * stride);
}

// Each step returns false after a longjmp.
bool readHeader(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_info(png, info);
  return true;
}

bool preparePixels(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png))) return false;
  askForPlainChannels(png, info);
  return true;
}

bool readPixels(png_structp png, Job& job) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_image(png, job.rows.data());
  png_read_end(png, nullptr);
  return true;
}

void decode(Job& job, png_structp png, png_infop info) {
  const auto fail = [&] { throw Error(*job.place, "not a readable PNG: " + oneLine(job.failure)); };
  png_set_read_fn(png, &job, readBytes);
  png_set_user_limits(png, 0x7fffffff, 0x7fffffff);  // sizes are checked below
  if (!readHeader(png, info)) fail();
  const std::int64_t width = png_get_image_width(png, info), height = png_get_image_height(png, info);
  constexpr double kZlibBest = 1032.0, kPixelsPerByte = 8.0;
  checkPictureSize(*job.place, width, height, job.bytes.size(), kZlibBest * kPixelsPerByte);
  if (*job.accept) (*job.accept)(width, height);
  job.raster.width = int(width);
  job.raster.height = int(height);
  if (!preparePixels(png, info)) fail();
  makeRows(job, png, info);
  if (!readPixels(png, job)) fail();
}

}  // namespace

bool isPng(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 8 && std::memcmp(bytes.data(), "\x89PNG\r\n\x1a\n", 8) == 0;
}

Raster decodePng(std::span<const std::uint8_t> bytes, const std::string& place, const SizeCheck& accept) {
  if (!isPng(bytes)) throw Error(place, "not a PNG");
  Job job{.bytes = bytes, .place = &place, .accept = &accept};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, keepError, ignoreWarning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  try {
    if (!info) throw Error(place, "not enough memory for this picture");
    decode(job, png, info);
  } catch (...) {
    png_destroy_read_struct(&png, &info, nullptr);
    throw;
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return std::move(job.raster);
}

}  // namespace gloam
