// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_volume_state.h"

#include <fmt/format.h>

#include "scene/checkpoint_file.h"
#include "techniques/prt/prt_bake_kernels.h"

namespace gloam::prt {
namespace {

constexpr CheckpointKind kVolumes{{'g', 'l', 'o', 'a', 'm', 'v', 'o', 'l'}, 2, "a bake of volumes"};

Fingerprint fingerprintOf(const Scene& scene, const VolumeBakeOptions& options) {
  Fingerprint print;
  add(print, scene);
  const auto& [order, scatterings, directions, scatter_directions, threads, time_s, memory_bytes, checkpoint,
               keep_checkpoint] = options;
  addAll(print, order, scatterings, directions, scatter_directions, time_s, std::string(kernelTarget()));
  return print;
}

/// Calls visit(data, bytes) for all that a checkpoint holds of a volume but its pass and which blocks are done.
template <class State, class Visit>
void forContents(State& state, const std::vector<std::uint8_t>& done, const Visit& visit) {
  const auto all = [&](auto& values) { visit(values.data(), values.size() * sizeof(values[0])); };
  if (state.pass > 0) {
    all(state.transfer.direct);
    all(state.transfer.indirect);
    visit(&state.even, sizeof state.even);
    visit(&state.even_last, sizeof state.even_last);
  }
  if (state.finished()) return;
  if (state.pass > 0) all(state.now);
  for (std::size_t b = 0; b < state.blocks; ++b)
    if (done[b])
      visit(&state.next[state.blockBegin(b) * state.row],
            (state.blockEnd(b) - state.blockBegin(b)) * state.row * sizeof(float));
}

}  // namespace

void VolumeState::begin(const Volume& volume, std::size_t filled_voxels, const VolumeBakeOptions& options) {
  const std::size_t coefficients = std::size_t(options.order * options.order);
  filled = filled_voxels;
  row = (coefficients + 3) / 4 * 4;
  passes = options.scatterings;
  now.assign(filled * row, 0.0f);
  next = now;
  transfer.order = options.order;
  transfer.bounces = options.scatterings - 1;
  transfer.directions = options.directions;
  transfer.direct.assign(volume.voxels() * coefficients, 0.0f);
  if (transfer.bounces > 0) transfer.indirect.assign(3 * transfer.direct.size(), 0.0f);
  blocks = (filled + kVolumeBlock - 1) / kVolumeBlock;
  block_done = std::make_unique<std::atomic<std::uint8_t>[]>(blocks);
}

std::size_t VolumeState::blocksDone() const {
  std::size_t done = 0;
  for (std::size_t b = 0; b < blocks; ++b) done += block_done[b].load(std::memory_order_relaxed);
  return done;
}

void VolumeState::nextPass() {
  ++pass;
  for (std::size_t b = 0; b < blocks; ++b) block_done[b] = 0;
  if (finished()) now = next = {};
}

VolumeMeter::VolumeMeter(const Scene& scene, const std::vector<const Volume*>& volumes,
                         const std::vector<std::size_t>& filled, const VolumeBakeOptions& options,
                         const Progress& progress, std::vector<VolumeState>& states)
    : options_(options), progress_(progress), states_(states) {
  for (const std::size_t voxels : filled)
    work_ += double(voxels) * (double(options.directions) +
                               double(options.scatterings - 1) * double(options.scatter_directions));
  if (!options.checkpoint.empty()) {
    fingerprint_ = fingerprintOf(scene, options);
    resumed_ = read(volumes, filled);
  }
  progress_.report(fractionDone(), "bake: volumes");
}

bool VolumeMeter::read(const std::vector<const Volume*>& volumes, const std::vector<std::size_t>& filled) {
  std::error_code none;
  if (!std::filesystem::exists(options_.checkpoint, none)) return false;
  CheckpointReader file(options_.checkpoint, kVolumes, fingerprint_);
  const auto take = [&](void* data, std::size_t bytes) { file.read(data, bytes); };
  for (std::size_t v = 0; v < states_.size(); ++v) {
    std::int32_t pass = -1;
    take(&pass, sizeof pass);
    if (pass < -1 || pass > options_.scatterings) file.damaged("pass");
    if (pass < 0) continue;
    VolumeState& state = states_[v];
    state.begin(*volumes[v], filled[v], options_);
    state.pass = pass;
    if (state.finished()) state.now = state.next = {};
    std::vector<std::uint8_t> done(state.blocks);
    take(done.data(), done.size());
    for (std::size_t b = 0; b < done.size(); ++b) {
      if (done[b] > 1) file.damaged("blocks");
      state.block_done[b] = done[b];
    }
    forContents(state, done, take);
  }
  file.finish();
  return true;
}

void VolumeMeter::save() {
  if (options_.checkpoint.empty()) return;
  const auto begin = Clock::now();
  CheckpointWriter file(options_.checkpoint, kVolumes, fingerprint_);
  const auto write = [&](const void* data, std::size_t bytes) { file.write(data, bytes); };
  for (const VolumeState& state : states_) {
    const std::int32_t pass = state.begun() ? state.pass : -1;
    write(&pass, sizeof pass);
    if (pass < 0) continue;
    std::vector<std::uint8_t> done(state.blocks);
    for (std::size_t b = 0; b < state.blocks; ++b)
      done[b] = state.block_done[b].load(std::memory_order_acquire);
    write(done.data(), done.size());
    forContents(state, done, write);
  }
  file.commit();
  // As BakeMeter: at most a tenth of the time goes into it.
  save_interval_ = std::max<Clock::duration>(std::chrono::seconds(20), 10 * (Clock::now() - begin));
}

double VolumeMeter::fractionDone() const {
  double done = 0.0;
  for (const VolumeState& state : states_) {
    if (!state.begun()) continue;
    const auto look = double(options_.directions), gather = double(options_.scatter_directions);
    if (state.pass > 0) done += double(state.filled) * (look + double(state.pass - 1) * gather);
    done += double(state.blocksDone() * kVolumeBlock) * (state.pass > 0 ? gather : look);
  }
  return work_ > 0.0 ? std::min(1.0, done / work_) : 1.0;
}

bool VolumeMeter::blockDone() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (lock && !stopped_) {
    const auto now = Clock::now();
    if (progress_.stopRequested()) stopped_ = true;
    if (!stopped_ && now - last_report_ > std::chrono::milliseconds(100)) {
      last_report_ = now;
      progress_.report(fractionDone(), "bake: volumes");
    }
    if (!stopped_ && now - CheckpointWriter::lastCommit() > save_interval_) save();
  }
  return !stopped_;
}

void VolumeMeter::interrupt() {
  save();
  const double percent = 100.0 * fractionDone();
  if (options_.checkpoint.empty())
    throw Interrupted(
        fmt::format("bake of volumes stopped at {:.0f} %; without a checkpoint nothing is kept", percent));
  throw Interrupted(fmt::format(
      "bake of volumes stopped at {:.0f} %; {} keeps the work, the same command goes on from there", percent,
      options_.checkpoint.string()));
}

void VolumeMeter::end() {
  std::error_code ignored;
  if (options_.keep_checkpoint)
    save();
  else if (!options_.checkpoint.empty())
    std::filesystem::remove(options_.checkpoint, ignored);
}

}  // namespace gloam::prt
