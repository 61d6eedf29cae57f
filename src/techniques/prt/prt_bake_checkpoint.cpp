// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The checkpoint of a bake: which blocks are done, and their rows.
#include "scene/checkpoint_file.h"
#include "techniques/prt/prt_bake_state.h"

namespace gloam::prt {
namespace {

constexpr CheckpointKind kBake{{'g', 'l', 'o', 'a', 'm', 'p', 'r', 't'}, 5, "a bake"};

// Calls visit(data, bytes) for all that a checkpoint holds, in its order: first what earlier passes finished, then the
// done blocks of this pass.
template <class State, class Visit>
void forContents(State& state, const std::vector<std::uint8_t>& done, const Visit& visit) {
  const auto rows = [&](auto& values, std::size_t begin, std::size_t end, std::size_t row) {
    if (row > 0 && end > begin) visit(&values[begin * row], (end - begin) * row * sizeof(values[0]));
  };
  const auto glossyRows = [&](auto& values, std::size_t begin, std::size_t end, std::size_t row) {
    if (!values.empty()) rows(values, state.glossy.first_row[begin], state.glossy.first_row[end], row);
  };
  const std::size_t matrix = state.glossy.layout.matrixSize();
  const auto firstPass = [&](std::size_t begin, std::size_t end) {
    rows(state.direct, begin, end, std::size_t(state.coefficients));
    rows(state.sites, begin, end, 1);
    rows(state.blocked, begin, end, state.bounce_tiles);
    glossyRows(state.glossy.visibility, begin, end, state.glossy.layout.visibilityCount());
  };
  if (state.pass > 0) {
    firstPass(0, state.points);
    rows(state.previous, 0, state.points, state.row);
    rows(state.indirect, 0, state.points, state.row);
    for (auto& earlier : state.earlier) rows(earlier, 0, state.points, state.row);
    if (state.pass > 1 && !state.bounce_used.empty()) rows(state.bounce_used, 0, state.points, 1);
    glossyRows(state.glossy.previous, 0, state.points, matrix);
    glossyRows(state.glossy.sum, 0, state.points, matrix);
  }
  for (std::size_t b = 0; b < state.blocks; ++b) {
    if (!done[b]) continue;
    if (state.pass == 0) {
      firstPass(state.blockBegin(b), state.blockEnd(b));
    } else {
      rows(state.next, state.blockBegin(b), state.blockEnd(b), state.row);
      if (state.pass == 1 && !state.bounce_used.empty())
        rows(state.bounce_used, state.blockBegin(b), state.blockEnd(b), 1);
      glossyRows(state.glossy.next, state.blockBegin(b), state.blockEnd(b), matrix);
    }
  }
}

}  // namespace

void writeCheckpoint(const std::filesystem::path& path, const Fingerprint& fingerprint,
                     const BakeState& state) {
  const auto pass = std::uint32_t(state.pass);
  std::vector<std::uint8_t> done(state.blocks);
  for (std::size_t b = 0; b < state.blocks; ++b)
    done[b] = state.block_done[b].load(std::memory_order_acquire);
  CheckpointWriter file(path, kBake, fingerprint);
  const auto write = [&](const void* data, std::size_t bytes) { file.write(data, bytes); };
  write(&pass, sizeof pass);
  write(done.data(), done.size());
  forContents(state, done, write);
  file.commit();
}

bool readCheckpoint(const std::filesystem::path& path, const Fingerprint& fingerprint, BakeState& state) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return false;
  CheckpointReader file(path, kBake, fingerprint);
  const auto read = [&](void* data, std::size_t bytes) { file.read(data, bytes); };
  std::uint32_t pass = 0;
  read(&pass, sizeof pass);
  if (pass > std::uint32_t(state.bounces)) file.damaged("pass");
  std::vector<std::uint8_t> done(state.blocks);
  read(done.data(), done.size());
  for (const std::uint8_t flag : done) {
    if (flag > 1) file.damaged("blocks");
  }
  state.pass = int(pass);
  forContents(state, done, read);
  file.finish();
  for (std::size_t b = 0; b < state.blocks; ++b)
    state.block_done[b].store(done[b], std::memory_order_release);
  return true;
}

}  // namespace gloam::prt
