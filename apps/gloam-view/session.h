// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the window shows and what it is asked for, without a word of windows: scene, light, techniques, camera, time; the threads
// that read, bake, draw and trace. Panels, keys and scripts all come here.
#pragma once

#include <array>
#include <chrono>
#include <ctime>
#include <optional>
#include <set>

#include "camera_control.h"
#include "capture.h"
#include "draw_worker.h"
#include "frame_history.h"
#include "jobs.h"
#include "recent_files.h"
#include "reference_worker.h"
#include "resolution.h"
#include "shader_watch.h"
#include "viewer_choice.h"

namespace gloam::view {

enum Side { kLeft = 0, kRight = 1 };
inline constexpr double kStillSeconds = 0.2;  ///< after the last change nothing moves

struct Message {
  std::string text;
  bool problem = false;
  double at_s = 0.0;
};

struct ReferenceChoice {
  int bounces = 2, samples = 4096;
  bool same_light = true;  ///< only what the technique covers
};

/// All that a reference depends on.
struct ReferenceKey {
  const LoadedScene* scene;
  const DistantLight* base;
  std::array<float, 6> values;  ///< rotation and intensity of the light from afar, time, camera, resolution
  std::array<int, 4> counts;    ///< bounces, samples, size of the picture's place
  glm::mat4 world_from_view;
  std::string lights;
  cli::NodeMoves moves;
  Coverage light;
  bool background;
  bool operator==(const ReferenceKey&) const = default;
};

class Session {
 public:
  Session(const ViewerChoice& choice, std::function<void()> wake);

  // ---- What is asked for. Throws nothing: what goes wrong becomes a message.
  void open(const std::string& name, bool ground = false);
  void openEnvironment(const std::string& name);
  /// By what the file is: a scene, a light probe, a preset.
  void openDropped(const std::string& path);
  void loadPreset(const std::string& path);
  void savePreset(const std::string& path);
  void pick(Side side, const std::string& technique);
  void setOption(Side side, const std::string& name, const std::string& text);
  void setSplit(Split split);
  void setShow(const std::string& name);
  void setTime(float time_s);
  void play(bool playing);
  void frameScene();
  void resetMoves();
  void clickAt(const glm::vec2& place);  ///< 0 to 1 of the picture: selects what is there
  void choose(int node);                 ///< selects it; kNone: nothing
  void inspect(bool inspects);           ///< pictures have all layers from now on
  /// Under a name as a preset or the command line has it ("exposure", "env_rotation", "proxies.spheres"). Throws Error.
  void set(const std::string& name, const std::string& value);
  /// An .exr holds all layers: where the picture has them not yet, the next one that stands is saved.
  void saveScreenshot(const std::string& path);
  /// The same once the picture is whole; at once while it plays.
  void saveWhole(const std::string& path);
  void startVideo(const std::string& path);
  void stopVideo();
  /// Something that a picture depends on has changed.
  void changed();
  void say(const std::string& text, bool problem = false);

  /// Takes what the threads finished, asks for the next picture: once a frame of the window, with the size of the picture's place.
  void update(int width, int height);
  /// The newest picture is shown at the size it keeps (with a button held: at that for moving ones), and nothing runs in the
  /// background.
  bool idle() const;
  bool moving() const;
  bool drawing() const { return worker_.busy(); }
  /// What takes so long, while the first picture of a kind is drawn: a line for people; empty where nothing does.
  std::string firstPicture() const;
  /// Asks for the picture of what has changed since update(), which would else ask a frame of the window later.
  void requestPicture();

  // ---- What is there.
  ViewState state;
  CameraControl camera;
  Pick wanted[2];  ///< what was picked; `state` follows when all that it needs is there
  ReferenceChoice reference_choice;
  Resolution resolution;
  bool playing = false, dragging = false;
  float divider = 0.5f;  ///< of a split screen, 0 to 1
  float speed = 1.0f;
  std::string environment_name, scene_name;
  std::vector<std::string> light_texts;

  const Drawn* drawn() const { return drawn_.get(); }
  std::shared_ptr<const Drawn> drawnShared() const { return drawn_; }
  const ReferenceView* reference() const { return reference_.get(); }
  bool tracing() const { return traced_.has_value(); }
  Image referencePicture() const;  ///< as a display shows it, linear; empty where there is none
  int selectedNode() const { return selected_node_; }
  std::vector<bool> chosenInstances() const;  ///< of PosedScene::instances; empty where nothing is selected
  const FrameHistory& history() const { return history_; }
  const std::deque<Message>& messages() const { return messages_; }
  const RecentFiles& recent() const { return recent_; }
  Jobs::Status job() const { return jobs_.status(); }
  void cancelJob() { jobs_.cancel(); }
  bool waitsFor(Side side) const;  ///< the technique that was picked is still being prepared
  bool sharesBake()
      const;  ///< the right half is drawn of the left one's bake, of another kind than it asks for
  float duration_s() const { return duration_s_; }
  float aspect() const { return height_ > 0 ? float(width_) / float(height_) : 1.0f; }
  std::uint64_t pictureRevision() const { return picture_revision_; }
  int pictures() const { return worker_.pictures(); }
  int slowestResponse() const {
    return slowest_response_;
  }                                                   ///< pictures from an input to the one that shows it
  double lastSwitchMs() const { return switch_ms_; }  ///< from picking a technique to its picture
  bool recording() const { return video_ != nullptr; }
  std::int64_t recordedFrames() const { return video_ ? video_->frames() : 0; }
  std::string fatal;  ///< why there is nothing to show at all
  int validationMessages() const { return worker_.validationMessages(); }
  void loseDevice();
  cli::Json stats(double ui_device_ms, int ui_objects) const;
  double now_s() const;

 private:
  void openChoice(const ViewerChoice& choice, std::function<void()> then);
  /// The lens of `camera`, placed so that the picture as it is shaped now shows all of the scene.
  PosedCamera framed(const PosedCamera& camera, const PosedScene& posed) const;
  void openPreset(const ViewerChoice& preset, const std::string& path);
  void takePreset(const ViewerChoice& preset, const std::string& path);
  void adopt(std::shared_ptr<const LoadedScene> scene, std::shared_ptr<const DistantLight> base);
  void adoptChoice(const ViewerChoice& choice);
  void prepare();
  void carryMoves(const Scene& from, const Scene& to);
  void startBake(const Pick& pick);
  void startSpheres(int count, bool emission);
  bool isBaked(Side side, const Pick& pick) const;
  bool isReady(Side side, const Pick& pick) const;
  void takePicks();
  void takeDrawn();
  void takeReference();
  void beginSwitch();
  void takeProblem(const Drawn& drawn);
  void takeMissing(const Drawn& drawn);
  void advance();
  ReferenceKey referenceKey() const;
  void dropReference();
  void followReference();
  bool stands() const;  ///< idle(), but for pictures that are to be saved
  bool wantsLayers() const;
  void savePending();
  void followShaders();
  void select(const Drawn& drawn);

  /// Light from afar that was asked for by itself.
  struct ReadLight {
    std::shared_ptr<const DistantLight> base;
    std::string name;
    int count = 0;
  };

  ViewerChoice choice_;
  ReadLight read_light_;
  RecentFiles recent_;
  ShaderWatch shaders_;
  std::uint64_t serial_ = 1, sent_serial_ = 0, still_serial_ = 0;
  std::uint64_t answered_serial_ = 0;  ///< of the last picture, drawn or not
  std::uint64_t picture_revision_ = 0;
  int width_ = 0, height_ = 0, sent_width_ = 0, sent_height_ = 0, still_width_ = 0, still_height_ = 0;
  int answered_width_ = 0, losses_ = 0;
  double last_change_s_ = -10.0, last_look_s_ = 0.0, last_pick_s_ = -10.0, last_advance_s_ = 0.0,
         switch_started_s_ = -1.0;
  double switch_ms_ = 0.0, switch_work_ms_ = 0.0;
  std::clock_t switch_clock_ = 0;
  std::uint64_t response_serial_ = 0;
  int response_from_ = 0, slowest_response_ = 0;
  double asked_s_ = 0.0;   ///< since when the picture that is on its way has been drawn
  std::string sent_kind_;  ///< of what was asked for last
  float duration_s_ = 0.0f;
  bool preparing_ = false, first_ = true;
  int growths_ = 0;          ///< of a picture that stands still
  float grown_from_ = 0.0f;  ///< share of the window that the last one grew from
  int selected_node_ = kNone;
  bool inspects_ = false;
  std::string pending_picture_;     ///< to be saved whole, an .exr with all layers
  std::set<std::string> measured_;  ///< kinds of pictures that were drawn of this scene
  std::optional<glm::vec2> click_;
  std::deque<Message> messages_;
  FrameHistory history_;
  std::shared_ptr<const Drawn> drawn_;
  std::shared_ptr<const ReferenceView> reference_;
  std::optional<ReferenceKey> traced_;     ///< what the tracer was started for
  std::shared_ptr<const Drawn> compared_;  ///< the picture that it is measured with
  int traced_width_ = 0, traced_height_ = 0;
  std::unique_ptr<VideoCapture> video_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  // Threads last: they end before what they write to.
  Jobs jobs_;
  DrawWorker worker_;
  ReferenceWorker tracer_;
};

}  // namespace gloam::view
