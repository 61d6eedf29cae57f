// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the tests of this room share: a folder of their own, files by bytes, errors as texts.
#pragma once

#include <gloam/error.h>
#include <gloam/image.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace gloam::test {

using Bytes = std::vector<std::uint8_t>;

/// A folder for the files of one test; gone afterwards.
class FileTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  std::filesystem::path put(const std::string& name, const Bytes& bytes) const {
    std::ofstream(path(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    return path(name);
  }
  std::filesystem::path put(const std::string& name, const std::string& text) const {
    return put(name, Bytes(text.begin(), text.end()));
  }
  static Bytes bytesOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(stream), {});
  }
  std::size_t filesInFolder() const {
    return std::size_t(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

 private:
  // Thousands of small files: in memory where that is possible.
  const std::filesystem::path folder_ =
      (std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path()) /
      std::filesystem::path("gloam_image_test_" + std::to_string(getpid()));
};

/// What the Error says that `work` throws, or "" where it throws none.
template <typename Work>
std::string errorOf(Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "";
}

/// Deterministic values of many magnitudes, exact in half precision.
inline Image samplePicture(int width, int height, int channels) {
  Image image(width, height, channels);
  std::uint32_t state = 12345;
  for (float& value : image.pixels) {
    state = state * 1664525u + 1013904223u;
    value = float(1024 + (state >> 22)) * (state & 4096 ? 0.0009765625f : 0.03125f);
  }
  return image;
}

}  // namespace gloam::test
