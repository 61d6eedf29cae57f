// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "diff_pictures.h"

#include <fmt/core.h>

#include <set>

#include <image/atomic_file.h>
#include <image/color.h>
#include <image/comparison.h>

#include "output.h"

namespace gloam::cli {
namespace {

namespace fs = std::filesystem;

void checkTarget(const std::string& target, const DiffInputs& inputs, std::set<fs::path>& taken) {
  if (target.empty()) return;
  const fs::path path = target;
  if (path.extension() != ".png") throw Error(target, "a name that ends in .png was expected");
  for (const std::string& input : {inputs.picture, inputs.reference, inputs.mask})
    refuseOverwriting(path, input);
  if (!taken.insert(fs::absolute(path).lexically_normal()).second) throw Error(target, "is asked for twice");
  AtomicFile probe(path);
}

/// Where the mask is 0, the colour of no difference.
Image masked(Image picture, const Image& mask, float nothing) {
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    if (mask.pixels[i] != 0.0f) continue;
    for (std::size_t c = 0; c < std::size_t(picture.channels); ++c) {
      picture.pixels[i * std::size_t(picture.channels) + c] = nothing;
    }
  }
  return picture;
}

}  // namespace

DiffOutput::DiffOutput(DiffPictures pictures, const DiffInputs& inputs) : pictures_(std::move(pictures)) {
  if (!pictures_.folder.empty()) {
    const fs::path folder = pictures_.folder;
    std::error_code error;
    if (!fs::is_directory(folder, error)) {
      made_folder_ = fs::create_directory(folder, error);
      if (!made_folder_) {
        throw Error(folder.string(), fmt::format("cannot make this folder: {}",
                                                 error ? error.message() : "a file of that name is there"));
      }
    }
    const auto inFolder = [&](std::string& name, const char* own) {
      if (name.empty()) name = (folder / own).string();
    };
    inFolder(pictures_.difference, "difference.png");
    inFolder(pictures_.signed_difference, "signed_difference.png");
    inFolder(pictures_.false_color, "false_color.png");
    inFolder(pictures_.flip, "flip.png");
    inFolder(pictures_.ldr_flip, "ldr_flip.png");
  }
  try {
    std::set<fs::path> taken;
    for (const std::string& target : {pictures_.difference, pictures_.signed_difference,
                                      pictures_.false_color, pictures_.flip, pictures_.ldr_flip})
      checkTarget(target, inputs, taken);
  } catch (...) {
    removeOwnFolder();
    throw;
  }
}

DiffOutput::~DiffOutput() {
  removeOwnFolder();
}

// Only where nothing came to lie in it: what holds a file stays.
void DiffOutput::removeOwnFolder() {
  std::error_code ignored;
  if (made_folder_) fs::remove(pictures_.folder, ignored);
}

std::vector<fs::path> DiffOutput::write(const DiffPair& pair, const MetricOptions& options,
                                        const Progress& progress) {
  const Image &a = pair.picture, &b = pair.reference;
  std::vector<std::pair<fs::path, Image>> drawn;
  const double factor = double(pictures_.factor);
  if (!pictures_.difference.empty()) {
    const Image picture = absoluteDifferencePicture(a, b, factor, options.display);
    drawn.emplace_back(pictures_.difference, masked(picture, pair.mask, 0.0f));
  }
  if (!pictures_.signed_difference.empty()) {
    const Image picture = differencePicture(a, b, factor, options.display);
    drawn.emplace_back(pictures_.signed_difference, masked(picture, pair.mask, srgbDecode(0.5f)));
  }
  if (!pictures_.false_color.empty()) {
    drawn.emplace_back(pictures_.false_color,
                       masked(falseColor(a, b, double(pictures_.top)), pair.mask, 0.0f));
  }
  if (!pictures_.flip.empty()) {
    const Image map = flipMap(a, b, options.pixels_per_degree, progress);
    drawn.emplace_back(pictures_.flip, magma(masked(map, pair.mask, 0.0f)));
  }
  if (!pictures_.ldr_flip.empty()) {
    const DisplayOptions display = displayFor(b, options.display);
    const Image map =
        ldrFlipMap(toneMapped(a, display), toneMapped(b, display), options.pixels_per_degree, progress);
    drawn.emplace_back(pictures_.ldr_flip, magma(masked(map, pair.mask, 0.0f)));
  }
  std::vector<fs::path> files;
  for (const auto& [path, picture] : drawn) {
    writePng(picture, path);
    files.push_back(path);
  }
  return files;
}

}  // namespace gloam::cli
