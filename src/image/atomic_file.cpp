// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "image/atomic_file.h"

#include <gloam/error.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

namespace gloam {
namespace fs = std::filesystem;

AtomicFile::AtomicFile(fs::path target) : target_(std::move(target)), resolved_(target_) {
  if (target_.empty()) throw Error("cannot write: the file name is empty");
  std::error_code ignored;
  const fs::file_status status = fs::status(target_, ignored);
  if (fs::is_directory(status) || !target_.has_filename())
    throw Error(target_.string(), "cannot write: a file name was expected, this is a folder");
  direct_ = fs::exists(status) && !fs::is_regular_file(status);
  if (fs::is_symlink(fs::symlink_status(target_, ignored)) && !direct_)
    resolved_ = fs::weakly_canonical(target_, ignored);
  const fs::path folder = resolved_.has_parent_path() ? resolved_.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored))
    throw Error(target_.string(), "cannot write: the folder " + folder.string() + " does not exist");
  // A read-only file in a writable folder could be replaced by renaming; whoever made it read-only did not
  // mean that.
  if (fs::exists(status) && ::access(resolved_.c_str(), W_OK) != 0) fail(errno);

  static std::atomic<unsigned> counter{0};
  temporary_ = resolved_;
  if (!direct_)
    temporary_ += ".part-" + std::to_string(::getpid()) + "-" + std::to_string(counter.fetch_add(1));
  errno = 0;
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_) fail(errno);
}

AtomicFile::~AtomicFile() {
  if (committed_) return;
  stream_.close();
  std::error_code ignored;
  if (!direct_) fs::remove(temporary_, ignored);
}

void AtomicFile::write(const void* bytes, std::size_t size) {
  errno = 0;
  stream_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  if (!stream_) fail(errno);
}

void AtomicFile::commit() {
  errno = 0;
  stream_.flush();
  if (!stream_) fail(errno);
  stream_.close();
  if (!stream_) fail(errno);
  if (!direct_) {
    std::error_code error;
    fs::rename(temporary_, resolved_, error);
    if (error) fail(error.value());
  }
  committed_ = true;
}

void AtomicFile::fail(int error_number) const {
  throw Error(target_.string(),
              std::string("cannot write: ") +
                  (error_number != 0 ? std::strerror(error_number) : "no space, or input/output error"));
}

}  // namespace gloam
