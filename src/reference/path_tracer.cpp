// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Ground truth (REF-1): sums of samples of paths, their noise, the checkpoint.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/path_tracer_state.h"
#include "reference/reference_file.h"
#include "scene/checkpoint_file.h"
#include "scene/drawn_fingerprint.h"
#include "scene/machine_memory.h"

namespace gloam {

namespace reference {

namespace {

constexpr CheckpointKind kReference{{'g', 'l', 'o', 'a', 'm', 'r', 'e', 'f'}, 4, "a reference picture"};

void checkRange(const char* name, int value, int low, int high) {
  if (value < low || value > high) {
    throw Error("reference", fmt::format("{} is {}; expected {} to {}", name, value, low, high));
  }
}

void checkOptions(const ReferenceOptions& options) {
  checkRange("width", options.width, 1, 16384);
  checkRange("height", options.height, 1, 16384);
  checkRange("supersample", options.supersample, 1, 4);
  checkRange("bounces", options.bounces, 0, kMaxBounces);
  checkRange("environment_order", options.environment_order, 0, 6);
  checkRange("threads", options.threads, 0, 1024);
}

double gibibytes(double bytes) {
  return bytes / double(1 << 30);
}

}  // namespace

std::uint32_t PathSums::least() const {
  return *std::min_element(samples.begin(), samples.end());
}

std::uint32_t PathSums::most() const {
  return *std::max_element(samples.begin(), samples.end());
}

PathSums makePathSums(const ReferenceOptions& options, const Integrator& integrator) {
  PathSums sums;
  sums.width = options.width;
  sums.height = options.height;
  sums.positions = options.supersample * options.supersample;
  for (int p = 0; p < kLightPathCount; ++p) {
    if (covers(options.light, LightPath(p)) && integrator.has(LightPath(p)))
      sums.paths.push_back(LightPath(p));
  }
  const std::size_t pixels = sums.pixelCount();
  const std::size_t numbers = 3 * (2 * sums.paths.size() + (sums.positions > 1 ? 3 : 2)) + 2;
  // Besides the sums: layers of geometry, and the picture when it is asked for.
  const double needed = double(pixels) * (8.0 * double(numbers) + 36.0 + 60.0);
  const double there = double(memoryOfMachine());
  if (needed > there) {
    throw Error("reference", fmt::format("{} x {} pixels need {:.1f} GiB of memory; the machine has {:.1f}",
                                         options.width, options.height, gibibytes(needed), gibibytes(there)));
  }
  const int tiles_down = (options.height + kTileSize - 1) / kTileSize;
  sums.samples.resize(std::size_t(sums.tilesAcross()) * std::size_t(tiles_down));
  sums.sums.resize(pixels * sums.paths.size() * 3);
  sums.squares.resize(pixels * 3);
  if (sums.positions > 1) sums.round.resize(pixels * 3);
  sums.half.resize(pixels * 3);
  sums.errors.resize(pixels * 2);
  sums.part_halves.resize(sums.sums.size());
  sums.part_errors.resize(sums.sums.size());
  return sums;
}

glm::dvec3 lightInRounds(const PathSums& sums, std::size_t pixel) {
  const std::size_t paths = sums.paths.size();
  glm::dvec3 light(0.0);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t p = 0; p < paths; ++p) light[int(c)] += sums.sums[(pixel * paths + p) * 3 + c];
    if (!sums.round.empty()) light[int(c)] -= sums.round[3 * pixel + c];
  }
  return light;
}

glm::dvec3 independentVariance(const PathSums& sums, std::size_t pixel, std::uint32_t samples) {
  const double rounds = double(samples / std::uint32_t(sums.positions)), positions = double(sums.positions);
  if (rounds < 2.0) return glm::dvec3(std::numeric_limits<double>::infinity());
  const glm::dvec3 light = lightInRounds(sums, pixel);
  const double* squares = &sums.squares[3 * pixel];
  const glm::dvec3 spread = glm::dvec3(squares[0], squares[1], squares[2]) - light * light / rounds;
  return glm::max(spread, glm::dvec3(0.0)) / ((rounds - 1.0) * rounds * positions * positions);
}

void measureError(PathSums& sums, std::size_t pixel, std::uint32_t samples) {
  const glm::dvec3 light = lightInRounds(sums, pixel);
  double* half = &sums.half[3 * pixel];
  if (samples > std::uint32_t(sums.positions)) {
    const glm::dvec3 first(half[0], half[1], half[2]);
    const glm::dvec3 error = (2.0 * first - light) / double(samples);
    const glm::dvec3 independent = independentVariance(sums, pixel, samples);
    sums.errors[2 * pixel] = glm::dot(error, error);
    sums.errors[2 * pixel + 1] = independent.x + independent.y + independent.z;
  }
  for (int c = 0; c < 3; ++c) half[c] = light[c];
  const std::size_t parts = 3 * sums.paths.size(), first = pixel * parts;
  for (std::size_t i = first; i < first + parts; ++i) {
    const double error = (2.0 * double(sums.part_halves[i]) - sums.sums[i]) / double(samples);
    sums.part_errors[i] = samples > std::uint32_t(sums.positions) ? float(error) : 0.0f;
    sums.part_halves[i] = float(sums.sums[i]);
  }
}

double evenness(const PathSums& sums) {
  double happened = 0.0, independent = 0.0;
  for (std::size_t pixel = 0; pixel < sums.pixelCount(); ++pixel) {
    happened += sums.errors[2 * pixel];
    independent += sums.errors[2 * pixel + 1];
  }
  return independent > 0.0 ? happened / independent : 1.0;
}

namespace {

std::uint32_t samplesOf(const PathSums& sums, std::size_t pixel) {
  return sums
      .samples[sums.tileOf(int(pixel % std::size_t(sums.width)), int(pixel / std::size_t(sums.width)))];
}

}  // namespace

std::vector<std::vector<double>> partCovariances(const PathSums& sums) {
  const std::size_t paths = sums.paths.size(), pixels = sums.pixelCount();
  std::vector<std::vector<double>> products(paths, std::vector<double>(paths, 0.0));
  double then = 0.0,
         now = 0.0;  // variances of independent samples: since the errors happened, more have come
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const glm::dvec3 independent = independentVariance(sums, pixel, samplesOf(sums, pixel));
    now += independent.x + independent.y + independent.z;
    then += sums.errors[2 * pixel + 1];
    const float* errors = sums.part_errors.data() + pixel * paths * 3;
    for (std::size_t a = 0; a < paths; ++a) {
      for (std::size_t b = 0; b < paths; ++b) {
        for (std::size_t c = 0; c < 3; ++c)
          products[a][b] += double(errors[3 * a + c]) * double(errors[3 * b + c]);
      }
    }
  }
  if (std::isinf(now)) return {};
  const double scale = (then > 0.0 ? now / then : 1.0) / (3.0 * double(pixels));
  for (std::vector<double>& row : products) {
    for (double& value : row) value *= scale;
  }
  return products;
}

double meanVariance(const PathSums& sums) {
  double variance = 0.0;
  for (std::size_t pixel = 0; pixel < sums.pixelCount(); ++pixel) {
    const glm::dvec3 of_pixel = independentVariance(sums, pixel, samplesOf(sums, pixel));
    variance += of_pixel.x + of_pixel.y + of_pixel.z;
  }
  if (std::isinf(variance)) return variance;
  return evenness(sums) * variance / (3.0 * double(sums.pixelCount()));
}

double noiseOf(const PathSums& sums) {
  const std::size_t paths = sums.paths.size();
  double reflected = 0.0;
  for (std::size_t pixel = 0; pixel < sums.pixelCount(); ++pixel) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3 * paths; ++i) {
      if (sums.paths[i / 3] != kSeen) sum += sums.sums[pixel * paths * 3 + i];
    }
    reflected += sum / double(std::max(samplesOf(sums, pixel), 1u));
  }
  const double variance = meanVariance(sums), values = 3.0 * double(sums.pixelCount());
  if (std::isinf(variance)) return variance;
  return reflected > 0.0 ? std::sqrt(variance) / (reflected / values) : 0.0;
}

Fingerprint fingerprintOf(const Scene& scene, const PosedScene& posed, const PosedCamera& camera,
                          const Environment& environment, const ReferenceOptions& options) {
  Fingerprint print;
  const auto& [width, height, supersample, light, bounces, environment_order, background, seed, threads] =
      options;
  addAll(print, std::string(GLOAM_VERSION), kReferenceRevision, scene, posed, camera, environment, width,
         height, supersample, coverageText(light), bounces, environment_order, background, seed);
  return print;
}

}  // namespace reference

using namespace reference;

struct PathTracer::Impl : TracerState {};

PathTracer::PathTracer(const Scene& scene, const PosedScene& posed, const PosedCamera& camera,
                       const Environment& environment, const ReferenceOptions& options,
                       const Progress& progress)
    : impl_(std::make_unique<Impl>()) {
  checkOptions(options);
  impl_->options = options;
  impl_->fingerprint = fingerprintOf(scene, posed, camera, environment, options);
  impl_->scene = drawnFingerprint(scene, posed).text();
  impl_->environment_light = drawnFingerprint(environment).text();
  impl_->camera = drawnFingerprint(camera).text();
  impl_->integrator = std::make_unique<Integrator>(scene, posed, camera, environment, options, progress);
  try {
    impl_->sums = makePathSums(options, *impl_->integrator);
    lookAround(*impl_, progress);
  } catch (const std::bad_alloc&) {
    throw Error("reference",
                fmt::format("not enough memory for {} x {} pixels", options.width, options.height));
  }
}

PathTracer::~PathTracer() = default;
PathTracer::PathTracer(PathTracer&&) noexcept = default;
PathTracer& PathTracer::operator=(PathTracer&&) noexcept = default;

void PathTracer::refine(int samples, const Progress& progress) {
  const std::uint32_t least = impl_->sums.least();
  if (samples < 0 || std::int64_t(least) + samples > kMaxSamples) {
    throw Error("reference",
                fmt::format("{} more samples; expected 0 to {}", samples, kMaxSamples - int(least)));
  }
  const std::uint32_t until = least + std::uint32_t(samples);
  Watch watch{{}, progress.should_stop};
  if (progress.update) {
    watch.tell = [&](double done) {
      progress.report((done - double(least)) / double(std::max(samples, 1)),
                      fmt::format("reference: {:.0f} of {} samples", done, until));
    };
  }
  if (advance(*impl_, until, watch)) return;
  throw Interrupted(fmt::format("reference stopped after {} samples a pixel", impl_->sums.least()));
}

int PathTracer::samples() const {
  return int(impl_->sums.least());
}

int PathTracer::mostSamples() const {
  return int(impl_->sums.most());
}

double PathTracer::noise() const {
  return noiseOf(impl_->sums);
}

const ReferenceReport& PathTracer::report() const {
  impl_->report.samples = samples();
  impl_->report.noise = noise();
  return impl_->report;
}

LayeredImage PathTracer::image() const {
  return pictureOf(*impl_, impl_->options.light, true, false);
}

LayeredImage PathTracer::image(const Coverage& part) const {
  return pictureOf(*impl_, part, false, false);
}

LayeredImage PathTracer::imageWithParts() const {
  return pictureOf(*impl_, impl_->options.light, true, true);
}

void PathTracer::save(const std::filesystem::path& checkpoint) const {
  CheckpointWriter file(checkpoint, kReference, impl_->fingerprint);
  impl_->sums.forContents([&](const void* data, std::size_t bytes) { file.write(data, bytes); });
  file.commit();
}

void PathTracer::load(const std::filesystem::path& checkpoint) {
  CheckpointReader file(checkpoint, kReference, impl_->fingerprint);
  PathSums read = impl_->sums;  // what is there stays until the file has proved whole
  read.forContents([&](void* data, std::size_t bytes) { file.read(data, bytes); });
  if (read.most() > std::uint32_t(kMaxSamples)) file.damaged("samples");
  file.finish();
  impl_->sums = std::move(read);
  impl_->report.resumed = true;
}

}  // namespace gloam
