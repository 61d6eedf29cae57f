// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Long work in the background, one piece after the other: reading files, baking, fitting spheres. The window goes on, shows how
// far it is, and takes the result when it is done.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "console.h"

namespace gloam::view {

/// Remarks are kept for the window's messages, progress for its bar.
class JobConsole : public cli::Console {
 public:
  explicit JobConsole(Progress progress) : progress_(std::move(progress)) {}
  void remark(const std::string& line) override { lines.push_back(line); }
  Progress progress() override { return progress_; }
  void endProgress() override {}

  std::vector<std::string> lines;

 private:
  Progress progress_;
};

class Jobs {
 public:
  /// `wake` is called from the thread when something has changed.
  explicit Jobs(std::function<void()> wake);
  ~Jobs();  ///< asks what runs to stop, and waits for it
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  /// Work on the thread of jobs; what it returns runs in take() on the window's. Throws are handed to `failed` there.
  using Finish = std::function<void()>;
  using Work = std::function<Finish(JobConsole&)>;
  void start(std::string what, Work work, std::function<void(const std::string&)> failed);
  void cancel();  ///< the piece that runs; those behind it are dropped

  struct Status {
    bool busy = false;
    std::string what, step;
    double fraction = 0.0;
  };
  Status status() const;
  /// Runs on the calling thread what finished jobs left. Remarks of all of them come back.
  std::vector<std::string> take();

 private:
  struct Job {
    std::string what;
    Work work;
    std::function<void(const std::string&)> failed;
  };
  void run();
  void runOne(const Job& job);

  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> waiting_;
  std::deque<Finish> finished_;
  std::vector<std::string> remarks_;
  Status status_;
  bool quit_ = false, cancelled_ = false;
  std::thread thread_;
};

}  // namespace gloam::view
