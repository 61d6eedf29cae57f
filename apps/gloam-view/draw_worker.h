// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The thread that draws. It always takes the newest state and drops what came between: from an input to its picture there are
// two pictures at most, the one in hand and its own.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "view_state.h"

namespace gloam::view {

/// One technique's picture.
struct Picture {
  std::shared_ptr<const LayeredImage> layers;  ///< linear
  std::vector<std::uint8_t> rgba;              ///< as a display shows it, 8 bits
  std::vector<PassTime> passes;
  double frame_ms = 0.0;  ///< by the clock
};

struct Drawn {
  std::uint64_t serial = 0;  ///< of the state that it shows
  /// Serial and number (the first picture is 1) of this one, after those that it overtook before they were taken.
  std::vector<std::pair<std::uint64_t, int>> answers;
  int width = 0, height = 0;
  Picture left, right;
  bool split = false;
  std::string show;
  std::string missing_show;  ///< asked for, but the technique makes no image of that name: its light is shown
  std::string technique, right_technique;  ///< the latter empty where the screen is not split
  PosedCamera camera;
  std::vector<glm::vec3> instance_places;  ///< middles of PosedScene::instances, for hands to grip
  std::vector<PosedLight> lights;
  DisplayOptions display;  ///< with the exposure that was found
  std::vector<std::string> image_names;
  std::vector<MemoryUse> memory;
  std::size_t memory_bytes = 0;
  Warnings warnings;
  std::string error;  ///< why there is no picture
  DeviceInfo device;
  double scene_ms = 0.0;  ///< what it took to bring a new scene, light or spheres to the device
};

/// Of a display's picture (linear): 8 bits, four channels.
std::vector<std::uint8_t> rgbaOf(const Image& display);

class DrawWorker {
 public:
  /// `device` as Renderer takes it. Nothing is thrown: what goes wrong comes back as Drawn::error.
  DrawWorker(std::string device, std::function<void()> wake);
  ~DrawWorker();
  DrawWorker(const DrawWorker&) = delete;
  DrawWorker& operator=(const DrawWorker&) = delete;

  void request(std::uint64_t serial, const ViewState& state);
  /// The newest picture, once.
  std::shared_ptr<const Drawn> take();
  bool busy() const;
  int pictures() const;            ///< drawn so far
  int validationMessages() const;  ///< with GLOAM_VALIDATION=1
  /// As if the driver had lost the device at the next picture: for tests.
  void loseDevice();

 private:
  struct Request {
    std::uint64_t serial;
    ViewState state;
  };
  void run();
  std::shared_ptr<Drawn> draw(const Request& request);
  void bring(const ViewState& state, Drawn& drawn);
  RenderedFrame renderShown(const PosedScene& posed, const PosedCamera& camera, RenderOptions& options);
  void drawPicture(const ViewState& state, const Pick& pick, const PosedScene& posed, Drawn& drawn,
                   Picture& picture);

  std::string device_;
  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Request> next_;
  std::shared_ptr<const Drawn> finished_;
  bool quit_ = false, busy_ = false, lose_ = false;
  int pictures_ = 0, validation_ = 0;

  // Of the thread alone.
  std::optional<Renderer> renderer_;
  std::shared_ptr<const LoadedScene> scene_;
  std::shared_ptr<const SceneSpheres> spheres_;
  std::shared_ptr<const SceneEmission> emission_;
  std::shared_ptr<const DistantLight> base_;
  float env_rotation_deg_ = 0.0f, env_intensity_ = 1.0f, light_time_s_ = 0.0f;
  std::string lights_;
  std::thread thread_;
};

}  // namespace gloam::view
