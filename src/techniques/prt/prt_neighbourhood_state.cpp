// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_neighbourhood_state.h"

#include <fmt/format.h>

#include "scene/checkpoint_file.h"

namespace gloam::prt {
namespace {

constexpr CheckpointKind kNeighbourhood{
    {'g', 'l', 'o', 'a', 'm', 'n', 'b', 'h'}, 2, "a neighbourhood's bake"};

/// The rows of the blocks that are done: visit(data, bytes).
template <class State, class Visit>
void forRows(State& state, const std::vector<std::uint8_t>& done, const Visit& visit) {
  auto& grid = state.grid;
  for (std::size_t b = 0; b < state.blocks; ++b) {
    if (!done[b]) continue;
    const std::size_t begin = state.blockBegin(b), count = state.blockEnd(b) - begin;
    const auto rows = [&](auto& values, std::size_t row) {
      if (!values.empty()) visit(&values[begin * row], count * row * sizeof(values[0]));
    };
    rows(state.inside, 1);
    rows(state.samples, kCellSamples * grid.visibilityCount());
    rows(state.sample_inside, kCellSamples);
    rows(grid.visibility, grid.visibilityCount());
    rows(grid.indirect, 3 * grid.matrixCount());
  }
}

}  // namespace

void NeighbourhoodState::begin() {
  inside.resize(grid.points());
  samples.resize(grid.points() * kCellSamples * grid.visibilityCount());
  sample_inside.resize(grid.points() * kCellSamples);
  blocks = (grid.points() + kNeighbourhoodBlock - 1) / kNeighbourhoodBlock;
  block_done = std::make_unique<std::atomic<std::uint8_t>[]>(blocks);
}

void writeNeighbourhood(const std::filesystem::path& path, const Fingerprint& fingerprint,
                        const NeighbourhoodState& state) {
  std::vector<std::uint8_t> done(state.blocks);
  for (std::size_t b = 0; b < state.blocks; ++b)
    done[b] = state.block_done[b].load(std::memory_order_acquire);
  CheckpointWriter file(path, kNeighbourhood, fingerprint);
  file.write(done.data(), done.size());
  forRows(state, done, [&](const void* data, std::size_t bytes) { file.write(data, bytes); });
  file.commit();
}

bool readNeighbourhood(const std::filesystem::path& path, const Fingerprint& fingerprint,
                       NeighbourhoodState& state) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return false;
  CheckpointReader file(path, kNeighbourhood, fingerprint);
  std::vector<std::uint8_t> done(state.blocks);
  file.read(done.data(), done.size());
  for (const std::uint8_t flag : done) {
    if (flag > 1) file.damaged("blocks");
  }
  forRows(state, done, [&](void* data, std::size_t bytes) { file.read(data, bytes); });
  file.finish();
  for (std::size_t b = 0; b < state.blocks; ++b)
    state.block_done[b].store(done[b], std::memory_order_release);
  return true;
}

NeighbourhoodMeter::NeighbourhoodMeter(const Progress& progress, const std::filesystem::path& checkpoint,
                                       const Fingerprint& fingerprint, const NeighbourhoodState& state)
    : progress_(progress), checkpoint_(checkpoint), fingerprint_(fingerprint), state_(state) {
  report();
}

double NeighbourhoodMeter::fractionDone() const {
  std::size_t done = 0;
  for (std::size_t b = 0; b < state_.blocks; ++b)
    done += state_.block_done[b].load(std::memory_order_relaxed);
  return double(done) / double(state_.blocks);
}

void NeighbourhoodMeter::report() {
  last_report_ = Clock::now();
  if (!progress_.update) return;
  const double seconds = std::chrono::duration<double>(last_report_ - start_).count();
  std::string what = "bake: neighbourhood";
  if (const double rays = double(rays_.load()); rays > 0.0 && seconds > 0.01)
    what += fmt::format(", {:.1f} Mrays, {:.1f} Mrays/s", rays * 1e-6, rays * 1e-6 / seconds);
  progress_.report(fractionDone(), what);
}

void NeighbourhoodMeter::save() {
  if (checkpoint_.empty()) return;
  const auto begin = Clock::now();
  writeNeighbourhood(checkpoint_, fingerprint_, state_);
  // As BakeMeter: at most a tenth of the time goes into it.
  save_interval_ = std::max<Clock::duration>(std::chrono::seconds(20), 10 * (Clock::now() - begin));
}

bool NeighbourhoodMeter::blockDone(std::size_t rays) {
  rays_ += rays;
  fresh_ = true;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (lock && !stopped_) {
    const auto now = Clock::now();
    if (progress_.stopRequested()) stopped_ = true;
    if (!stopped_ && now - last_report_ > std::chrono::milliseconds(100)) report();
    if (!stopped_ && now - CheckpointWriter::lastCommit() > save_interval_) save();
  }
  return !stopped_;
}

void NeighbourhoodMeter::interrupt() {
  save();
  const double percent = 100.0 * fractionDone();
  if (checkpoint_.empty())
    throw Interrupted(fmt::format("bake stopped at {:.0f} %; without a checkpoint nothing is kept", percent));
  throw Interrupted(
      fmt::format("bake stopped at {:.0f} %; {} keeps the work, the same command goes on from there", percent,
                  checkpoint_.string()));
}

}  // namespace gloam::prt
