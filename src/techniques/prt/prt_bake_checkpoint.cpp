// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The checkpoint of a bake: a header, which blocks are done, and their rows. Numbers are as the machine has them; the
// header holds a pattern that another byte order would break.
#include <fstream>

#include "image/atomic_file.h"
#include "techniques/prt/prt_bake_state.h"

namespace gloam::prt {
namespace {

constexpr char kMagic[8] = {'g', 'l', 'o', 'a', 'm', 'p', 'r', 't'};
constexpr std::uint32_t kVersion = 1;  // to be raised when a bake's numbers change

struct Header {
  char magic[8] = {};
  std::uint32_t version = 0;
  std::uint32_t byte_order = 0;
  Fingerprint fingerprint;
  std::uint64_t blocks = 0;
  std::uint32_t pass = 0;
  std::uint32_t unused = 0;
};

// Follows every byte of the rest of the file, header included.
using Checksum = Fingerprint;

// Calls visit(data, bytes) for all that a checkpoint holds, in its order: first what earlier passes finished, then the
// done blocks of this pass.
template <class State, class Visit>
void forContents(State& state, const std::vector<std::uint8_t>& done, const Visit& visit) {
  const auto rows = [&](auto& values, std::size_t begin, std::size_t end, std::size_t row) {
    if (row > 0 && end > begin) visit(&values[begin * row], (end - begin) * row * sizeof(values[0]));
  };
  const auto firstPass = [&](std::size_t begin, std::size_t end) {
    rows(state.direct, begin, end, std::size_t(state.coefficients));
    rows(state.sites, begin, end, 1);
    rows(state.blocked, begin, end, state.bounce_tiles);
  };
  if (state.pass > 0) {
    firstPass(0, state.points);
    rows(state.previous, 0, state.points, state.row);
    rows(state.indirect, 0, state.points, state.row);
  }
  for (std::size_t b = 0; b < state.blocks; ++b) {
    if (!done[b]) continue;
    if (state.pass == 0) {
      firstPass(state.blockBegin(b), state.blockEnd(b));
    } else {
      rows(state.next, state.blockBegin(b), state.blockEnd(b), state.row);
    }
  }
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
  throw Error(path.string(), what + "; delete it or name another checkpoint");
}

Header readHeader(std::ifstream& in, const std::filesystem::path& path, const Fingerprint& fingerprint,
                  const BakeState& state) {
  Header header;
  in.read(reinterpret_cast<char*>(&header), sizeof header);
  if (!in || !std::equal(std::begin(kMagic), std::end(kMagic), header.magic)) {
    refuse(path, "is not a checkpoint of a bake");
  }
  if (header.version != kVersion || header.byte_order != 0x01020304u) {
    refuse(path, "is a checkpoint of another version or kind of machine");
  }
  if (!(header.fingerprint == fingerprint) || header.blocks != state.blocks) {
    refuse(path, "is the checkpoint of another scene or of other bake options");
  }
  if (header.pass > std::uint32_t(state.bounces)) refuse(path, "is a damaged checkpoint (pass)");
  return header;
}

}  // namespace

void writeCheckpoint(const std::filesystem::path& path, const Fingerprint& fingerprint,
                     const BakeState& state) {
  Header header;
  std::copy(std::begin(kMagic), std::end(kMagic), header.magic);
  header.version = kVersion;
  header.byte_order = 0x01020304u;
  header.fingerprint = fingerprint;
  header.blocks = state.blocks;
  header.pass = std::uint32_t(state.pass);
  std::vector<std::uint8_t> done(state.blocks);
  for (std::size_t b = 0; b < state.blocks; ++b)
    done[b] = state.block_done[b].load(std::memory_order_acquire);

  AtomicFile file(path);
  Checksum sum;
  const auto write = [&](const void* data, std::size_t bytes) {
    sum.add(data, bytes);
    file.write(data, bytes);
  };
  write(&header, sizeof header);
  write(done.data(), done.size());
  forContents(state, done, write);
  const Checksum total = sum;
  file.write(&total, sizeof total);
  file.commit();
}

bool readCheckpoint(const std::filesystem::path& path, const Fingerprint& fingerprint, BakeState& state) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return false;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path.string(), "cannot be read");
  const Header header = readHeader(in, path, fingerprint, state);
  Checksum sum;
  sum.add(&header, sizeof header);
  const auto read = [&](void* data, std::size_t bytes) {
    in.read(static_cast<char*>(data), std::streamsize(bytes));
    if (!in) refuse(path, "is a damaged checkpoint (it ends too early)");
    sum.add(data, bytes);
  };
  std::vector<std::uint8_t> done(state.blocks);
  read(done.data(), done.size());
  for (const std::uint8_t flag : done) {
    if (flag > 1) refuse(path, "is a damaged checkpoint (blocks)");
  }
  state.pass = int(header.pass);
  forContents(state, done, read);
  Checksum expected;
  in.read(reinterpret_cast<char*>(&expected), sizeof expected);
  if (!in || !(expected == sum)) refuse(path, "is a damaged checkpoint (its checksum differs)");
  for (std::size_t b = 0; b < state.blocks; ++b)
    state.block_done[b].store(done[b], std::memory_order_release);
  return true;
}

}  // namespace gloam::prt
