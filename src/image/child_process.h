// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A program that reads what we send it.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <string>
#include <vector>

namespace gloam {

/// Runs a program found on PATH without a shell: arguments arrive as they are. Its input comes from send(), its output
/// is dropped, what it says on standard error is kept. It runs in a process group of its own, so that Ctrl-C reaches
/// only us; it is ended with this object.
class ChildProcess {
 public:
  /// Throws std::system_error (ENOENT where there is no such program).
  explicit ChildProcess(const std::vector<std::string>& arguments);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// False where the program no longer reads. Never raises SIGPIPE.
  bool send(const void* bytes, std::size_t size);
  /// Ends its input, waits, returns its exit status (128 + signal where one ended it).
  int wait();
  /// The last line that it wrote to standard error.
  std::string lastWords();
  /// The first.
  std::string firstWords();

 private:
  std::vector<std::string> lines();

  pid_t pid_ = -1;
  int input_ = -1;
  std::FILE* errors_ = nullptr;
};

}  // namespace gloam
