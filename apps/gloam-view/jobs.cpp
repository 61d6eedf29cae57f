// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "jobs.h"

namespace gloam::view {

Jobs::Jobs(std::function<void()> wake) : wake_(std::move(wake)), thread_([this] { run(); }) {}

Jobs::~Jobs() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = cancelled_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  thread_.join();
}

void Jobs::start(std::string what, Work work, std::function<void(const std::string&)> failed) {
  {
    const std::lock_guard lock(mutex_);
    if (!status_.busy) status_ = {true, what, "", 0.0};
    waiting_.push_back({std::move(what), std::move(work), std::move(failed)});
  }
  changed_.notify_all();
}

void Jobs::cancel() {
  const std::lock_guard lock(mutex_);
  for (const Job& job : waiting_) finished_.push_back([failed = job.failed] { failed(""); });
  waiting_.clear();
  cancelled_ = true;
}

Jobs::Status Jobs::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::vector<std::string> Jobs::take() {
  std::deque<Finish> finished;
  std::vector<std::string> remarks;
  {
    const std::lock_guard lock(mutex_);
    finished.swap(finished_);
    remarks.swap(remarks_);
  }
  for (const Finish& finish : finished) finish();
  return remarks;
}

void Jobs::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return quit_ || !waiting_.empty(); });
    if (quit_) return;
    const Job job = std::move(waiting_.front());
    waiting_.pop_front();
    cancelled_ = false;
    status_ = {true, job.what, "", 0.0};
    lock.unlock();
    runOne(job);
    lock.lock();
    status_.busy = !waiting_.empty();
    lock.unlock();
    wake_();
    lock.lock();
  }
}

void Jobs::runOne(const Job& job) {
  Progress progress;
  // The window looks at it ten times a second: it needs no waking for each step.
  progress.update = [this](double fraction, const std::string& what) {
    const std::lock_guard lock(mutex_);
    status_.fraction = fraction;
    status_.step = what;
  };
  progress.should_stop = [this] {
    const std::lock_guard lock(mutex_);
    return cancelled_;
  };
  JobConsole console(progress);
  Finish finish;
  try {
    finish = job.work(console);
  } catch (const Interrupted&) {
    finish = [failed = job.failed] { failed(""); };
  } catch (const std::bad_alloc&) {
    finish = [failed = job.failed] { failed("out of memory"); };
  } catch (const std::exception& error) {
    finish = [failed = job.failed, text = std::string(error.what())] { failed(text); };
  }
  const std::lock_guard lock(mutex_);
  finished_.push_back(std::move(finish));
  remarks_.insert(remarks_.end(), console.lines.begin(), console.lines.end());
}

}  // namespace gloam::view
