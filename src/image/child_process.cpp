// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Input goes through a socket, not a pipe: send() can be told not to raise SIGPIPE, without touching the signal
// settings of the program that uses us. Standard error goes to a nameless file: nobody waits for a full pipe.
#include "image/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "image/limits.h"

extern char** environ;

namespace gloam {
namespace {

// posix_spawn's two sets of settings, freed on every way out.
struct Settings {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  Settings() {
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
    sigset_t none, defaults;
    sigemptyset(&none);
    sigemptyset(&defaults);
    for (const int signal : {SIGPIPE, SIGINT, SIGTERM}) sigaddset(&defaults, signal);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~Settings() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
};

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments) {
  int ends[2] = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw std::system_error(errno, std::generic_category());
  ::shutdown(ends[1], SHUT_WR);
  errors_ = std::tmpfile();
  int error = errors_ ? 0 : errno;
  if (error == 0) {
    ::fcntl(::fileno(errors_), F_SETFD, FD_CLOEXEC);
    Settings settings;
    posix_spawn_file_actions_adddup2(&settings.files, ends[1], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&settings.files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&settings.files, ::fileno(errors_), STDERR_FILENO);
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    error = ::posix_spawnp(&pid_, argv[0], &settings.files, &settings.attributes, argv.data(), environ);
  }
  ::close(ends[1]);
  input_ = ends[0];
  if (error == 0) return;
  ::close(input_);
  if (errors_) std::fclose(errors_);
  throw std::system_error(error, std::generic_category());
}

ChildProcess::~ChildProcess() {
  if (pid_ > 0) ::kill(pid_, SIGKILL);
  wait();
  if (errors_) std::fclose(errors_);
}

bool ChildProcess::send(const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t sent = ::send(input_, at, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

int ChildProcess::wait() {
  if (input_ >= 0) ::close(input_);
  input_ = -1;
  if (pid_ <= 0) return -1;
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0)
    if (errno != EINTR) break;
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Of what it wrote to standard error, those with something in them.
std::vector<std::string> ChildProcess::lines() {
  std::rewind(errors_);
  std::vector<std::string> found;
  std::string line;
  for (int c = std::fgetc(errors_); c != EOF; c = std::fgetc(errors_)) {
    if (c != '\n')
      line += static_cast<char>(c);
    else if (!line.empty())
      found.push_back(std::exchange(line, {}));
  }
  if (!line.empty()) found.push_back(line);
  return found;
}

std::string ChildProcess::lastWords() {
  const auto said = lines();
  return said.empty() ? "" : oneLine(said.back());
}

std::string ChildProcess::firstWords() {
  const auto said = lines();
  return said.empty() ? "" : oneLine(said.front());
}

}  // namespace gloam
