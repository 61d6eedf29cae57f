// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/checkpoint_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

namespace gloam {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kByteOrder = 0x01020304u;

std::atomic<Clock::rep> last_commit{Clock::now().time_since_epoch().count()};

struct Header {
  char magic[8] = {};
  std::uint32_t version = 0;
  std::uint32_t byte_order = 0;
  Fingerprint fingerprint;
};

}  // namespace

CheckpointWriter::CheckpointWriter(const std::filesystem::path& path, const CheckpointKind& kind,
                                   const Fingerprint& fingerprint)
    : file_(path) {
  Header header{.version = kind.version, .byte_order = kByteOrder, .fingerprint = fingerprint};
  std::copy(std::begin(kind.magic), std::end(kind.magic), header.magic);
  write(&header, sizeof header);
}

void CheckpointWriter::write(const void* data, std::size_t bytes) {
  sum_.addBytes(data, bytes);
  file_.write(data, bytes);
}

void CheckpointWriter::commit() {
  file_.write(&sum_, sizeof sum_);
  file_.commit();
  last_commit.store(Clock::now().time_since_epoch().count(), std::memory_order_relaxed);
}

Clock::time_point CheckpointWriter::lastCommit() {
  return Clock::time_point(Clock::duration(last_commit.load(std::memory_order_relaxed)));
}

CheckpointReader::CheckpointReader(const std::filesystem::path& path, const CheckpointKind& kind,
                                   const Fingerprint& fingerprint)
    : path_(path), in_(path, std::ios::binary) {
  if (!in_) throw Error(path.string(), "cannot be read");
  Header header;
  in_.read(reinterpret_cast<char*>(&header), sizeof header);
  if (!in_ || !std::equal(std::begin(kind.magic), std::end(kind.magic), header.magic)) {
    refuse(fmt::format("is not a checkpoint of {}", kind.work));
  }
  if (header.version != kind.version || header.byte_order != kByteOrder) {
    refuse("is a checkpoint of another version or kind of machine");
  }
  if (!(header.fingerprint == fingerprint)) {
    refuse(fmt::format("is the checkpoint of {} of another scene or with other options", kind.work));
  }
  sum_.addBytes(&header, sizeof header);
}

void CheckpointReader::read(void* data, std::size_t bytes) {
  in_.read(static_cast<char*>(data), std::streamsize(bytes));
  if (!in_) damaged("it ends too early");
  sum_.addBytes(data, bytes);
}

void CheckpointReader::finish() {
  Fingerprint expected;
  in_.read(reinterpret_cast<char*>(&expected), sizeof expected);
  if (!in_ || !(expected == sum_)) damaged("its checksum differs");
}

void CheckpointReader::damaged(const char* what) const {
  refuse(fmt::format("is a damaged checkpoint ({})", what));
}

void CheckpointReader::refuse(const std::string& what) const {
  throw Error(path_.string(), what + "; delete it or name another checkpoint");
}

}  // namespace gloam
