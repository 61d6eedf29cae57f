// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "compare_page.h"

#include <fmt/core.h>
#include <gloam/metrics.h>
#include <image/atomic_file.h>

#include <algorithm>

#include "compare_pack.h"
#include "embedded/compare_page_files.h"

namespace gloam::cli {
namespace {

constexpr std::size_t kMostPixels = std::size_t(1) << 21;
constexpr float kFalseColorTop = 1.0f;

int shrinkFor(const Image& picture) {
  int factor = 1;
  while (picture.pixelCount() / std::size_t(factor * factor) > kMostPixels) ++factor;
  return factor;
}

/// Elements that carry packed pictures; the page's script finds them by id.
class Blobs {
 public:
  explicit Blobs(int shrink) : shrink_(shrink) {}

  Json halves(const Image& picture) {
    const bool dark = std::ranges::all_of(picture.pixels, [](float value) { return value == 0.0f; });
    return dark ? Json() : add(packedHalves(shrunk(picture, shrink_)));
  }
  Json bytes(const Image& map) { return add(packedBytes(shrunk(map, shrink_))); }
  const std::string& elements() const { return elements_; }

 private:
  Json add(const std::string& packed) {
    const std::string id = fmt::format("picture-{}", count_++);
    elements_ += fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, packed);
    return id;
  }

  int shrink_ = 1, count_ = 0;
  std::string elements_;
};

Json orNull(int index) {
  return index < 0 ? Json() : Json(index);
}

Json pictureJson(const PagePicture& picture, Blobs& blobs) {
  Json flip = Json::object();
  for (const auto& [layer, map] : picture.flip) flip[layer] = blobs.bytes(map);
  return {{"label", picture.label},
          {"technique", orNull(picture.technique)},
          {"reference", orNull(picture.reference)},
          {"blobs", {{"direct", blobs.halves(picture.direct)}, {"indirect", blobs.halves(picture.indirect)}}},
          {"flip", flip}};
}

/// 256 colours of each map, made by the functions that `gloam diff` draws with.
Json colorMaps() {
  constexpr int kSteps = 256;
  Image ramp(kSteps, 1, 1), reference(kSteps, 1, 3, 1.0f / 3.0f), brighter = reference;
  for (int i = 0; i < kSteps; ++i) {
    ramp.at(i, 0)[0] = float(i) / float(kSteps - 1);
    for (int c = 0; c < 3; ++c) brighter.at(i, 0)[c] += kFalseColorTop * ramp.at(i, 0)[0] / 3.0f;
  }
  const auto text = [](const Image& colors) {
    const std::vector<std::uint8_t> bytes = encodeSrgb8(colors);
    return base64(bytes.data(), bytes.size());
  };
  return {{"flip", text(magma(ramp))},
          {"false_color", text(falseColor(brighter, reference, kFalseColorTop))}};
}

std::string htmlText(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

/// JSON that may stand inside <script>: no "</script" and no "<!--" in it, whatever files are called.
std::string scriptJson(const Json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', true, Json::error_handler_t::replace)) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

void writeFilled(std::string_view page, const std::map<std::string, std::string>& parts, AtomicFile& file) {
  while (!page.empty()) {
    const std::size_t begin = page.find("{{");
    file.write(page.data(), std::min(begin, page.size()));
    if (begin == std::string_view::npos) return;
    const std::size_t end = page.find("}}", begin);
    const std::string& part = parts.at(std::string(page.substr(begin + 2, end - begin - 2)));
    file.write(part.data(), part.size());
    page.remove_prefix(end + 2);
  }
}

std::string script() {
  std::string text = "'use strict';\n(() => {\n";
  for (const std::string_view part : {embedded::codec_js, embedded::pictures_js, embedded::format_js,
                                      embedded::viewer_js, embedded::inspector_js, embedded::measures_js,
                                      embedded::plot_js, embedded::about_js, embedded::main_js}) {
    text += part;
  }
  return text + "})();\n";
}

}  // namespace

void writePage(const Page& page, const std::filesystem::path& path) {
  const Image& any = page.pictures.front().direct;
  const int shrink = shrinkFor(any);
  Blobs blobs(shrink);
  Json pictures = Json::array();
  for (const PagePicture& picture : page.pictures) pictures.push_back(pictureJson(picture, blobs));
  const bool covered = std::ranges::all_of(page.coverage.pixels, [](float alpha) { return alpha >= 1.0f; });
  const Json coverage = covered ? Json() : blobs.bytes(page.coverage);
  const Json data = {{"results", page.results},
                     {"page",
                      {{"title", page.title},
                       {"width", any.width / shrink},
                       {"height", any.height / shrink},
                       {"shrink", shrink},
                       {"exposure_stops", shortest(page.exposure_stops)},
                       {"false_color_top", kFalseColorTop},
                       {"color_maps", colorMaps()},
                       {"alpha", coverage},
                       {"pictures", pictures}}}};
  AtomicFile file(path);
  writeFilled(embedded::compare_html,
              {{"title", htmlText(page.title + " - gloam compare")},
               {"style", std::string(embedded::compare_css)},
               {"data", scriptJson(data)},
               {"pictures", blobs.elements()},
               {"script", script()}},
              file);
  file.commit();
}

}  // namespace gloam::cli
