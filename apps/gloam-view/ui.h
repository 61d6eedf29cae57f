// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Panels over a session. One file a subject; all of them only read the session and ask it for things.
#pragma once

#include <imgui.h>

#include <map>
#include <optional>
#include <string>

#include "gizmo.h"
#include "session.h"

namespace gloam::view {

/// Where the picture, or a control, stands in the window, in its units.
struct Place {
  ImVec2 low{0.0f, 0.0f}, size{0.0f, 0.0f};
  bool holds(const ImVec2& p) const {
    return p.x >= low.x && p.y >= low.y && p.x < low.x + size.x && p.y < low.y + size.y;
  }
};

/// What of the window is the window's alone.
struct UiState {
  bool panel = true, inspector = false, quit = false;
  bool turns = false;        ///< the gizmo rotates instead of moving
  std::optional<Pull> pull;  ///< of a handle that the mouse holds
  bool let_go = false;       ///< the handle was let go by Esc before the button was
  float scale = 1.0f;
  double ui_device_ms = 0.0;
  std::string path;  ///< typed into "open"
  std::string preset = "preset.json", screenshot = "gloam.png", video = "gloam.mp4";
  std::string last_preset;  ///< that F5 saved: what F9 loads
  /// Keys since the last frame, each press and repeat: short ones between two slow frames count too.
  std::vector<int> pressed, repeated;
  std::vector<std::uint8_t> reference_bytes;                  ///< RGBA, as it is shown
  std::string copied;                                         ///< to the clipboard, by whoever owns it
  std::map<std::string, Place> controls;                      ///< of this frame, by name: for tests
  std::map<std::string, std::vector<std::string>> inspected;  ///< rows of the inspector, the same
  std::string right_tag;                                      ///< over the right half, the same
};

void setStyle(float scale);
/// Letters at that scale; the font of Dear ImGui where DejaVu is not installed. Call before textures are made.
void loadLetters(float scale);

Place layOut(const UiState& ui, const ImVec2& window);
void drawPanel(Session& session, UiState& ui, const Place& place, const ImVec2& window);
void drawPicture(Session& session, UiState& ui, const Place& place);
/// Status line, messages, progress, play bar: over or under the picture.
void drawOverlays(Session& session, UiState& ui, const Place& place);
/// The height of the picture's tags.
float tagHeight(float scale);
void drawInspector(Session& session, UiState& ui, const Place& place);
/// Marks of lights, and handles of what is selected. True while the mouse is theirs.
bool drawGizmo(Session& session, UiState& ui, const Place& place);
struct LightMark {
  int node = kNone;
  ImVec2 at;
  glm::vec3 color{1.0f};
};
/// Of all lights in front of the eye.
std::vector<LightMark> lightMarks(const Session& session, const Place& place);
/// The node of a light whose mark is there, or kNone.
int lightAt(const Session& session, const Place& place, const ImVec2& at, float scale);
/// Mouse over the picture and keys.
void handleInput(Session& session, UiState& ui, const Place& place, bool gizmo_has_mouse);

// Sections of the panel.
void sceneSection(Session& session, UiState& ui);
void techniqueSection(Session& session, UiState& ui);
void lightSection(Session& session);
void cameraSection(Session& session);
void viewSection(Session& session, UiState& ui);
void compareSection(Session& session, UiState& ui);
void objectSection(Session& session, UiState& ui);
void timesSection(Session& session, UiState& ui);
void saveSection(Session& session, UiState& ui);

// Helpers: a label on the left, the control on the right.
void label(const char* text, const char* help = nullptr);
void helpMark(const char* help);
/// The same of an entry of a list, to the left of it: over the list it would hide the next ones.
void helpBeside(const char* help);
bool inputPath(const char* id, std::string& text, float width);
void dim(const std::string& text);
/// In one line; what does not fit is cut, and shown whole under the mouse.
void fittedLine(const std::string& text, float width);
/// What of a text fits, with … where it was cut.
std::string fitted(const std::string& text, float width);
/// "1.2 %"; a dash for what is not known.
std::string percent(double share, int digits);
/// A row of a table of two columns.
void valueRow(const char* name, const std::string& value);
/// Controls for every option of a technique, from its table.
void optionControls(Session& session, UiState& ui, Side side);
/// Keeps where the control stands that came last.
void noteControl(UiState& ui, const std::string& name);

}  // namespace gloam::view
