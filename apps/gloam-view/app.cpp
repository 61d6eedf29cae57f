// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "app.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "outline.h"

namespace gloam::view {
namespace {

constexpr double kLeastFrameSeconds = 1.0 / 60.0;
constexpr double kInputSeconds = 0.25;                        // frames go on after an input
constexpr double kRestSeconds = 0.5, kProgressSeconds = 0.1;  // between two frames that show no new picture
constexpr double kSharedSeconds = 0.05;  // after an input, where the cores that draw it draw the picture, too
constexpr int kMostRecoveries = 3;

std::string glfw_problem;

void onProblem(int, const char* text) {
  glfw_problem = text != nullptr ? text : "";
}

}  // namespace

App::App(const ViewerChoice& choice) : choice_(choice) {
  if (!choice.script.empty()) script_ = std::make_unique<Script>(choice.script);
  ui_.panel = choice.panel;
  createWindow();
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  setScale();
  noticeInput();
  ImGui_ImplGlfw_InitForVulkan(window_, true);  // passes events on to what was there before
  openSurface();
  session_ = std::make_unique<Session>(choice, [] { glfwPostEmptyEvent(); });
  if (!choice.screenshot.empty() && choice.scale <= 0.0f) session_->resolution.fixed = 1.0f;
  if (choice.screenshot.ends_with(".exr")) session_->inspect(true);  // all layers
}

App::~App() {
  session_.reset();
  surface_.reset();
  device_.reset();
  if (ImGui::GetCurrentContext() != nullptr) {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  if (window_ != nullptr) glfwDestroyWindow(window_);
  glfwTerminate();
}

void App::createWindow() {
  glfwSetErrorCallback(onProblem);
  if (glfwInit() == GLFW_FALSE) {
    throw Error("window", fmt::format("no display ({}); `gloam render` draws without one", glfw_problem));
  }
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, choice_.ui_scale > 0.0f ? GLFW_FALSE : GLFW_TRUE);
  window_ = glfwCreateWindow(choice_.view.size.x, choice_.view.size.y, "gloam-view", nullptr, nullptr);
  if (window_ == nullptr) throw Error("window", fmt::format("cannot be opened: {}", glfw_problem));
  glfwSetWindowUserPointer(window_, this);
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
    App& app = *static_cast<App*>(glfwGetWindowUserPointer(window));
    for (int i = 0; i < count; ++i) app.session_->openDropped(paths[i]);
  });
  glfwSetWindowContentScaleCallback(window_, [](GLFWwindow* window, float, float) {
    static_cast<App*>(glfwGetWindowUserPointer(window))->setScale();
  });
}

/// A frame of the window costs a software driver as much as a small picture: it is drawn when there is something new.
void App::noticeInput() {
  const auto notice = [](GLFWwindow* window) {
    static_cast<App*>(glfwGetWindowUserPointer(window))->input_s_ = glfwGetTime();
  };
  static const auto kNotice = notice;
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double, double) { kNotice(w); });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int, int, int) { kNotice(w); });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double) { kNotice(w); });
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int mods) {
    kNotice(w);
    UiState& ui = static_cast<App*>(glfwGetWindowUserPointer(w))->ui_;
    if (action == GLFW_RELEASE) return;
    if ((mods & GLFW_MOD_CONTROL) != 0) {
      ui.quit |= key == GLFW_KEY_Q;
      return;
    }
    if (action == GLFW_PRESS) ui.pressed.push_back(key);
    ui.repeated.push_back(key);
  });
  glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned) { kNotice(w); });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { kNotice(w); });
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { kNotice(w); });
}

void App::setScale() {
  float x = 1.0f, y = 1.0f;
  glfwGetWindowContentScale(window_, &x, &y);
  int width = 0, framebuffer = 0, unused = 0;
  glfwGetWindowSize(window_, &width, &unused);
  glfwGetFramebufferSize(window_, &framebuffer, &unused);
  const float pixels = width > 0 && framebuffer > 0 ? float(framebuffer) / float(width) : 1.0f;
  ui_.scale = choice_.ui_scale > 0.0f ? choice_.ui_scale : std::clamp(x / pixels, 0.5f, 4.0f);
  setStyle(ui_.scale);
  loadLetters(ui_.scale);
  letters_wanted_ = true;
}

void App::openSurface() {
  device_ = std::make_unique<WindowDevice>(window_);
  surface_ = std::make_unique<WindowSurface>(*device_, choice_.vsync);
  letters_wanted_ = true;
  uploaded_ = 0;
}

void App::recover() {
  if (++recoveries_ > kMostRecoveries) throw Error("window", "the Vulkan device was lost again and again");
  surface_.reset();
  device_.reset();
  openSurface();
  session_->say("the window's Vulkan device was lost and opened anew", true);
}

void App::run() {
  while (glfwWindowShouldClose(window_) == GLFW_FALSE && !ui_.quit && !cli::interrupted()) {
    waitForEvents();
    try {
      if (update()) drawFrame();
    } catch (const DeviceLost&) {
      recover();
    }
    if (!session_->fatal.empty()) throw Error(session_->fatal);
    runErrands();
    if (script_ && !script_->play(*this)) break;
  }
  session_->stopVideo();
  if (!choice_.stats.empty()) writeStats(choice_.stats);
  const int messages = session_->validationMessages() + windowValidationMessages();
  if (messages > 0)
    throw Error("GLOAM_VALIDATION", fmt::format("{} messages of the validation layer", messages));
}

/// At rest the window costs nothing; while something runs it is drawn as often as the display shows it.
void App::waitForEvents() {
  const bool lively = script_ || glfwGetTime() - input_s_ < kInputSeconds || !session_->idle() ||
                      !choice_.screenshot.empty() || !choice_.window_screenshot.empty();
  const double since = glfwGetTime() - last_frame_s_;
  if (lively) {
    glfwWaitEventsTimeout(std::max(0.001, kLeastFrameSeconds - since));
  } else {
    glfwWaitEventsTimeout(0.25);
  }
  last_frame_s_ = glfwGetTime();
}

void App::injectInput() {
  if (!mouse_) return;
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = {mouse_->x, mouse_->y};
  for (int i = 0; i < 3; ++i) io.MouseDown[i] = buttons_[i];
}

/// Takes and asks for pictures. True where the window shows something that it did not show before.
bool App::update() {
  int width = 0, height = 0, window_width = 0, window_height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  glfwGetWindowSize(window_, &window_width, &window_height);
  const bool hidden = width <= 0 || height <= 0 || window_width <= 0 ||
                      glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE;
  if (hidden) {  // work goes on, nothing is drawn
    session_->update(0, 0);
    return false;
  }
  if (drawsAlone()) ui_.panel = false;
  place_ = layOut(ui_, {float(window_width), float(window_height)});
  const float pixels = float(width) / float(window_width);
  const bool alone = drawsAlone();
  session_->update(alone ? choice_.view.size.x : int(std::lround(place_.size.x * pixels)),
                   alone ? choice_.view.size.y : int(std::lround(place_.size.y * pixels)));
  const double since = glfwGetTime() - drawn_s_;
  if (uploaded_ != session_->pictureRevision() || (script_ && !script_->waits())) return true;
  const bool answered = input_s_ <= drawn_s_;
  const double least = answered ? kProgressSeconds : session_->drawing() ? kSharedSeconds : 0.0;
  if (device_->software() && since < least) return false;
  const bool fresh =
      glfwGetTime() - input_s_ < kInputSeconds || ImGui::IsAnyMouseDown() || session_->moving();
  return fresh || since > (session_->idle() ? kRestSeconds : kProgressSeconds);
}

void App::drawFrame() {
  drawn_s_ = glfwGetTime();
  if (std::exchange(lose_window_, false)) throw DeviceLost();
  int width = 0, height = 0, window_width = 0, window_height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  glfwGetWindowSize(window_, &window_width, &window_height);
  surface_->wait();
  if (std::exchange(letters_wanted_, false)) {
    unsigned char* pixels = nullptr;
    int letters_width = 0, letters_height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &letters_width, &letters_height);
    ImGui::GetIO().Fonts->SetTexID(textureId(TextureSlot::kLetters));  // building them forgot it
    surface_->ui().setTexture(TextureSlot::kLetters, letters_width, letters_height, pixels);
  }
  ui_.ui_device_ms = surface_->uiDeviceMs();
  ui_.controls.clear();
  const ImVec2 window{float(window_width), float(window_height)};
  uploadPictures();
  ImGui_ImplGlfw_NewFrame();
  injectInput();
  ImGui::NewFrame();
  drawPicture(*session_, ui_, place_);
  const bool gizmo_has_mouse = drawGizmo(*session_, ui_, place_);
  drawPanel(*session_, ui_, place_, window);
  drawOverlays(*session_, ui_, place_);
  drawInspector(*session_, ui_, place_);
  handleInput(*session_, ui_, place_, gizmo_has_mouse);
  session_->requestPicture();
  ui_.pressed.clear();
  ui_.repeated.clear();
  ImGui::Render();
  if (!ui_.copied.empty()) glfwSetClipboardString(window_, std::exchange(ui_.copied, {}).c_str());
  surface_->show(width, height, *ImGui::GetDrawData());
  const std::string title = fmt::format("gloam-view  {}", session_->scene_name);
  static std::string shown_title;
  if (title != shown_title) glfwSetWindowTitle(window_, (shown_title = title).c_str());
}

/// What is selected has a line round it, in the window alone.
static void upload(UiRenderer& ui, TextureSlot slot, const Drawn& drawn, const Picture& picture,
                   const std::vector<bool>& chosen) {
  const Layer* objects = chosen.empty() || !picture.layers ? nullptr : picture.layers->find("object");
  if (objects == nullptr) return ui.setTexture(slot, drawn.width, drawn.height, picture.rgba.data());
  std::vector<std::uint8_t> outlined = picture.rgba;
  drawOutline(outlined, drawn.width, drawn.height, objects->ids, chosen);
  ui.setTexture(slot, drawn.width, drawn.height, outlined.data());
}

void App::uploadPictures() {
  const Drawn* drawn = session_->drawn();
  if (drawn == nullptr || uploaded_ == session_->pictureRevision()) return;
  uploaded_ = session_->pictureRevision();
  UiRenderer& ui = surface_->ui();
  const std::vector<bool> chosen = session_->chosenInstances();
  upload(ui, TextureSlot::kLeft, *drawn, drawn->left, chosen);
  if (drawn->split) upload(ui, TextureSlot::kRight, *drawn, drawn->right, chosen);
  const Image reference = session_->referencePicture();
  if (reference.empty()) return;
  ui_.reference_bytes = rgbaOf(reference);
  ui.setTexture(TextureSlot::kRight, reference.width, reference.height, ui_.reference_bytes.data());
}

}  // namespace gloam::view
