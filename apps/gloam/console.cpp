// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "console.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <utility>

namespace gloam::cli {
namespace {

std::atomic<bool> interrupt_seen{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler writes it");

extern "C" void onInterrupt(int signal) {
  interrupt_seen = true;
  std::signal(signal, SIG_DFL);
}

constexpr double kBarSeconds = 0.1;    // between two drawings of the bar
constexpr double kLineSeconds = 10.0;  // between two lines in a log

}  // namespace

void catchInterrupts() {
  std::signal(SIGINT, onInterrupt);
  std::signal(SIGTERM, onInterrupt);
}

bool interrupted() {
  return interrupt_seen;
}

void Console::remark(const std::string& line) {
  if (quiet) return;
  if (!released_) {
    held_.push_back(line);
    return;
  }
  if (!said_.insert(line).second) return;
  endProgress();
  fmt::print(stderr, "gloam: {}\n", singleLine(line));
}

void Console::release() {
  released_ = true;
  for (const std::string& line : std::exchange(held_, {})) remark(line);
}

void Console::remarks(const std::string& place, const Warnings& warnings) {
  for (const std::string& warning : warnings) {
    remark(warning.starts_with(place) ? warning : fmt::format("{}: {}", place, warning));
  }
}

void Console::print(const std::string& line) {
  endProgress();
  fmt::print("{}\n", line);
}

Progress Console::progress() {
  last_fraction_ = 2.0;
  Progress progress;
  progress.should_stop = interrupted;
  if (!quiet) {
    progress.update = [this](double fraction, const std::string& what) { update(fraction, what); };
  }
  return progress;
}

void Console::endProgress() {
  if (!bar_shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  bar_shown_ = false;
}

// Time left follows from the work done since the first report: work that was resumed starts late.
void Console::update(double fraction, const std::string& what) {
  static const bool terminal = isatty(STDERR_FILENO) != 0;
  const Clock::time_point now = Clock::now();
  const auto secondsSince = [&](Clock::time_point then) {
    return std::chrono::duration<double>(now - then).count();
  };
  fraction = std::clamp(fraction, 0.0, 1.0);
  if (fraction < last_fraction_) {
    started_ = now;
    first_fraction_ = fraction;
    if (last_fraction_ > 1.0) shown_ = now;
  }
  last_fraction_ = fraction;
  if (secondsSince(shown_) < (terminal ? kBarSeconds : kLineSeconds)) return;
  shown_ = now;

  std::string left;
  const double elapsed = secondsSince(started_), done = fraction - first_fraction_;
  const bool says_itself =
      what.find(" left") != std::string::npos;  // work that knows better than a straight line
  if (elapsed > 0.5 && done > 0.005 && fraction < 1.0 && !says_itself) {
    left = fmt::format(", {} left", durationText(elapsed * (1.0 - fraction) / done));
  }
  if (terminal) {
    constexpr int kWidth = 24;
    const int full = int(fraction * kWidth);
    fmt::print(stderr, "\r\033[K{} [{}{}] {:.0f} %{}", what, std::string(std::size_t(full), '#'),
               std::string(std::size_t(kWidth - full), '.'), fraction * 100.0, left);
    bar_shown_ = true;
  } else {
    fmt::print(stderr, "gloam: {}: {:.0f} %{}\n", what, fraction * 100.0, left);
  }
  std::fflush(stderr);
}

std::string shellWord(const std::string& word) {
  const bool plain = !word.empty() && std::ranges::all_of(word, [](unsigned char c) {
    return std::isalnum(c) || std::string_view("_-./=:,+@%").find(char(c)) != std::string_view::npos;
  });
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string singleLine(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

std::string durationText(double seconds) {
  if (seconds < 10.0) return fmt::format("{:.1f} s", seconds);
  const long whole = long(std::min(seconds, 3.6e9));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string bytesText(double bytes) {
  constexpr const char* kUnits[] = {"KiB", "MiB", "GiB", "TiB"};
  if (bytes < 1024.0) return fmt::format("{:.0f} bytes", bytes);
  int unit = -1;
  while (bytes >= 1024.0 && unit < 3) bytes /= 1024.0, ++unit;
  return fmt::format("{:.{}f} {}", bytes, bytes < 10.0 ? 1 : 0, kUnits[unit]);
}

std::string countText(std::size_t count) {
  std::string text = std::to_string(count);
  for (int at = int(text.size()) - 3; at > 0; at -= 3) text.insert(std::size_t(at), 1, ',');
  return text;
}

}  // namespace gloam::cli
