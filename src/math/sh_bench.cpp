// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "math/sh_bench.h"

#include <fmt/format.h>
#include <gloam/error.h>
#include <gloam/sh.h>

#include <algorithm>
#include <ctime>
#include <functional>

#include "math/sampling.h"
#include "math/sh_batch.h"
#include "math/sh_exp_errors.h"

namespace gloam::sh {
namespace {

constexpr std::size_t kItems = 512;
constexpr std::size_t kStride = planeStride(kItems);

/// Inputs and outputs of all routines.
struct Data {
  std::vector<float> x, y, z, f, g, out;
  std::vector<glm::mat3> matrices;
  std::vector<Sh> single_f, single_g, single_out;
  /// Sums of the logs of 1 to 40 spheres, by order - 3: planes, and one by one.
  std::array<std::vector<float>, 4> log_planes;
  std::array<std::vector<Sh>, 4> logs;
};

/// Pixels near one another have nearly the same number of spheres: so have neighbours here.
void makeLogs(Data& data, int order) {
  std::vector<Sh>& logs = data.logs[static_cast<std::size_t>(order - 3)];
  std::vector<float>& planes = data.log_planes[static_cast<std::size_t>(order - 3)];
  const LogBlockerTable table = makeLogBlockerTable(order, 64);
  const auto size = static_cast<std::size_t>(coefficientCount(order));
  for (const int blockers : {1, 4, 16, 40})
    for (const Arrangement arrangement : {Arrangement::kScattered, Arrangement::kBody})
      for (const auto& set : randomBlockers(arrangement, blockers, kItems / 8, 3))
        logs.push_back(sumOfLogs(table, set));
  planes.resize(kStride * size);
  for (std::size_t k = 0; k < kItems; ++k)
    for (std::size_t i = 0; i < size; ++i) planes[i * kStride + k] = logs[k].c[i];
}

Data makeData() {
  Data data;
  sampling::Rng random(1);
  data.f.resize(kStride * kMaxCoefficients);
  data.g = data.out = data.f;
  for (float& value : data.f) value = random.next() - 0.5f;
  for (float& value : data.g) value = random.next() - 0.5f;
  data.single_f.resize(kItems, Sh(kMaxOrder));
  for (std::size_t i = 0; i < kItems; ++i) {
    const glm::vec3 direction = sampling::uniformSphere(random.next2());
    data.x.push_back(direction.x);
    data.y.push_back(direction.y);
    data.z.push_back(direction.z);
    const glm::vec3 across = sampling::frame(sampling::uniformSphere(random.next2()))[0];
    const glm::vec3 third = glm::normalize(glm::cross(direction, across));
    data.matrices.emplace_back(direction, third, glm::cross(direction, third));
    for (float& value : data.single_f[i].c) value = random.next() - 0.5f;
  }
  data.single_g = data.single_out = data.single_f;
  for (int order = 3; order <= kMaxOrder; ++order) makeLogs(data, order);
  return data;
}

struct Routine {
  const char* name;
  std::function<void(Data&, int order)> run;  // over all items
  std::array<double, 4> bar_ns;               // orders 3 to 6
  const char* bar_source;
};

void eachSingle(Data& data, int order, const std::function<Sh(Data&, std::size_t)>& one) {
  for (std::size_t i = 0; i < kItems; ++i) {
    data.single_f[i].order = data.single_g[i].order = order;
    data.single_out[i] = one(data, i);
  }
}

/// Over one sum of logs after the other.
std::function<void(Data&, int)> eachLog(Sh (*one)(const Sh&)) {
  return [one](Data& d, int order) {
    const std::vector<Sh>& logs = d.logs[static_cast<std::size_t>(order - 3)];
    for (std::size_t i = 0; i < kItems; ++i) d.single_out[i] = one(logs[i]);
  };
}

std::vector<Routine> logRoutines() {
  return {
      {"exp HYB",
       [](Data& d, int order) {
         expHybridMany(order, kItems, d.log_planes[static_cast<std::size_t>(order - 3)], d.out, kStride);
       },
       {},
       ""},
      {"exp quadratic",
       [](Data& d, int order) {
         expQuadraticMany(order, kItems, d.log_planes[static_cast<std::size_t>(order - 3)], d.out, kStride);
       },
       {},
       ""},
      {"exp PS 4, one", eachLog([](const Sh& f) { return expSeries(f, 4); }), {}, ""},
      {"exp PS 9, one", eachLog([](const Sh& f) { return expSeries(f, 9); }), {}, ""},
      {"exp OL, one", eachLog(expLinear), {}, ""},
      {"exp HYB, one", eachLog(expHybrid), {}, ""},
      {"exp quad, one", eachLog(expQuadratic), {}, ""},
      {"log, one",
       eachLog([](const Sh& f) {
         Sh positive(f.order);  // 1 and a little: any function does
         positive[0] = 3.5449077f;
         for (int i = 1; i < f.size(); ++i) positive[i] = 0.05f * f[i];
         return logarithm(positive);
       }),
       {},
       ""},
  };
}

std::vector<Routine> routines() {
  const auto direction = [](const Data& d, std::size_t i) { return glm::vec3(d.x[i], d.y[i], d.z[i]); };
  return {
      {"evaluate",
       [](Data& d, int order) { evaluateMany(order, d.x, d.y, d.z, d.out, kStride); },
       {2.8, 2.3, 7.5, 10.8},
       "the faster of sphericart and DirectXMath, blocks of 512"},
      {"rotate",
       [](Data& d, int order) { rotateMany(order, d.matrices, d.f, d.out, kStride); },
       {14.1, 25.2, 39.4, 59.5},
       "DirectXMath, build and apply"},
      {"rotate apply",
       [](Data& d, int order) {
         rotateMany(makeRotation(order, d.matrices[0]), kItems, d.f, d.out, kStride);
       },
       {7.5, 18.0, 20.6, 28.5},
       "block-diagonal matrix by hand"},
      {"product",
       [](Data& d, int order) { productMany(order, kItems, d.f, d.g, d.out, kStride); },
       {23.0, 74.0, 200.0, 604.0},
       "DirectXMath"},
      {"evaluate, one",
       [direction](Data& d, int order) {
         eachSingle(d, order, [&](Data& e, std::size_t i) { return evaluate(order, direction(e, i)); });
       },
       {},
       ""},
      {"rotate, one",
       [](Data& d, int order) {
         eachSingle(d, order, [](Data& e, std::size_t i) { return rotate(e.matrices[i], e.single_f[i]); });
       },
       {},
       ""},
      {"product, one",
       [](Data& d, int order) {
         eachSingle(d, order, [](Data& e, std::size_t i) { return product(e.single_f[i], e.single_g[i]); });
       },
       {},
       ""},
  };
}

/// Nanoseconds of processor time an item, of one run of at least that long: what other programs take meanwhile does
/// not count.
double timeRun(const Routine& routine, Data& data, int order, double seconds) {
  const std::clock_t start = std::clock();
  double elapsed = 0.0;
  std::size_t calls = 0;
  do {
    for (int i = 0; i < 8; ++i, ++calls) routine.run(data, order);
    elapsed = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  } while (elapsed < seconds);
  return elapsed / static_cast<double>(calls * kItems) * 1e9;
}

}  // namespace

std::vector<BenchRow> bench(int runs, double seconds, const Progress& progress) {
  if (runs < 1 || !(seconds >= 0.0))
    throw Error("bench sh", "expected at least one run of at least 0 seconds");
  Data data = makeData();
  std::vector<BenchRow> rows;
  std::vector<Routine> all = routines();
  for (Routine& routine : logRoutines()) all.push_back(std::move(routine));
  for (const Routine& routine : all)
    for (int order = 3; order <= kMaxOrder; ++order) {
      progress.report(static_cast<double>(rows.size()) / static_cast<double>(4 * all.size()), routine.name);
      if (progress.stopRequested()) throw Interrupted("bench sh: stopped");
      std::vector<double> times;
      for (int i = 0; i <= runs; ++i) times.push_back(timeRun(routine, data, order, seconds));
      times.erase(times.begin());  // the first warms up
      std::sort(times.begin(), times.end());
      rows.push_back({routine.name, order, times[times.size() / 2], times.front(),
                      routine.bar_ns[static_cast<std::size_t>(order - 3)], routine.bar_source});
    }
  return rows;
}

std::string benchTable(const std::vector<BenchRow>& rows) {
  std::string text =
      fmt::format("{}, one thread, ns of processor time an item\n{:<14} {:>5} {:>9} {:>9} {:>9}  {}\n",
                  simdTarget(), "routine", "order", "median", "best", "bar", "bar from");
  for (const BenchRow& row : rows) {
    const std::string bar = row.bar_ns > 0.0 ? fmt::format("{:.1f}", row.bar_ns) : "-";
    text += fmt::format("{:<14} {:>5} {:>9.2f} {:>9.2f} {:>9}  {}\n", row.name, row.order, row.ns,
                        row.ns_best, bar, row.bar_source);
  }
  return text;
}

}  // namespace gloam::sh
