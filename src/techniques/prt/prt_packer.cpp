// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_packer.h"

#include <algorithm>
#include <bit>

#include "gpu/format.h"

namespace gloam::prt {

namespace {

std::uint32_t blockCount(std::uint32_t vertices) {
  return (vertices + kBlockVertices - 1) / kBlockVertices;
}

}  // namespace

void packWords(std::span<const float> values, bool half_float, std::uint32_t* words) {
  if (!half_float) {
    for (std::size_t i = 0; i < values.size(); ++i) words[i] = std::bit_cast<std::uint32_t>(values[i]);
    return;
  }
  for (std::size_t i = 0; i < values.size(); i += 2) {
    const std::uint32_t high = i + 1 < values.size() ? gpu::halfFromFloat(values[i + 1]) : 0u;
    words[i / 2] = gpu::halfFromFloat(values[i]) | (high << 16);
  }
}

Packer::Packer(gpu::Device& device, std::string name, std::size_t direct_words, std::size_t indirect_words,
               std::size_t chunk_bytes, bool host_visible)
    : device_(device),
      name_(std::move(name)),
      direct_words_(direct_words),
      indirect_words_(indirect_words),
      host_visible_(host_visible) {
  const std::size_t block_bytes = std::max(direct_words, indirect_words) * kBlockVertices * 4;
  const std::uint64_t bytes = chunk_bytes > 0 ? chunk_bytes : device.limits().max_storage_bytes;
  limit_ = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(bytes / block_bytes, 1, 1u << 24));
  chunks_.emplace_back();
  blocks_.emplace_back();
}

const std::vector<Packer::Part>& Packer::partsOf(std::uint32_t mesh, std::uint32_t vertices,
                                                 const Fill& fill) {
  const auto [place, is_new] = parts_.try_emplace(mesh);
  for (std::uint32_t first = 0; is_new && first < vertices;) {
    if (used_ == limit_) {
      uploadValues();
      chunks_.emplace_back();
      blocks_.emplace_back();
      used_ = 0;
    }
    const std::uint32_t taken = std::min(vertices - first, (limit_ - used_) * kBlockVertices);
    place->second.push_back({chunks_.size() - 1, used_, first, taken});
    append(fill, first, taken);
    used_ += blockCount(taken);
    first += taken;
  }
  return place->second;
}

// The last block is padded with 0.
void Packer::append(const Fill& fill, std::uint32_t first, std::uint32_t count) {
  std::vector<std::uint32_t> direct(direct_words_), indirect(indirect_words_);
  const std::size_t direct_start = direct_.size(), indirect_start = indirect_.size();
  const std::size_t padded = std::size_t(blockCount(count)) * kBlockVertices;
  direct_.resize(direct_start + padded * direct_words_, 0u);
  indirect_.resize(indirect_start + padded * indirect_words_, 0u);
  for (std::uint32_t v = 0; v < count; ++v) {
    fill(first + v, direct.data(), indirect.data());
    const std::size_t block = v / kBlockVertices, lane = v % kBlockVertices;
    for (std::size_t w = 0; w < direct_words_; ++w)
      direct_[direct_start + (block * direct_words_ + w) * kBlockVertices + lane] = direct[w];
    for (std::size_t w = 0; w < indirect_words_; ++w)
      indirect_[indirect_start + (block * indirect_words_ + w) * kBlockVertices + lane] = indirect[w];
  }
}

void Packer::addBlocks(const Part& part, std::uint32_t light, std::uint32_t output) {
  for (std::uint32_t b = 0; b < blockCount(part.vertices); ++b) {
    blocks_[part.chunk].push_back({part.first_block + b, light,
                                   output + part.first_vertex + b * kBlockVertices,
                                   std::min(part.vertices - b * kBlockVertices, kBlockVertices)});
  }
}

void Packer::uploadValues() {
  chunks_.back().direct = filledBuffer(device_, name_ + "_direct", direct_, host_visible_);
  chunks_.back().indirect = filledBuffer(device_, name_ + "_indirect", indirect_, host_visible_);
  direct_.clear();
  indirect_.clear();
}

std::vector<TransferChunk> Packer::finish() {
  uploadValues();
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    chunks_[c].block_count = static_cast<std::uint32_t>(blocks_[c].size());
    chunks_[c].blocks = filledBuffer(device_, name_ + "_blocks", blocks_[c], host_visible_);
  }
  return std::move(chunks_);
}

}  // namespace gloam::prt
