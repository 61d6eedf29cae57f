// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What is read and saved: files that were dropped, presets, pictures, videos.
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "file_names.h"
#include "session.h"

namespace gloam::view {
namespace {

std::string lowerExtension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

}  // namespace

void Session::openDropped(const std::string& path) {
  const std::string extension = lowerExtension(path);
  if (extension == ".json") {
    loadPreset(path);
  } else if (extension == ".hdr" || extension == ".exr") {
    openEnvironment(path);
  } else {
    open(path);
  }
}

void Session::loadPreset(const std::string& path) {
  try {
    ViewerChoice preset = readPreset(path);
    if (preset.technique.name.empty()) preset.technique.name = wanted[kLeft].info->name;
    const bool other =
        preset.scene_given && (!state.scene || wholeName(preset.scene.name) != wholeName(scene_name) ||
                               preset.scene.ground != state.scene->ground ||
                               wholeName(preset.spheres) != wholeName(state.scene->spheres));
    if (other) return openPreset(preset, path);
    if (!state.scene) throw Error(path, "no scene is there yet");
    takePreset(preset, path);
    if (preset.view.eye && preset.view.target) camera.setTarget(*preset.view.eye, *preset.view.target);
    if (preset.view.fov_deg) camera.setFov(glm::radians(*preset.view.fov_deg));
    if (preset.view.ortho_m) camera.setOrtho(*preset.view.ortho_m);
    if (wholeName(preset.light.environment) != wholeName(environment_name))
      openEnvironment(preset.light.environment);
    prepare();
    changed();
  } catch (const std::exception& error) {
    say(error.what(), true);
  }
}

/// All of a preset but scene, light from afar and camera. Throws Error, and nothing has changed.
void Session::takePreset(const ViewerChoice& preset, const std::string& path) {
  try {
    state.moves = cli::movesIn(state.scene->scene, preset.moves);
  } catch (const Error& error) {
    throw Error(std::filesystem::path(path).filename().string(), error.what());
  }
  adoptChoice(preset);
  state.time_s = preset.view.time_s;
  say(fmt::format("preset {}", std::filesystem::path(path).filename().string()));
}

/// A preset of another scene than the one that is shown.
void Session::openPreset(const ViewerChoice& preset, const std::string& path) {
  ViewerChoice choice = choice_;
  choice.scene = preset.scene;
  choice.view = preset.view;
  choice.light = preset.light;
  choice.moves = preset.moves;
  choice.spheres = preset.spheres;
  openChoice(choice, [this, preset, path] { takePreset(preset, path); });
}

void Session::savePreset(const std::string& path) {
  try {
    ViewState whole = state;
    whole.width = width_;
    whole.height = height_;
    whole.left = wanted[kLeft];
    writePreset(path, whole, camera, environment_name, light_texts);
    say(fmt::format("saved {}", path));
  } catch (const std::exception& error) {
    say(error.what(), true);
  }
}

void Session::saveWhole(const std::string& path) {
  if (playing || stands() || !drawn_) return saveScreenshot(path);
  pending_picture_ = path;
  say(fmt::format("{}: saved as soon as the picture is whole", path));
}

void Session::saveScreenshot(const std::string& path) {
  try {
    if (!drawn_) throw Error(path, "nothing is drawn yet");
    if (path.ends_with(".exr") && drawn_->left.layers->find("normal") == nullptr) {
      pending_picture_ = path;
      return changed();
    }
    const LayeredImage* right = drawn_->split                                    ? drawn_->right.layers.get()
                                : reference_ && state.split == Split::kReference ? reference_->layers.get()
                                                                                 : nullptr;
    savePicture(path, *drawn_, right, divider);
    say(fmt::format("saved {}, {} x {}", path, drawn_->width, drawn_->height));
  } catch (const std::exception& error) {
    say(error.what(), true);
  }
}

void Session::savePending() {
  if (pending_picture_.empty() || !drawn_ || !stands()) return;
  if (pending_picture_.ends_with(".exr") && drawn_->left.layers->find("normal") == nullptr) return changed();
  saveScreenshot(std::exchange(pending_picture_, {}));
}

void Session::startVideo(const std::string& path) {
  video_ = std::make_unique<VideoCapture>(path);
  changed();
}

void Session::stopVideo() {
  if (!video_) return;
  try {
    const std::int64_t frames = video_->finish();
    say(frames > 0 ? fmt::format("saved {} ({} frames)", video_->path(), frames) : "no frame was recorded");
  } catch (const std::exception& error) {
    say(error.what(), true);
  }
  video_.reset();
}

}  // namespace gloam::view
