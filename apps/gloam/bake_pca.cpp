// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bake_pca.h"

#include <fmt/core.h>

namespace gloam::cli {

void addPcaOption(CLI::App& app, PcaChoice& choice) {
  const auto set = [&choice](const std::string& text) {
    const std::size_t x = std::min(text.find('x'), text.size());
    try {
      choice.options.clusters = parseInteger("", text.substr(0, x), {1, 4096});
      choice.options.vectors = parseInteger("", text.substr(std::min(x + 1, text.size())), {1, 144});
    } catch (const Error&) {
      throw Error(
          "--pca",
          fmt::format("'{}': expected clusters (1 to 4096) and vectors (1 to 144), such as 64x20", text));
    }
    choice.wanted = true;
  };
  app.add_option_function<std::string>(
         "--pca", set,
         "compresses diffuse transfer: N clusters of points, M principal components each; with --half, 64x20 "
         "is about an eighth of its floats")
      ->type_name("NxM")
      ->group("Output");
}

Scene compressedAsChosen(Scene scene, const PcaChoice& choice, bool half_float, Console& console,
                         CompressReport& report) {
  if (!choice.wanted) return scene;
  CompressOptions options = choice.options;
  options.half_float = half_float;
  Scene small = compressTransfer(scene, options, console.progress(), &report);
  console.endProgress();
  console.remark(
      fmt::format("diffuse transfer compressed to {}, 1/{:.1f} of its floats: errs by {:.2g} % (RMS); its "
                  "light by {:.2g} %, at "
                  "most {:.2g} % under {}",
                  bytesText(double(report.bytes)),
                  double(report.bytes_before) * (half_float ? 2.0 : 1.0) / double(report.bytes),
                  100.0 * report.transfer_error, 100.0 * report.light_error, 100.0 * report.worst_light_error,
                  report.worst_light));
  return small;
}

Json pcaJson(const PcaChoice& choice, const CompressReport& report) {
  if (!choice.wanted) return nullptr;
  return {{"clusters", choice.options.clusters},
          {"vectors", choice.options.vectors},
          {"bytes", report.bytes},
          {"bytes_before", report.bytes_before},
          {"transfer_error", report.transfer_error},
          {"light_error", report.light_error},
          {"worst_light_error", report.worst_light_error},
          {"worst_light", report.worst_light}};
}

}  // namespace gloam::cli
