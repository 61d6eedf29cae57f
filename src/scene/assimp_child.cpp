// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A library that broken files can crash, kept at arm's length: it runs in a forked child with limits, and its result
// comes back through a pipe. Threads of this process do not exist in the child, which therefore does nothing but read the
// file, write to the pipe and leave.
#include <fmt/format.h>

#include "scene/assimp_read.h"

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <new>
#include <vector>

#include "scene/scene_archive.h"

namespace gloam {
namespace {

enum Verdict : std::uint8_t { kScene = 1, kError, kNoMemory };

void writeAll(int pipe, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(pipe, at, std::min<std::size_t>(size, 1 << 20));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) _exit(1);
    at += written, size -= static_cast<std::size_t>(written);
  }
}

/// Address space is limited rather than resident memory, as that is what makes an allocation fail. Sanitizers reserve
/// terabytes of it and go without.
void limitMemory([[maybe_unused]] std::uint64_t bytes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  std::ifstream statm("/proc/self/statm");
  std::uint64_t pages = 0;
  constexpr std::uint64_t kUsualBytes = std::uint64_t{1}
                                        << 30;  // what a process may hold already where /proc is missing
  const auto page_bytes = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  if (!(statm >> pages)) pages = kUsualBytes / page_bytes;
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0) return;
  const std::uint64_t wanted = pages * page_bytes + bytes;
  if (limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur < wanted) return;
  limit.rlim_cur = wanted;
  setrlimit(RLIMIT_AS, &limit);
#endif
}

[[noreturn]] void childMain(int pipe, const std::filesystem::path& path, double seconds, std::uint64_t bytes,
                            Scene (*work)(const std::filesystem::path&)) {
  for (const int signal_number : {SIGINT, SIGTERM, SIGSEGV, SIGABRT, SIGXCPU, SIGFPE, SIGBUS, SIGILL})
    signal(signal_number, SIG_DFL);
  signal(SIGINT, SIG_IGN);  // the parent ends us
  if (const int null = open("/dev/null", O_RDWR); null >= 0)
    dup2(null, 1), dup2(null, 2);  // the C library's last words
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const auto cpu = static_cast<rlim_t>(std::ceil(seconds));
  const rlimit cpu_limit{cpu, cpu + 1};
  setrlimit(RLIMIT_CPU, &cpu_limit);
  limitMemory(bytes);

  Verdict verdict = kScene;
  std::vector<std::uint8_t> packed;
  std::string message;
  try {
    Scene scene = work(path);
    packed = packScene(scene);
  } catch (const std::bad_alloc&) {
    verdict = kNoMemory;
  } catch (const std::exception& error) {
    verdict = kError;
    message = error.what();
  }
  writeAll(pipe, &verdict, 1);
  if (verdict == kScene)
    writeAll(pipe, packed.data(), packed.size());
  else
    writeAll(pipe, message.data(), message.size());
  _exit(0);
}

class Child {
 public:
  Child(const std::filesystem::path& path, double seconds, std::uint64_t bytes,
        Scene (*work)(const std::filesystem::path&)) {
    int ends[2];
    if (pipe(ends) != 0)
      throw Error(path.string(), std::string("cannot make a pipe: ") + std::strerror(errno));
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    pid_ = fork();
    if (pid_ == 0) {
      close(ends[0]);
      childMain(ends[1], path, seconds, bytes, work);
    }
    const int reason = errno;
    close(ends[1]);
    output_ = ends[0];
    if (pid_ < 0) {
      close(output_);
      throw Error(path.string(), std::string("cannot start a process: ") + std::strerror(reason));
    }
  }
  ~Child() {
    close(output_);
    if (pid_ > 0) kill(pid_, SIGKILL), wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Waits up to `milliseconds` for more output; false at its end.
  bool readMore(std::vector<std::uint8_t>& output, int milliseconds) {
    pollfd poll_end{output_, POLLIN, 0};
    if (poll(&poll_end, 1, milliseconds) <= 0) return true;
    constexpr std::size_t kChunk = std::size_t(1) << 20;
    const std::size_t at = output.size();
    output.resize(at + kChunk);
    const ssize_t got = read(output_, &output[at], kChunk);
    output.resize(at + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    return got > 0 || (got < 0 && errno == EINTR);
  }
  /// The signal that ended it, or 0.
  int wait() {
    int status = 0;
    pid_t waited = 0;
    while ((waited = waitpid(pid_, &status, 0)) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return waited > 0 && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }

 private:
  pid_t pid_ = -1;
  int output_ = -1;
};

}  // namespace

Scene importInChild(const std::filesystem::path& path, double seconds, std::uint64_t bytes,
                    const Progress& progress, Scene (*work)(const std::filesystem::path&)) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const double patience =
      seconds + 3.0;  // the child's own clock counts its CPU time; other programs may be busy too
  const Error too_slow(
      path.string(), fmt::format("assimp was not done with it after {:.0f} s, ample for its size", seconds));
  std::vector<std::uint8_t> output;
  Child child(path, seconds, bytes, work);
  while (child.readMore(output, 50)) {
    const double passed = std::chrono::duration<double>(Clock::now() - start).count();
    if (progress.stopRequested()) throw Interrupted("reading was interrupted");
    if (passed > patience) throw too_slow;
    if (output.size() > bytes) throw Error(path.string(), "assimp made more of it than its size justifies");
  }
  const int signal_number = child.wait();
  if (signal_number == SIGXCPU) throw too_slow;
  if (signal_number != 0 || output.empty())
    throw Error(path.string(),
                fmt::format("assimp crashed on it (signal {}): the file is broken", signal_number));
  const std::span<const std::uint8_t> payload(output.data() + 1, output.size() - 1);
  if (output[0] == kNoMemory)
    throw Error(
        path.string(),
        fmt::format("assimp needed more than {} MB for it: it claims more than it holds, or is broken",
                    bytes / 1000000));
  if (output[0] != kScene) throw Error(std::string(payload.begin(), payload.end()));
  return unpackScene(payload);
}

}  // namespace gloam

#else

namespace gloam {
Scene importInChild(const std::filesystem::path& path, double, std::uint64_t, const Progress&,
                    Scene (*work)(const std::filesystem::path&)) {
  return work(path);
}
}  // namespace gloam

#endif
