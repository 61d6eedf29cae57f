// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The window: events in, frames out.
#pragma once

#include <memory>

#include "script.h"
#include "ui.h"
#include "window_surface.h"

struct GLFWwindow;

namespace gloam::view {

class App {
 public:
  /// Throws Error: no display, no Vulkan.
  explicit App(const ViewerChoice& choice);
  ~App();
  App(const App&) = delete;
  App& operator=(const App&) = delete;

  /// Until the window is closed, the script is played or what was asked for is saved. Throws Error.
  void run();

  // For scripts.
  Session& session() { return *session_; }
  bool inputTaken() const { return input_s_ <= drawn_s_; }  ///< by a frame of the window
  void moveMouse(const glm::vec2& at);
  void pressMouse(const std::string& button, bool down);
  void scroll(float steps);
  void pressKey(const std::string& key, bool down);
  void type(const std::string& text);
  void resize(const glm::vec2& size);
  void minimise(bool minimised);
  bool captureWindow(const std::string& path);  ///< true when it is saved
  void writeStats(const std::string& path);
  void writeClipboard(const std::string& path);
  void loseWindow() { lose_window_ = true; }  ///< as if the driver had lost the window's device
  void quit() { ui_.quit = true; }

 private:
  void createWindow();
  void setScale();
  void openSurface();
  void noticeInput();
  bool update();
  void drawFrame();
  void recover();
  void uploadPictures();
  void runErrands();
  void waitForEvents();
  void injectInput();

  ViewerChoice choice_;
  GLFWwindow* window_ = nullptr;
  std::unique_ptr<WindowDevice> device_;
  std::unique_ptr<WindowSurface> surface_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<Script> script_;
  UiState ui_;
  Place place_;
  std::uint64_t uploaded_ = 0;
  int recoveries_ = 0;
  bool drawsAlone() const;
  bool letters_wanted_ = true, capture_asked_ = false, lose_window_ = false;
  double input_s_ = 0.0, last_frame_s_ = 0.0, drawn_s_ = 0.0;
  std::optional<glm::vec2> mouse_;  ///< of a script, in place of the real one
  bool buttons_[3] = {};
};

}  // namespace gloam::view
