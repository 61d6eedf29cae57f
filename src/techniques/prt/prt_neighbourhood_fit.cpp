// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Least squares over hat functions: numbers v at the points of a grid that minimise
//   sum over samples s of (sum_i w_i(s) v_i - V(s))^2 + kStay sum_i (v_i - v0_i)^2
// with w_i the weights by which s is interpolated and v0 what was traced at the points themselves. Interpolation between values
// that are traced at the points lies beside what is curved, always on the same side; the fit lies on both, at two fifths of the
// distance (RMS, where V is smooth). Samples inside the object are left out, so that points inside continue what is outside.
// Solved by conjugate gradients (Shewchuk, An Introduction to the Conjugate Gradient Method Without the Agonizing Pain, B3),
// all coefficients together.
#include "techniques/prt/prt_neighbourhood_fit.h"

#include <tbb/parallel_for.h>

#include <array>
#include <utility>

namespace gloam::prt {
namespace {

constexpr int kIterations = 12;
constexpr float kStay = 0.02f;  // of 2.4, the sum of a point's squared weights

/// The weight of a cell's corner at one of its samples.
float weightOf(int corner, std::size_t sample) {
  const glm::vec3 at = cellSample(sample), step(corner & 1, corner >> 1 & 1, corner >> 2);
  const glm::vec3 w = glm::mix(1.0f - at, at, step);
  return w.x * w.y * w.z;
}

class Fit {
 public:
  explicit Fit(NeighbourhoodState& state) : state_(state), grid_(state.grid), row_(grid_.visibilityCount()) {
    for (int a = 0; a < 8; ++a)
      for (std::size_t k = 0; k < kCellSamples; ++k) weight_[std::size_t(a)][k] = weightOf(a, k);
  }

  void solve() {
    std::vector<float>& v = grid_.visibility;
    std::vector<float> residual(v.size()), way(v.size()), product(v.size());
    std::vector<float> scale(grid_.points());
    eachPoint([&](std::size_t p) { start(p, &residual[p * row_], scale[p]); });
    eachNumber([&](std::size_t i) { way[i] = residual[i] / scale[i / row_]; });
    double left = dot(residual, way);
    const double enough = 1e-8 * left;
    for (int iteration = 0; iteration < kIterations && left > enough; ++iteration) {
      eachPoint([&](std::size_t p) { multiply(p, way, &product[p * row_]); });
      const float step = float(left / dot(way, product));
      eachNumber([&](std::size_t i) {
        v[i] += step * way[i];
        residual[i] -= step * product[i];
        product[i] = residual[i] / scale[i / row_];
      });
      const double next = dot(residual, product);
      const float keep = float(next / left);
      eachNumber([&](std::size_t i) { way[i] = product[i] + keep * way[i]; });
      left = next;
    }
  }

 private:
  template <class Do>
  void eachPoint(const Do& act) const {
    tbb::parallel_for(std::size_t(0), grid_.points(), act);
  }
  template <class Do>
  void eachNumber(const Do& act) const {
    eachPoint([&](std::size_t p) {
      for (std::size_t i = p * row_; i < (p + 1) * row_; ++i) act(i);
    });
  }
  /// In one order, whatever the threads.
  double dot(const std::vector<float>& a, const std::vector<float>& b) const {
    std::vector<double> sums(grid_.points(), 0.0);
    eachNumber([&](std::size_t i) { sums[i / row_] += double(a[i]) * double(b[i]); });
    double sum = 0.0;
    for (const double s : sums) sum += s;
    return sum;
  }

  /// visit(cell, which of its corners the point is) for the cells around a point; a cell is called by its first corner.
  template <class Visit>
  void eachCell(std::size_t point, const Visit& visit) const {
    const glm::ivec3 at = grid_.pointAt(point);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 cell = at - glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
      if (glm::any(glm::lessThan(cell, glm::ivec3(0))) ||
          glm::any(glm::greaterThanEqual(cell, grid_.size - 1)))
        continue;
      visit(cell, corner);
    }
  }
  std::size_t cornerOf(const glm::ivec3& cell, int corner) const {
    return grid_.numberOf(cell + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2));
  }
  /// The sum of w_a w_b over the samples of a cell that count.
  float together(const glm::ivec3& cell, int a, int b) const {
    const std::uint8_t* inside = &state_.sample_inside[grid_.numberOf(cell) * kCellSamples];
    float sum = 0.0f;
    for (std::size_t k = 0; k < kCellSamples; ++k)
      sum += inside[k] ? 0.0f : weight_[std::size_t(a)][k] * weight_[std::size_t(b)][k];
    return sum;
  }

  /// out = sum of w (V - what interpolation says now) over a point's samples.
  void start(std::size_t point, float* out, float& scale) const {
    std::fill_n(out, row_, 0.0f);
    scale = kStay;
    eachCell(point, [&](const glm::ivec3& cell, int a) {
      const std::size_t first = grid_.numberOf(cell) * kCellSamples;
      for (std::size_t k = 0; k < kCellSamples; ++k) {
        if (state_.sample_inside[first + k]) continue;
        const float* truth = &state_.samples[(first + k) * row_];
        const float w = weight_[std::size_t(a)][k];
        for (std::size_t i = 0; i < row_; ++i) out[i] += w * truth[i];
      }
      for (int b = 0; b < 8; ++b) {
        const float w = together(cell, a, b);
        const float* now = &grid_.visibility[cornerOf(cell, b) * row_];
        for (std::size_t i = 0; i < row_; ++i) out[i] -= w * now[i];
      }
      scale += together(cell, a, a);
    });
  }

  /// out = (A + kStay) x at one point, A_ij the sum of w_i w_j over all samples.
  void multiply(std::size_t point, const std::vector<float>& x, float* out) const {
    const float* own = &x[point * row_];
    for (std::size_t i = 0; i < row_; ++i) out[i] = kStay * own[i];
    eachCell(point, [&](const glm::ivec3& cell, int a) {
      for (int b = 0; b < 8; ++b) {
        const float w = together(cell, a, b);
        const float* other = &x[cornerOf(cell, b) * row_];
        for (std::size_t i = 0; i < row_; ++i) out[i] += w * other[i];
      }
    });
  }

  NeighbourhoodState& state_;
  NeighbourhoodTransfer& grid_;
  std::size_t row_;
  std::array<std::array<float, kCellSamples>, 8> weight_;
};

}  // namespace

void fillInside(NeighbourhoodState& state) {
  NeighbourhoodTransfer& grid = state.grid;
  std::vector<std::uint8_t> known(grid.points());
  std::vector<std::size_t> waiting;
  for (std::size_t p = 0; p < known.size(); ++p) {
    known[p] = !state.inside[p];
    if (!known[p]) waiting.push_back(p);
  }
  const glm::ivec3 size = grid.size;
  const auto fill = [&](std::size_t p) {
    const glm::ivec3 at = grid.pointAt(p);
    std::vector<std::pair<std::size_t, float>> near;
    float sum = 0.0f;
    for (int n = 0; n < 27; ++n) {
      const glm::ivec3 step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1), q = at + step;
      if (glm::any(glm::lessThan(q, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(q, size))) continue;
      const std::size_t other = grid.numberOf(q);
      if (!known[other]) continue;
      const glm::vec3 way = grid.position(glm::vec3(q)) - grid.position(glm::vec3(at));
      near.emplace_back(other, 1.0f / std::max(1e-20f, glm::dot(way, way)));
      sum += near.back().second;
    }
    const auto mix = [&](std::vector<float>& values, std::size_t row) {
      for (std::size_t i = 0; i < row && !values.empty(); ++i) {
        float value = 0.0f;
        for (const auto& [other, weight] : near) value += weight / sum * values[other * row + i];
        values[p * row + i] = value;
      }
    };
    if (near.empty()) return false;
    mix(grid.visibility, grid.visibilityCount());
    mix(grid.indirect, 3 * grid.matrixCount());
    return true;
  };
  while (!waiting.empty()) {
    std::vector<std::size_t> filled, later;
    for (const std::size_t p : waiting) (fill(p) ? filled : later).push_back(p);
    if (filled.empty()) return;  // all of it is inside
    for (const std::size_t p : filled) known[p] = 1;
    waiting.swap(later);
  }
}

void fitVisibility(NeighbourhoodState& state) {
  Fit(state).solve();
}

void fitThrown(NeighbourhoodState& state) {
  NeighbourhoodTransfer& grid = state.grid;
  const std::size_t row = grid.indirect.size() / grid.points();
  tbb::parallel_for(std::size_t(0), row, [&](std::size_t n) {
    std::vector<float> values(grid.points());
    for (std::size_t p = 0; p < values.size(); ++p) values[p] = grid.indirect[p * row + n];
    for (std::size_t p = 0; p < values.size(); ++p) {
      const glm::ivec3 at = grid.pointAt(p);
      for (int axis = 0; axis < 3; ++axis) {
        if (at[axis] == 0 || at[axis] == grid.size[axis] - 1) continue;
        glm::ivec3 step(0);
        step[axis] = 1;
        const std::size_t before = grid.numberOf(at - step), after = grid.numberOf(at + step);
        if (state.inside[before] || state.inside[p] || state.inside[after]) continue;
        grid.indirect[p * row + n] -= (values[before] - 2.0f * values[p] + values[after]) / 12.0f;
      }
    }
  });
}

}  // namespace gloam::prt
