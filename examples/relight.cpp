// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// relight BAKED.glb X Y Z OUT.ply: a reader of docs/formats/GLOAM_precomputed_transfer.md without gloam. Irradiance of vertices
// under a lamp far away towards (X, Y, Z), which gives 1, and 0.3 from everywhere; in each mesh's axes (a turned node: Q^T of them).
#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

using Json = nlohmann::json;
void check(bool good, const std::string& what) {
  if (!good) throw std::runtime_error(what);
}

struct Relight {
  Json json;
  std::string binary;
  double lamp[3] = {};
  std::ostringstream vertices;
  explicit Relight(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::string data((std::istreambuf_iterator<char>(stream)), {});
    std::uint32_t head[4] = {};
    std::memcpy(head, data.data(), std::min(data.size(), sizeof head));
    check(head[0] == 0x46546C67 && head[1] == 2 && head[3] + 28ull < data.size(), "not a .glb");
    json = Json::parse(data.substr(20, head[3]));
    binary = data.substr(28 + head[3]);
  }
  // Elements of the accessor that a member names, `expected` of them where that is not 0. Halves are bits in unsigned shorts.
  std::vector<float> numbers(const Json& object, const char* member, std::size_t expected,
                             std::size_t components = 1, bool half = false) const {
    const Json& accessor = json.at("accessors").at(object.at(member).get<std::size_t>());
    const Json& view = json.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    const std::size_t type = accessor.at("componentType"), count = accessor.at("count");
    const std::size_t size = type == 5121 ? 1 : type == 5123 ? 2 : 4;
    const std::size_t stride = view.value("byteStride", size * components);
    const std::size_t first = view.value("byteOffset", 0u) + accessor.value("byteOffset", 0u);
    check(count > 0 && (expected == 0 || count == expected) && stride < 256 && count < (1u << 31) &&
              first + (count - 1) * stride + size * components <= binary.size(),
          std::string(member) + " has another size, or exceeds its buffer");
    std::vector<float> values(count * components);
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &binary[first + i / components * stride + i % components * size], size);
      values[i] = type == 5126 ? std::bit_cast<float>(bits) : half ? fromHalf(bits) : float(bits);
      check(std::isfinite(values[i]), std::string(member) + " holds what is not a number");
    }
    return values;
  }
  static float fromHalf(std::uint32_t h) {
    const int exponent = h >> 10 & 31, mantissa = h & 1023;
    const float size = std::ldexp(float(exponent ? mantissa + 1024 : mantissa), std::max(exponent, 1) - 25);
    return exponent == 31 ? NAN : h & 0x8000 ? -size : size;
  }
  // "Spherical harmonics" of the document, by its general formula.
  static double basis(int l, int m, const double* s) {
    const int a = std::abs(m);
    double n = (a ? 2 : 1) * (2 * l + 1) / (4 * M_PI), p = 1, before = 0;
    for (int k = 0; k < a; ++k) p *= 2 * k + 1;
    const std::complex<double> around = std::pow(std::complex(s[0], s[1]), a);
    for (int k = l - a + 1; k <= l + a; ++k) n /= k;
    for (int k = a; k < l; ++k) {
      const double next = ((2 * k + 1) * s[2] * p - (k + a) * before) / (k - a + 1);
      before = p, p = next;
    }
    return std::sqrt(n) * p * (m < 0 ? around.imag() : around.real());
  }
  void light(const Json& primitive) {
    const Json& transfer = primitive.at("extensions").at("GLOAM_precomputed_transfer");
    const int version = transfer.at("version"), n = transfer.at("order");
    check(version >= 1 && version <= 3 && n >= 1 && n <= 6, "holds transfer that is not known here");
    check(!transfer.contains("texels"), "holds transfer of texels; only that of vertices is read here");
    const auto positions = numbers(primitive.at("attributes"), "POSITION", 0, 3);
    const std::size_t points = positions.size() / 3;
    std::uint32_t crc = ~0u;  // CRC-32 over words, the lowest byte first
    const auto add = [&crc](std::uint32_t word) {
      crc ^= word;
      for (int bit = 0; bit < 32; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320 : 0);
    };
    for (const float v : positions) add(std::bit_cast<std::uint32_t>(v));
    for (const float corner : numbers(primitive, "indices", 0)) add(std::uint32_t(corner));
    check(std::strtoul(transfer.at("geometry").get<std::string>().c_str(), nullptr, 16) == (crc ^ ~0u),
          "transfer belongs to another mesh");
    const bool half = transfer.at("format") == "half", bounces = transfer.at("bounces") > 0;
    const std::size_t nn = n * n, width = bounces ? 4 * nn : nn;
    // Of a vertex: n^2 numbers, then 3 n^2; as they are, or a cluster's mean and weighted vectors.
    const bool packed = transfer.contains("pca");
    const Json& pca = packed ? transfer.at("pca") : transfer;
    const std::size_t count = pca.value("vectors", 0u), clusters = pca.value("clusters", 0u);
    std::vector<float> second, weights, cluster;
    const auto first =
        numbers(pca, packed ? "means" : "direct", packed ? clusters * width : points * nn, 1, half);
    const std::size_t further = packed ? clusters * count * width : 3 * points * nn;
    if (packed || bounces) second = numbers(pca, packed ? "basis" : "indirect", further, 1, half);
    if (packed) weights = numbers(pca, "weights", points * count, 1, half);
    if (packed) cluster = numbers(pca, "cluster", points);
    const auto number = [&](std::size_t p, std::size_t d) {
      if (!packed) return d < nn ? first[p * nn + d] : second[p * 3 * nn + d - nn];
      const std::size_t k = cluster[p];
      check(k < clusters, "a cluster that is not there");
      float sum = first[k * width + d];
      for (std::size_t j = 0; j < count; ++j)
        sum += weights[p * count + j] * second[(k * count + j) * width + d];
      return sum;
    };
    for (std::size_t p = 0; p < points; ++p) {
      double e[3] = {};
      for (int l = 0, i = 0; l < n; ++l)
        for (int k = -l; k <= l; ++k, ++i)
          for (int c = 0; c < 3; ++c)
            e[c] += (basis(l, k, lamp) + (i == 0 ? 0.3 * std::sqrt(4 * M_PI) : 0)) *
                    (number(p, i) + (bounces ? number(p, nn + 3 * i + c) : 0));
      for (int c = 0; c < 3; ++c) vertices << positions[3 * p + c] << ' ';
      vertices << e[0] << ' ' << e[1] << ' ' << e[2] << '\n';
    }
  }
};

int main(int argc, char** argv) try {
  check(argc == 6, "expected BAKED.glb X Y Z OUT.ply");
  Relight file(argv[1]);
  std::istringstream direction(argv[2] + std::string(" ") + argv[3] + " " + argv[4]);
  for (double& axis : file.lamp) direction >> axis;
  const double length = std::hypot(file.lamp[0], file.lamp[1], file.lamp[2]);
  check(direction && direction.eof() && length > 0, "X Y Z have to be three numbers, not all of them 0");
  for (double& axis : file.lamp) axis /= length;
  for (const Json& mesh : file.json.at("meshes"))
    for (const Json& primitive : mesh.at("primitives"))
      if (primitive.contains("/extensions/GLOAM_precomputed_transfer"_json_pointer)) file.light(primitive);
  const std::string rows = file.vertices.str();
  check(!rows.empty(), "holds no transfer");
  std::ofstream ply(argv[5]);
  ply << "ply\nformat ascii 1.0\nelement vertex " << std::ranges::count(rows, '\n') << '\n';
  for (const char* name : {"x", "y", "z", "irradiance_red", "irradiance_green", "irradiance_blue"})
    ply << "property float " << name << '\n';
  check(bool(ply << "end_header\n" << rows << std::flush), std::string("cannot write ") + argv[5]);
} catch (const std::exception& error) {
  std::string what = error.what();
  if (what.starts_with("[json")) what = "not as the format says: " + what.substr(what.find(']') + 2);
  std::cerr << "relight: " << (argc > 1 ? argv[1] : "") << ": " << what << '\n';
  return 2;
}
