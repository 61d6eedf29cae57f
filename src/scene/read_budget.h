// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How much memory a scene file may ask for.
#pragma once

#include <fmt/format.h>
#include <gloam/error.h>

#include <cstdint>
#include <string>

namespace gloam {

/// What reading one file may allocate: a base that any honest file gets, and a multiple of the bytes that the file and its
/// companions really have. A count in a header is charged here before memory is taken because of it.
class ReadBudget {
 public:
  explicit ReadBudget(std::string file) : file_(std::move(file)) {}

  /// More bytes of input were read, so more may be made of them.
  void addInput(std::uint64_t bytes) { limit_ += kPerInputByte * bytes; }

  /// Throws Error(file, "field: …") where `count` elements of `bytes_each` go beyond the limit.
  void charge(std::uint64_t count, std::uint64_t bytes_each, const std::string& field) {
    const long double wanted = static_cast<long double>(count) * bytes_each;
    if (wanted > static_cast<long double>(limit_ - used_))
      throw Error(
          file_,
          fmt::format("{}: {} elements would need {:.0f} MB; a file of this size is given {} MB in all",
                      field, count, static_cast<double>(wanted / 1e6L), limit_ / 1000000));
    used_ += count * bytes_each;
  }

 private:
  static constexpr std::uint64_t kBase = std::uint64_t(512) << 20;
  static constexpr std::uint64_t kPerInputByte = 64;
  std::string file_;
  std::uint64_t limit_ = kBase, used_ = 0;
};

}  // namespace gloam
