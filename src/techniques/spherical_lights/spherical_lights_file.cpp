// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// docs/formats/emission.md.
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "image/atomic_file.h"
#include "image/limits.h"
#include "techniques/spherical_lights/spherical_lights_prepare.h"

namespace gloam {

namespace {

constexpr char kMagic[8] = {'g', 'l', 'o', 'a', 'm', ' ', 's', 'l'};
constexpr std::uint32_t kVersion = 1;
constexpr int kCoefficients = kEmissionOrder * kEmissionOrder;
constexpr std::size_t kSampleBytes = 20;
constexpr std::size_t kSphereBytes = kEmissionDirections * kSampleBytes + 2 * kCoefficients * 12;
constexpr std::size_t kFingerprintBytes = 32;

/// Grows by what is put into it; numbers little-endian, as all machines that this runs on have them.
class Bytes {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* from = reinterpret_cast<const std::uint8_t*>(&value);
    all_.insert(all_.end(), from, from + sizeof value);
  }
  void put(const std::string& text) { all_.insert(all_.end(), text.begin(), text.end()); }
  const std::vector<std::uint8_t>& all() const { return all_; }

 private:
  std::vector<std::uint8_t> all_;
};

/// Reads in order; the size was checked before.
class Reader {
 public:
  explicit Reader(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}
  template <class T>
  T get() {
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  std::string text(std::size_t size) {
    const auto* from = reinterpret_cast<const char*>(bytes_.data() + at_);
    at_ += size;
    return {from, size};
  }

 private:
  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_ = 0;
};

std::size_t sizeFor(const SceneSpheres& spheres) {
  return sizeof kMagic + 2 * sizeof(std::uint32_t) +
         spheres.sets.size() * (kFingerprintBytes + sizeof(std::uint32_t)) +
         std::size_t(spheres.count()) * kSphereBytes + kFingerprintBytes;
}

glm::vec3 colour(Reader& in, const std::string& place) {
  const auto value = in.get<glm::vec3>();
  for (int c = 0; c < 3; ++c) {
    if (!std::isfinite(value[c])) throw Error(place, "expected numbers");
  }
  return value;
}

SphereEmission readSphere(Reader& in, const std::string& place, const Scene& scene, const SphereSet& set) {
  SphereEmission out;
  for (EmissionSample& sample : out.samples) {
    sample.part = in.get<std::int32_t>();
    sample.triangle = in.get<std::uint32_t>();
    sample.u = in.get<float>(), sample.v = in.get<float>();
    sample.side = in.get<std::int32_t>();
    if (sample.part == kNone) continue;
    if (sample.part < 0 || std::size_t(sample.part) >= set.meshes.size())
      throw Error(place + ": sample", fmt::format("part {} of {}", sample.part, set.meshes.size()));
    const Mesh& mesh = scene.meshes[std::size_t(set.meshes[std::size_t(sample.part)])];
    if (sample.triangle >= mesh.triangleCount())
      throw Error(place + ": sample",
                  fmt::format("triangle {} of {}", sample.triangle, mesh.triangleCount()));
    const bool within = sample.u >= 0.0f && sample.v >= 0.0f && sample.u + sample.v <= 1.001f;
    if (!within || (sample.side != 1 && sample.side != -1))
      throw Error(place + ": sample", "expected a point of its triangle, and a side of 1 or -1");
  }
  out.albedo = out.glow = sh::ShRgb(kEmissionOrder);
  for (int i = 0; i < kCoefficients; ++i) out.albedo[i] = colour(in, place + ": albedo");
  for (int i = 0; i < kCoefficients; ++i) out.glow[i] = colour(in, place + ": glow");
  return out;
}

std::string checksum(const std::vector<std::uint8_t>& bytes, std::size_t size) {
  Fingerprint print;
  print.addBytes(bytes.data(), size);
  return print.text();
}

}  // namespace

void writeEmission(const SceneEmission& emission, const std::filesystem::path& path) {
  Bytes out;
  for (const char c : kMagic) out.put(c);
  out.put(kVersion);
  out.put(std::uint32_t(emission.sets.size()));
  for (const SetEmission& set : emission.sets) {
    if (set.fingerprint.size() != kFingerprintBytes)
      throw Error(path.string(), "a set without its fingerprint cannot be written");
    out.put(set.fingerprint);
    out.put(std::uint32_t(set.spheres.size()));
    for (const SphereEmission& sphere : set.spheres) {
      for (const EmissionSample& sample : sphere.samples) {
        out.put(sample.part), out.put(sample.triangle), out.put(sample.u), out.put(sample.v),
            out.put(sample.side);
      }
      for (int i = 0; i < kCoefficients; ++i) out.put(sphere.albedo[i]);
      for (int i = 0; i < kCoefficients; ++i) out.put(sphere.glow[i]);
    }
  }
  const std::string sum = checksum(out.all(), out.all().size());
  out.put(sum);
  AtomicFile file(path);
  file.write(out.all().data(), out.all().size());
  file.commit();
}

SceneEmission readEmission(const std::filesystem::path& path, const Scene& scene,
                           const SceneSpheres& spheres) {
  const std::string place = path.string();
  const std::vector<std::uint8_t> bytes = readBytes(path);
  if (bytes.size() < sizeof kMagic || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0)
    throw Error(place, "expected what spheres send, as gloam keeps it");
  if (bytes.size() != sizeFor(spheres))
    throw Error(place,
                fmt::format("{} bytes; these spheres ask for {}: it belongs to others, or is cut short",
                            bytes.size(), sizeFor(spheres)));
  const std::size_t end = bytes.size() - kFingerprintBytes;
  if (checksum(bytes, end) != std::string(bytes.begin() + std::ptrdiff_t(end), bytes.end()))
    throw Error(place, "its checksum is not that of its contents: damaged");
  Reader in(bytes);
  in.text(sizeof kMagic);
  if (const auto version = in.get<std::uint32_t>(); version != kVersion)
    throw Error(place + ": version", fmt::format("{}, expected {}", version, kVersion));
  if (in.get<std::uint32_t>() != spheres.sets.size())
    throw Error(place + ": sets", fmt::format("expected {}", spheres.sets.size()));
  SceneEmission emission;
  for (std::size_t s = 0; s < spheres.sets.size(); ++s) {
    const SphereSet& set = spheres.sets[s];
    const std::string where = fmt::format("{}: sets[{}]", place, s);
    SetEmission& out = emission.sets.emplace_back();
    out.fingerprint = in.text(kFingerprintBytes);
    if (out.fingerprint != spherical_lights::emissionFingerprint(set))
      throw Error(where + ": fingerprint", "belongs to other spheres");
    if (in.get<std::uint32_t>() != set.spheres.size())
      throw Error(where + ": spheres", fmt::format("expected {}", set.spheres.size()));
    for (std::size_t i = 0; i < set.spheres.size(); ++i)
      out.spheres.push_back(readSphere(in, fmt::format("{}: spheres[{}]", where, i), scene, set));
  }
  return emission;
}

}  // namespace gloam
