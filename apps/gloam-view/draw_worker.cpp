// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "draw_worker.h"

#include <fmt/core.h>
#include <renderer/proxy_set.h>

#include <algorithm>
#include <utility>

#include "display_choice.h"
#include "show.h"
#include "spheres_overlay.h"

namespace gloam::view {
namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point then) {
  return std::chrono::duration<double, std::milli>(Clock::now() - then).count();
}

}  // namespace

std::vector<std::uint8_t> rgbaOf(const Image& display) {
  const std::vector<std::uint8_t> bytes = encodeSrgb8(display);
  if (display.channels == 4) return bytes;
  const auto channels = std::size_t(display.channels);
  std::vector<std::uint8_t> rgba(display.pixelCount() * 4, 255);
  for (std::size_t i = 0; i < display.pixelCount(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) rgba[4 * i + c] = bytes[channels * i + std::min(c, channels - 1)];
  }
  return rgba;
}

DrawWorker::DrawWorker(std::string device, std::function<void()> wake)
    : device_(std::move(device)), wake_(std::move(wake)), thread_([this] { run(); }) {}

DrawWorker::~DrawWorker() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void DrawWorker::request(std::uint64_t serial, const ViewState& state) {
  {
    const std::lock_guard lock(mutex_);
    next_ = {serial, state};
  }
  changed_.notify_all();
}

std::shared_ptr<const Drawn> DrawWorker::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(finished_, nullptr);
}

bool DrawWorker::busy() const {
  const std::lock_guard lock(mutex_);
  return busy_ || next_.has_value();
}

int DrawWorker::pictures() const {
  const std::lock_guard lock(mutex_);
  return pictures_;
}

int DrawWorker::validationMessages() const {
  const std::lock_guard lock(mutex_);
  return validation_;
}

void DrawWorker::loseDevice() {
  const std::lock_guard lock(mutex_);
  lose_ = true;
}

void DrawWorker::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return quit_ || next_.has_value(); });
    if (quit_) break;
    const Request request = *std::move(next_);
    next_.reset();
    busy_ = true;
    lock.unlock();
    std::shared_ptr<Drawn> drawn = draw(request);
    lock.lock();
    busy_ = false;
    if (finished_) drawn->answers = finished_->answers;
    drawn->answers.emplace_back(request.serial, ++pictures_);
    finished_ = std::move(drawn);
    if (renderer_) validation_ = renderer_->validationMessages();
    lock.unlock();
    wake_();
    lock.lock();
  }
  lock.unlock();
  renderer_.reset();  // where it was made
}

std::shared_ptr<Drawn> DrawWorker::draw(const Request& request) {
  auto drawn = std::make_shared<Drawn>();
  const ViewState& state = request.state;
  drawn->serial = request.serial;
  drawn->width = state.width;
  drawn->height = state.height;
  drawn->camera = state.camera;
  drawn->display = state.display;
  drawn->show = state.show;
  drawn->technique = state.left.info->name;
  try {
    {
      const std::lock_guard lock(mutex_);
      if (std::exchange(lose_, false)) throw Error("gpu", "vkQueueSubmit failed: the device was lost");
    }
    if (!renderer_) renderer_.emplace(device_);
    drawn->device = renderer_->device();
    const Clock::time_point started = Clock::now();
    bring(state, *drawn);
    drawn->scene_ms = msSince(started);
    const PosedScene posed = cli::poseMoved(state.scene->scene, state.moves, state.time_s);
    drawn->instance_places = instancePlaces(*state.scene, posed);
    drawn->lights = posed.lights;
    drawPicture(state, state.left, posed, *drawn, drawn->left);
    drawn->image_names = renderer_->imageNames();
    if (state.split == Split::kTechnique) {
      drawPicture(state, state.right, posed, *drawn, drawn->right);
      drawn->split = true;
      drawn->right_technique = state.right.info->name;
    }
    drawn->memory = renderer_->memory();
  } catch (const std::exception& error) {
    drawn->error = error.what();
    if (drawn->error.find("device was lost") != std::string::npos) {
      scene_.reset();
      renderer_.reset();
    }
  }
  return drawn;
}

/// Only what changed goes to the device.
void DrawWorker::bring(const ViewState& state, Drawn&) {
  const bool new_scene = scene_ != state.scene;
  if (new_scene) {
    scene_.reset();
    spheres_.reset();
    emission_.reset();
    renderer_->setScene(state.scene->scene);
    scene_ = state.scene;
  }
  if (state.needs.spheres && state.needs.of == scene_.get() && spheres_ != state.needs.spheres) {
    renderer_->setSpheres(scene_->scene, *state.needs.spheres);
    spheres_ = state.needs.spheres;
    emission_.reset();
  }
  if (spheres_ && state.needs.emission && spheres_ == state.needs.spheres &&
      emission_ != state.needs.emission) {
    renderer_->setEmission(scene_->scene, *state.needs.emission);
    emission_ = state.needs.emission;
  }
  const bool moved = state.lights.moves() && state.time_s != light_time_s_;
  if (!new_scene && !moved && base_ == state.base && env_rotation_deg_ == state.env_rotation_deg &&
      env_intensity_ == state.env_intensity && lights_ == state.lights.text()) {
    return;
  }
  renderer_->setEnvironment(describedLight(state));
  base_ = state.base;
  env_rotation_deg_ = state.env_rotation_deg;
  env_intensity_ = state.env_intensity;
  light_time_s_ = state.time_s;
  lights_ = state.lights.text();
}

/// With the image that `options` ask for; without it, and `show` emptied, where the technique makes none of that name.
RenderedFrame DrawWorker::renderShown(const PosedScene& posed, const PosedCamera& camera,
                                      RenderOptions& options) {
  try {
    return renderer_->render(posed, camera, options);
  } catch (const Error&) {
    const std::vector<std::string> names = renderer_->imageNames();
    if (options.show.empty() || std::ranges::find(names, options.show) != names.end()) throw;
    options.show.clear();
    return renderer_->render(posed, camera, options);
  }
}

void DrawWorker::drawPicture(const ViewState& state, const Pick& pick, const PosedScene& posed, Drawn& drawn,
                             Picture& picture) {
  RenderOptions options;
  options.width = state.width;
  options.height = state.height;
  options.supersample = state.supersample;
  options.technique = pick.info->name;
  options.settings = pick.settings;
  options.background = state.background;
  options.timings = true;
  const bool frame_layer = cli::isFrameLayer(state.show);
  options.parts = state.layers || frame_layer;
  options.layers = state.layers || (frame_layer && state.show != "direct" && state.show != "indirect");
  // The other side of a split screen may have no image of that name.
  const bool by_name = !state.show.empty() && !frame_layer;
  const bool foreign = by_name && pick.info != state.left.info && !state.show.starts_with("frame.") &&
                       !state.show.starts_with(pick.info->name);
  if (by_name && !foreign) options.show = state.show;
  const Clock::time_point started = Clock::now();
  RenderedFrame frame = renderShown(posed, state.camera, options);
  const bool missing = by_name && options.show.empty();
  const bool unfitted = cli::showsSpheres(state.show) && !spheres_;  // on their way
  const std::string shown = missing || unfitted ? "" : state.show;
  if (&picture == &drawn.left) {
    drawn.show = shown;
    if (missing) drawn.missing_show = state.show;
  }
  picture.frame_ms = msSince(started);
  picture.passes = std::move(frame.passes);
  drawn.memory_bytes = std::max(drawn.memory_bytes, frame.memory_bytes);
  for (const std::string& warning : frame.warnings) {
    if (std::ranges::find(drawn.warnings, warning) == drawn.warnings.end()) drawn.warnings.push_back(warning);
  }
  cli::holdExposure(drawn.display, frame.layers);
  if (cli::showsSpheres(shown)) {
    const std::vector<PosedSphere> spheres = shown == cli::kShadowSpheresLayer
                                                 ? ProxySet(scene_->scene, *spheres_).drawnIn(posed)
                                                 : poseSpheres(*spheres_, scene_->scene, posed);
    frame.layers.add(shown, {"R", "G", "B"},
                     cli::spheresPicture(frame.layers, spheres, state.camera, drawn.display));
  }
  picture.rgba = rgbaOf(cli::shownPicture(frame.layers, shown, drawn.display));
  picture.layers = std::make_shared<const LayeredImage>(std::move(frame.layers));
}

}  // namespace gloam::view
