// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "image/exr_samples.h"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputPart.h>
#include <half.h>

#include <cstdint>
#include <list>

namespace gloam::test {
namespace {

Imf::PixelType typeOf(const ExrSample& sample) {
  return sample.type == "uint" ? Imf::UINT : sample.type == "float" ? Imf::FLOAT : Imf::HALF;
}

Imf::Header headerOf(const ExrSample& sample, const std::string& name) {
  const Imath::Box2i data({sample.data_x, sample.data_y},
                          {sample.data_x + sample.width - 1, sample.data_y + sample.height - 1});
  Imath::Box2i display = data;
  if (sample.display_width > 0)
    display = Imath::Box2i(
        {sample.display_x, sample.display_y},
        {sample.display_x + sample.display_width - 1, sample.display_y + sample.display_height - 1});
  Imf::Header header(display, data);
  header.compression() = sample.compression;
  header.setName(name);
  header.setType(sample.tile > 0 ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
  if (sample.tile > 0)
    header.setTileDescription(
        Imf::TileDescription(unsigned(sample.tile), unsigned(sample.tile), Imf::ONE_LEVEL));
  for (const std::string& channel : sample.channels) {
    const int sampling = channel == sample.channels.back() ? sample.sampling : 1;
    header.channels().insert(channel, Imf::Channel(typeOf(sample), sampling, sampling));
  }
  if (sample.chromaticities) Imf::addChromaticities(header, *sample.chromaticities);
  for (const auto& [attribute, value] : sample.attributes)
    header.insert(attribute, Imf::StringAttribute(value));
  return header;
}

class Pixels {
 public:
  explicit Pixels(const ExrSample& sample) {
    const Imath::Box2i window({sample.data_x, sample.data_y},
                              {sample.data_x + sample.width - 1, sample.data_y + sample.height - 1});
    int c = 0;
    for (const std::string& channel : sample.channels) {
      const int sampling = channel == sample.channels.back() ? sample.sampling : 1;
      const int columns = (sample.width + sampling - 1) / sampling,
                rows = (sample.height + sampling - 1) / sampling;
      const std::size_t size = sample.type == "half" ? 2 : 4;
      std::vector<char>& plane = planes_.emplace_back(std::size_t(columns * rows) * size);
      for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
          char* to = &plane[std::size_t(y * columns + x) * size];
          const float value = sampleValue(c, x, y);
          if (sample.type == "half") *reinterpret_cast<half*>(to) = half(value);
          if (sample.type == "float") *reinterpret_cast<float*>(to) = value;
          if (sample.type == "uint") *reinterpret_cast<std::uint32_t*>(to) = std::uint32_t(value);
        }
      buffer.insert(channel, Imf::Slice::Make(typeOf(sample), plane.data(), window, size,
                                              size * std::size_t(columns), sampling, sampling));
      ++c;
    }
  }
  Imf::FrameBuffer buffer;

 private:
  std::list<std::vector<char>> planes_;
};

void writePart(Imf::MultiPartOutputFile& file, int index, const ExrSample& sample) {
  const Pixels pixels(sample);
  if (sample.tile > 0) {
    Imf::TiledOutputPart part(file, index);
    part.setFrameBuffer(pixels.buffer);
    part.writeTiles(0, part.numXTiles() - 1, 0, part.numYTiles() - 1);
  } else {
    Imf::OutputPart part(file, index);
    part.setFrameBuffer(pixels.buffer);
    part.writePixels(sample.height);
  }
}

Imf::Header deepHeader() {
  Imf::Header header(4, 4);
  header.setName("deep");
  header.setType(Imf::DEEPSCANLINE);
  header.compression() = Imf::ZIPS_COMPRESSION;
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  return header;
}

void writeDeepPart(Imf::MultiPartOutputFile& file, int index) {
  std::vector<unsigned> counts(16, 1);
  std::vector<float> values(16, 0.5f);
  std::vector<float*> pointers;
  for (float& value : values) pointers.push_back(&value);
  Imf::DeepFrameBuffer buffer;
  buffer.insertSampleCountSlice(
      Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned), 4 * sizeof(unsigned)));
  buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers.data()), sizeof(float*),
                                    4 * sizeof(float*), sizeof(float)));
  Imf::DeepScanLineOutputPart part(file, index);
  part.setFrameBuffer(buffer);
  part.writePixels(4);
}

}  // namespace

void writeSample(const ExrSample& sample, const std::filesystem::path& path) {
  const Imf::Header header = headerOf(sample, "");
  Imf::MultiPartOutputFile file(path.c_str(), &header, 1);
  writePart(file, 0, sample);
}

void writeSeveralParts(const ExrSample& sample, const std::filesystem::path& path) {
  ExrSample other;
  other.width = sample.display_width > 0 ? sample.display_width : sample.width;
  other.height = sample.display_height > 0 ? sample.display_height : sample.height;
  other.channels = {"Q"};
  Imf::Header deep = deepHeader();
  deep.displayWindow() = headerOf(sample, "flat").displayWindow();
  const std::vector<Imf::Header> headers{deep, headerOf(sample, "flat"), headerOf(other, "other")};
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 3);
  writeDeepPart(file, 0);
  writePart(file, 1, sample);
  writePart(file, 2, other);
}

void writeDeep(const std::filesystem::path& path) {
  const Imf::Header header = deepHeader();
  Imf::MultiPartOutputFile file(path.c_str(), &header, 1);
  writeDeepPart(file, 0);
}

}  // namespace gloam::test
