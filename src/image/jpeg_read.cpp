// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// libjpeg reports errors by a function that must not return; ours jumps, so the functions that call setjmp hold nothing
// that would need a destructor. It mends truncated data and only warns: here that is an error.
#include <gloam/error.h>

#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it first
#include <cstring>

#include <jpeglib.h>
// After jpeglib.h.
#include <jerror.h>

#include "image/limits.h"
#include "image/raster.h"

namespace gloam {
namespace {

struct Job {
  jpeg_decompress_struct jpeg;
  jpeg_error_mgr errors;
  jpeg_progress_mgr progress;
  std::jmp_buf out;
  char failure[JMSG_LENGTH_MAX];
  std::vector<JSAMPROW> rows;
};

void leave(j_common_ptr jpeg) {
  Job& job = *static_cast<Job*>(jpeg->client_data);
  jpeg->err->format_message(jpeg, job.failure);
  std::longjmp(job.out, 1);
}

// Warnings are negative, traces are not. Bytes too many between segments do no harm.
void judgeMessage(j_common_ptr jpeg, int level) {
  if (level < 0 && jpeg->err->msg_code != JWRN_EXTRANEOUS_DATA) leave(jpeg);
}

// A progressive picture may hold any number of scans, each costing as much as a whole picture.
void limitScans(j_common_ptr jpeg) {
  constexpr int kMaxScans = 200;
  if (!jpeg->is_decompressor) return;
  if (static_cast<Job*>(jpeg->client_data)->jpeg.input_scan_number <= kMaxScans) return;
  std::snprintf(static_cast<Job*>(jpeg->client_data)->failure, JMSG_LENGTH_MAX, "more than %d scans",
                kMaxScans);
  std::longjmp(static_cast<Job*>(jpeg->client_data)->out, 1);
}

// Each step returns false after a jump.
bool readHeader(Job& job, std::span<const std::uint8_t> bytes) {
  if (setjmp(job.out)) return false;
  jpeg_create_decompress(&job.jpeg);
  job.jpeg.progress = &job.progress;
  jpeg_mem_src(&job.jpeg, bytes.data(), static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&job.jpeg, TRUE);
  return true;
}

bool start(Job& job) {
  if (setjmp(job.out)) return false;
  const J_COLOR_SPACE stored = job.jpeg.jpeg_color_space;
  job.jpeg.out_color_space = stored == JCS_GRAYSCALE                    ? JCS_GRAYSCALE
                             : stored == JCS_CMYK || stored == JCS_YCCK ? JCS_CMYK
                                                                        : JCS_RGB;
  job.jpeg.dct_method = JDCT_ISLOW;  // the exact one
  jpeg_start_decompress(&job.jpeg);
  return true;
}

bool readRows(Job& job) {
  if (setjmp(job.out)) return false;
  while (job.jpeg.output_scanline < job.jpeg.output_height)
    jpeg_read_scanlines(&job.jpeg, &job.rows[job.jpeg.output_scanline],
                        job.jpeg.output_height - job.jpeg.output_scanline);
  jpeg_finish_decompress(&job.jpeg);
  return true;
}

// Inks as Adobe stores them, inverted: what is left of white.
void rgbFromCmyk(Raster& raster) {
  const std::size_t pixels = raster.bytes.size() / 4;
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      raster.bytes[3 * i + c] = std::uint8_t(raster.bytes[4 * i + c] * raster.bytes[4 * i + 3] / 255);
  raster.bytes.resize(pixels * 3);
  raster.channels = 3;
}

Raster decode(Job& job, std::span<const std::uint8_t> bytes, const std::string& place,
              const SizeCheck& accept) {
  const auto fail = [&] { throw Error(place, "not a readable JPEG: " + oneLine(job.failure)); };
  if (!readHeader(job, bytes)) fail();
  Raster raster;
  const std::int64_t width = job.jpeg.image_width, height = job.jpeg.image_height;
  constexpr double kPixelsPerByte = 8.0 * 16.0 * 16.0;  // a bit for a block of 16 x 16
  checkPictureSize(place, width, height, bytes.size(), kPixelsPerByte);
  if (accept) accept(width, height);
  if (!start(job)) fail();
  raster.width = int(width);
  raster.height = int(height);
  raster.channels = job.jpeg.output_components;
  const std::size_t stride = std::size_t(width) * std::size_t(raster.channels);
  raster.bytes.resize(stride * std::size_t(height));
  for (std::size_t y = 0; y < std::size_t(height); ++y) job.rows.push_back(&raster.bytes[y * stride]);
  if (!readRows(job)) fail();
  if (raster.channels == 4) rgbFromCmyk(raster);
  return raster;
}

}  // namespace

bool isJpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

Raster decodeJpeg(std::span<const std::uint8_t> bytes, const std::string& place, const SizeCheck& accept) {
  if (!isJpeg(bytes)) throw Error(place, "not a JPEG");
  Job job{};
  job.jpeg.err = jpeg_std_error(&job.errors);
  job.errors.error_exit = leave;
  job.errors.emit_message = judgeMessage;
  job.progress.progress_monitor = limitScans;
  job.jpeg.client_data = &job;
  try {
    Raster raster = decode(job, bytes, place, accept);
    jpeg_destroy_decompress(&job.jpeg);
    return raster;
  } catch (...) {
    jpeg_destroy_decompress(&job.jpeg);
    throw;
  }
}

}  // namespace gloam
