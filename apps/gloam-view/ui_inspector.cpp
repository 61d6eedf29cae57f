// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The pixel inspector: linear values under the mouse and their neighbourhood; of both halves of a split screen, and how far they
// are apart.
#include <fmt/core.h>

#include <algorithm>

#include "ui.h"

namespace gloam::view {
namespace {

/// One half: its numbers, and what is seen of it.
struct Half {
  std::string name;
  const LayeredImage* layers = nullptr;
  const std::vector<std::uint8_t>* bytes = nullptr;
  int channels = 4;  ///< of `bytes`
};

/// Up to three values of a pixel; none where there is no such layer.
std::vector<float> valuesOf(const LayeredImage& layers, const std::string& layer, const glm::vec2& place) {
  const Layer* found = layers.find(layer);
  if (found == nullptr || found->pixels.empty()) return {};
  const std::size_t n = found->channels.size();
  const int x = std::clamp(int(place.x * float(layers.width)), 0, layers.width - 1);
  const int y = std::clamp(int(place.y * float(layers.height)), 0, layers.height - 1);
  const std::size_t at = (std::size_t(y) * std::size_t(layers.width) + std::size_t(x)) * n;
  return {found->pixels.begin() + std::ptrdiff_t(at),
          found->pixels.begin() + std::ptrdiff_t(at + std::min<std::size_t>(n, 3))};
}

std::string text(const std::vector<float>& values) {
  std::string text;
  for (const float value : values) text += fmt::format("{}{:.4g}", text.empty() ? "" : "   ", value);
  return text;
}

/// Right less left.
std::string differenceText(const std::vector<float>& left, const std::vector<float>& right) {
  if (left.size() != right.size()) return "";
  std::string text;
  for (std::size_t i = 0; i < left.size(); ++i)
    text += fmt::format("{}{:+.3g}", i > 0 ? "   " : "", right[i] - left[i]);
  return text;
}

std::string objectText(const LayeredImage& layers, const glm::vec2& place) {
  const Layer* objects = layers.find("object");
  if (objects == nullptr || objects->ids.empty()) return "";
  const int x = std::clamp(int(place.x * float(layers.width)), 0, layers.width - 1);
  const int y = std::clamp(int(place.y * float(layers.height)), 0, layers.height - 1);
  return std::to_string(objects->ids[std::size_t(y) * std::size_t(layers.width) + std::size_t(x)]);
}

void row(UiState& ui, const char* name, const std::vector<std::string>& cells) {
  if (std::ranges::all_of(cells, &std::string::empty)) return;
  ui.inspected[name] = cells;
  valueRow(name, cells.front());
  for (std::size_t i = 1; i < cells.size(); ++i) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(cells[i].c_str());
  }
}

void valueTable(UiState& ui, const std::vector<Half>& halves, const std::string& show,
                const glm::vec2& place) {
  const bool both = halves.size() == 2;
  if (!ImGui::BeginTable("values", both ? 4 : 2, ImGuiTableFlags_SizingFixedFit)) return;
  if (both) row(ui, "", {halves[0].name, halves[1].name, "difference"});
  const auto line = [&](const char* name, const std::string& layer) {
    const std::vector<float> left = valuesOf(*halves[0].layers, layer, place);
    if (!both) return row(ui, name, {text(left)});
    const std::vector<float> right = valuesOf(*halves[1].layers, layer, place);
    row(ui, name, {text(left), text(right), differenceText(left, right)});
  };
  line("radiance", "");
  for (const char* name : {"direct", "indirect", "albedo", "normal", "depth"}) line(name, name);
  if (!show.empty()) line("shown", show);
  std::vector<std::string> objects;
  for (const Half& half : halves) objects.push_back(objectText(*half.layers, place));
  row(ui, "object", objects);
  ImGui::EndTable();
}

/// The neighbourhood, as large squares.
void magnified(const Half& half, const glm::vec2& place, float scale) {
  constexpr int kReach = 4;
  const float cell = 11.0f * scale;
  const int width = half.layers->width, height = half.layers->height;
  const int x = std::clamp(int(place.x * float(width)), 0, width - 1);
  const int y = std::clamp(int(place.y * float(height)), 0, height - 1);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::size_t pixels = half.bytes->size() / std::size_t(half.channels);
  for (int j = -kReach; j <= kReach; ++j) {
    for (int i = -kReach; i <= kReach; ++i) {
      const int px = std::clamp(x + i, 0, width - 1), py = std::clamp(y + j, 0, height - 1);
      const std::size_t pixel = std::size_t(py) * std::size_t(width) + std::size_t(px);
      if (pixel >= pixels) continue;
      const std::uint8_t* c = &(*half.bytes)[std::size_t(half.channels) * pixel];
      const ImVec2 low(at.x + float(i + kReach) * cell, at.y + float(j + kReach) * cell);
      list.AddRectFilled(low, {low.x + cell, low.y + cell}, IM_COL32(c[0], c[1], c[2], 255));
    }
  }
  const ImVec2 middle(at.x + kReach * cell, at.y + kReach * cell);
  list.AddRect(middle, {middle.x + cell, middle.y + cell}, IM_COL32(255, 255, 255, 255));
  ImGui::Dummy({cell * (2 * kReach + 1), cell * (2 * kReach + 1)});
}

std::vector<Half> halvesOf(const Session& session, const UiState& ui) {
  const Drawn& drawn = *session.drawn();
  std::vector<Half> halves = {{drawn.technique, drawn.left.layers.get(), &drawn.left.rgba}};
  if (drawn.split && drawn.right.layers)
    halves.push_back({drawn.right_technique, drawn.right.layers.get(), &drawn.right.rgba});
  const ReferenceView* reference = session.reference();
  if (session.state.split == Split::kReference && reference != nullptr && reference->layers)
    halves.push_back({"reference", reference->layers.get(), &ui.reference_bytes});
  return halves;
}

}  // namespace

void drawInspector(Session& session, UiState& ui, const Place& place) {
  ui.inspected.clear();
  const Drawn* drawn = session.drawn();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (!ui.inspector || drawn == nullptr || !drawn->left.layers || !place.holds(mouse) ||
      ImGui::GetIO().WantCaptureMouse)
    return;
  const glm::vec2 at((mouse.x - place.low.x) / place.size.x, (mouse.y - place.low.y) / place.size.y);
  const std::vector<Half> halves = halvesOf(session, ui);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {10.0f * ui.scale, 8.0f * ui.scale});
  ImGui::BeginTooltip();
  for (std::size_t i = 0; i < halves.size(); ++i) {
    if (i > 0) ImGui::SameLine(0.0f, 12.0f * ui.scale);
    magnified(halves[i], at, ui.scale);
  }
  ImGui::Text("%d, %d", int(at.x * float(drawn->width)), int(at.y * float(drawn->height)));
  valueTable(ui, halves, drawn->show, at);
  ImGui::EndTooltip();
  ImGui::PopStyleVar();
}

}  // namespace gloam::view
