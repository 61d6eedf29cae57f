// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bake_checkpoints.h"

#include <fmt/core.h>
#include <gloam/bake.h>

namespace gloam::cli {

namespace fs = std::filesystem;

BakeCheckpoints::BakeCheckpoints(const fs::path& output) : transfer_(output.string() + ".checkpoint") {}

fs::path BakeCheckpoints::neighbourhood(std::size_t n) const {
  return transfer_.string() + fmt::format(".neighbourhood{}", n);
}

void BakeCheckpoints::remove() const {
  std::error_code ignored;
  removeBakeCheckpoint(transfer_);
  fs::remove(volumes(), ignored);
  for (std::size_t n = 0; fs::remove(neighbourhood(n), ignored);) ++n;
}

fs::path BakeCheckpoints::any() const {
  std::error_code ignored;
  for (const fs::path& path : {transfer_, volumes(), neighbourhood(0)})
    if (fs::exists(path, ignored)) return path;
  return {};
}

void BakeCheckpoints::guard(const std::function<void()>& work) const {
  try {
    work();
  } catch (const Interrupted&) {
    const fs::path kept = any();
    throw Interrupted(kept.empty()
                          ? "interrupted before anything was finished"
                          : fmt::format("interrupted; the same command goes on from {}", kept.string()));
  } catch (const Error& error) {
    const std::string text = error.what();
    if (!text.starts_with(transfer_.string())) throw;
    throw Error(text.substr(0, text.find("; delete it")) + "; --no-resume starts anew");
  }
}

}  // namespace gloam::cli
