// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The sky as blocks. Within one cell directions follow the importance g, which is bilinear there. Within a larger block they are
// nearly even in solid angle, so samples vary as far as g does; a block chosen in proportion to the root mean square of g times
// its solid angle makes the least of that. The block that would gain most is quartered, until little can be gained or there are
// as many as a processor keeps close by: reading the sky's picture itself, texel by texel from memory, costs more than tracing
// the ray.
#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "reference/distribution.h"
#include "reference/sky_lanes.h"

namespace gloam::reference {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kMostBlocks = 16384;
constexpr double kEnough = 0.002;     // share of the light by which root mean squares may exceed means
constexpr double kLeastShare = 1e-7;  // of the chances: more than the numbers' steps
constexpr double kSun = 100.0;        // times the mean importance of the whole sky
constexpr std::size_t kMostTiles = 4096;
constexpr int kRowBits = 8, kBlockBits = 9;  // of the tables of where to begin

/// Solid angle, integral of g and of its square over it.
struct Moments {
  double area = 0.0, g = 0.0, g2 = 0.0;
  double weight() const { return std::sqrt(g2 * area); }
  double excess() const { return std::max(0.0, weight() - g); }
  void add(const Moments& o) { area += o.area, g += o.g, g2 += o.g2; }
};

/// A square of the picture, in cells.
struct Square {
  int x = 0, y = 0, size = 0;
};

struct Leaf {
  Square square;
  Moments moments;
  std::size_t parent = 0;                            // index into entries: tiles first, then nodes
  int row = 0;                                       // of tiles, or the one more of suns
  bool follows() const { return square.size == 1; }  // its directions follow the light
  double weight() const { return follows() ? moments.g : moments.weight(); }
  double excess() const { return follows() ? 0.0 : moments.excess(); }
};

class Builder {
 public:
  Builder(SkyTable& sky, std::span<const float> importance) : sky_(sky), importance_(importance) {}
  void run();

 private:
  Moments momentsOf(int x, int y, int size) const;
  Moments momentsIn(double x0, double y0, double x1, double y1) const;
  void split(std::size_t leaf);
  std::int32_t& entry(std::size_t i) {
    return i < sky_.tiles.size() ? sky_.tiles[i] : sky_.nodes[i - sky_.tiles.size()];
  }
  void refine();
  std::size_t setRows();
  double importanceAt(int cell_x, int cell_y, double x, double y) const;
  SkyBlock blockOf(const Leaf& leaf, double chance) const;
  void finish();

  SkyTable& sky_;
  std::span<const float> importance_;
  std::vector<Leaf> leaves_;
};

double Builder::importanceAt(int cell_x, int cell_y, double x, double y) const {
  const std::size_t row = std::size_t(sky_.width + 1);
  const float* t = &importance_[std::size_t(cell_y) * row + std::size_t(cell_x)];
  const double right = x - cell_x, down = y - cell_y;
  return (double(t[0]) * (1.0 - right) + double(t[1]) * right) * (1.0 - down) +
         (double(t[row]) * (1.0 - right) + double(t[row + 1]) * right) * down;
}

/// Part of one cell, in which the importance is bilinear and the cosine taken as constant.
Moments Builder::momentsIn(double x0, double y0, double x1, double y1) const {
  y0 = std::max(y0, 0.5), y1 = std::min(y1, double(sky_.height) + 0.5);
  x1 = std::min(x1, double(sky_.width));
  if (!(x1 > x0) || !(y1 > y0)) return {};
  const int cell_x = int(x0), cell_y = int(y0);
  const auto value = [&](double x, double y) { return importanceAt(cell_x, cell_y, x, y); };
  const double a = value(x0, y0), b = value(x1, y0), c = value(x0, y1), d = value(x1, y1);
  const double cosine = std::sin((0.5 * (y0 + y1) - 0.5) / sky_.height * kPi);
  const double area = (x1 - x0) / sky_.width * 2.0 * kPi * (y1 - y0) / sky_.height * kPi * cosine;
  const double square =
      (a * a + b * b + c * c + d * d + a * b + a * c + b * d + c * d + 0.5 * (a * d + b * c)) / 9.0;
  return {area, 0.25 * (a + b + c + d) * area, square * area};
}

Moments Builder::momentsOf(int x, int y, int size) const {
  Moments sum;
  const int last_y = std::min(y + size, sky_.height + 1), last_x = std::min(x + size, sky_.width);
  for (int row = y; row < last_y; ++row)
    for (int column = x; column < last_x; ++column) sum.add(momentsIn(column, row, column + 1, row + 1));
  return sum;
}

/// Its four quarters: the first in its place, the others at the end.
void Builder::split(std::size_t index) {
  const Leaf old = leaves_[index];
  const std::size_t first = sky_.nodes.size();
  sky_.nodes.resize(first + 4, 0);
  entry(old.parent) = ~std::int32_t(first);
  const int half = old.square.size / 2;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const int x = old.square.x + (quarter & 1) * half, y = old.square.y + (quarter >> 1) * half;
    const Leaf leaf{{x, y, half}, momentsOf(x, y, half), sky_.tiles.size() + first + std::size_t(quarter)};
    if (quarter == 0) {
      leaves_[index] = leaf;
    } else {
      leaves_.push_back(leaf);
    }
  }
}

void Builder::refine() {
  using Wish = std::pair<double, std::size_t>;
  std::priority_queue<Wish> wishes;
  double light = 0.0, excess = 0.0;
  const auto wish = [&](std::size_t i) {
    const double gain = leaves_[i].excess();
    excess += gain;
    if (gain > 0.0) wishes.push({gain, i});
  };
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    light += leaves_[i].moments.g;
    wish(i);
  }
  while (!wishes.empty() && excess > kEnough * light && leaves_.size() + 3 <= kMostBlocks) {
    const auto [gain, i] = wishes.top();
    wishes.pop();
    excess -= gain;
    const std::size_t before = leaves_.size();
    split(i);
    wish(i);
    for (std::size_t k = before; k < leaves_.size(); ++k) wish(k);
  }
}

/// Place of a square on Hilbert's curve (Hilbert 1891) over 2^bits by 2^bits.
std::uint64_t alongCurve(std::uint32_t x, std::uint32_t y, int bits) {
  std::uint64_t place = 0;
  for (std::uint32_t s = 1u << (bits - 1); s > 0; s >>= 1) {
    const bool right = (x & s) != 0, down = (y & s) != 0;
    place += std::uint64_t(s) * s * ((right ? 3u : 0u) ^ (down ? 1u : 0u));
    if (!down) {
      if (right) {
        x = ~x;
        y = ~y;
      }
      std::swap(x, y);
    }
  }
  return place;
}

void append(const Distribution& choice, std::vector<std::uint32_t>& starts,
            std::vector<std::uint16_t>& first) {
  starts.insert(starts.end(), choice.starts().begin(), choice.starts().end());
  starts.push_back(0xffffffffu);
  for (const std::uint32_t entry : choice.first()) first.push_back(std::uint16_t(entry));
  first.push_back(std::uint16_t(choice.last()));
}

SkyBlock Builder::blockOf(const Leaf& leaf, double chance) const {
  const Square& square = leaf.square;
  const double x0 = square.x, y0 = std::max(double(square.y), 0.5);
  const double x1 = std::min(square.x + square.size, sky_.width);
  const double y1 = std::min(double(square.y + square.size), sky_.height + 0.5);
  if (!(x1 > x0) || !(y1 > y0)) return {float(x0), float(y0)};
  SkyBlock block{float(x0), float(y0), float(x1 - x0), float(y1 - y0)};
  const auto cosine = [&](double y) { return std::sin((y - 0.5) / sky_.height * kPi); };
  const double least = 0.1 * cosine(0.5 * (y0 + y1));  // at the poles, too, something is chosen
  double corners[4], sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    const double x = i & 1 ? x1 : x0, y = i & 2 ? y1 : y0;
    corners[i] = std::max(least, cosine(y)) * (leaf.follows() ? importanceAt(square.x, square.y, x, y) : 1.0);
    sum += corners[i];
  }
  const double extent = (x1 - x0) / sky_.width * 2.0 * kPi * (y1 - y0) / sky_.height * kPi * 0.25 * sum;
  for (int i = 0; extent > 0.0 && i < 4; ++i) block.densities[i] = float(corners[i] * chance / extent);
  return block;
}

/// Cells that are far brighter than the whole sky, a sun, are one more row together: among others they would get a part of
/// evenly spread pairs whose number wavers more.
std::size_t Builder::setRows() {
  const int size = 1 << sky_.tile_bits;
  const std::size_t rows = sky_.tiles.size() / std::size_t(sky_.tiles_across);
  Moments sky;
  for (const Leaf& leaf : leaves_) sky.add(leaf.moments);
  bool suns = false;
  for (Leaf& leaf : leaves_) {
    const bool sun = leaf.follows() && leaf.moments.g * sky.area > kSun * sky.g * leaf.moments.area;
    leaf.row = sun ? int(rows) : leaf.square.y / size;
    suns = suns || sun;
  }
  return suns ? rows + 1 : rows;
}

/// A row of tiles is chosen by one random number and a block in it by the other: evenly spread pairs choose evenly.
void Builder::finish() {
  constexpr int kCurveBits = 16;  // 32768 texels and the last row
  const int size = 1 << sky_.tile_bits;
  const std::size_t rows = setRows();
  std::sort(leaves_.begin(), leaves_.end(), [&](const Leaf& a, const Leaf& b) {
    const auto place = [&](const Leaf& leaf) {
      const int x = leaf.square.x, y = leaf.square.y;
      return std::tuple(leaf.row, x / size, alongCurve(std::uint32_t(x), std::uint32_t(y), kCurveBits));
    };
    return place(a) < place(b);
  });
  double total = 0.0;
  for (const Leaf& leaf : leaves_) total += leaf.weight();
  std::vector<std::vector<float>> weights(rows);
  std::vector<float> row_weights(rows);
  for (const Leaf& leaf : leaves_) {
    const double weight = leaf.weight();
    const auto row = std::size_t(leaf.row);
    weights[row].push_back(weight > 0.0 ? float(std::max(weight, kLeastShare * total)) : 0.0f);
    row_weights[row] += weights[row].back();
  }
  const Distribution row_choice(row_weights, kRowBits);
  if (row_choice.empty()) return;
  sky_.row_shift = 32 - kRowBits;
  sky_.block_shift = 32 - kBlockBits;
  append(row_choice, sky_.row_starts, sky_.row_first);
  for (std::size_t row = 0, leaf = 0; row < rows; ++row) {
    sky_.row_blocks.push_back(std::int32_t(leaf));
    const Distribution choice(weights[row], kBlockBits);
    append(choice, sky_.block_starts, sky_.block_first);
    for (std::size_t i = 0; i < weights[row].size(); ++i, ++leaf) {
      const double chance =
          double(row_choice.probability(std::uint32_t(row))) * double(choice.probability(std::uint32_t(i)));
      entry(leaves_[leaf].parent) = std::int32_t(leaf);
      sky_.blocks.push_back(blockOf(leaves_[leaf], chance));
    }
  }
  sky_.row_first.push_back(0);
  sky_.block_first.push_back(0);
}

void Builder::run() {
  const auto tilesAlong = [&](int cells) { return (cells + (1 << sky_.tile_bits) - 1) >> sky_.tile_bits; };
  sky_.tile_bits = 4;
  while (std::size_t(tilesAlong(sky_.width)) * std::size_t(tilesAlong(sky_.height + 1)) > kMostTiles)
    ++sky_.tile_bits;
  sky_.tiles_across = tilesAlong(sky_.width);
  sky_.tiles.assign(std::size_t(sky_.tiles_across) * std::size_t(tilesAlong(sky_.height + 1)), 0);
  const int size = 1 << sky_.tile_bits;
  for (std::size_t i = 0; i < sky_.tiles.size(); ++i) {
    const int x = int(i) % sky_.tiles_across * size, y = int(i) / sky_.tiles_across * size;
    leaves_.push_back({{x, y, size}, momentsOf(x, y, size), i});
  }
  refine();
  finish();
}

}  // namespace

void fillBlocks(SkyTable& sky, std::span<const float> importance) {
  Builder(sky, importance).run();
}

}  // namespace gloam::reference
