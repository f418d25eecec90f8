// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/geometry/constants.h"
#include "opp/primitives/find_corners.h"
#include "opp/primitives/find_lines.h"
#include "opp/refinement/refine_planes.h"

#include "support/random.h"
#include "support/rough_graph.h"
#include "support/synthetic_room.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace opp {
namespace {

/// A furnished room (12 to 15 planes) of about `samples` samples with 3 mm of noise.
test::SyntheticScene furnished(std::int64_t samples) {
  test::SyntheticOptions options;
  options.sigma = 0.003;
  options.normal_sigma = 0.1;
  options.spacing = std::sqrt(85.0 / static_cast<double>(samples));  // 85 m² are visible
  return test::sampleScene(test::furnishedRoom(1), {0.0, 0.0, 1.5}, Eigen::Isometry3d::Identity(),
                           options);
}

void refine(benchmark::State& state) {
  const test::SyntheticScene scene = furnished(state.range(0));
  test::Random random(1);
  const PlaneGraph rough = test::roughGraph(scene, degToRad(2.0), 0.02, random);
  Primitives result;
  for (auto _ : state) {
    result = refinePlanes(scene.cloud, rough, SensorModel(), RefinementParams());
    benchmark::DoNotOptimize(result);
  }
  state.counters["samples"] = static_cast<double>(scene.cloud.size());
  state.counters["planes"] = static_cast<double>(result.planes.size());
}
BENCHMARK(refine)->Arg(2000)->Arg(8000)->Arg(30000)->Arg(100000)->Arg(307000)->Unit(
    benchmark::kMillisecond);

void linesAndCorners(benchmark::State& state) {
  const test::SyntheticScene scene = furnished(state.range(0));
  test::Random random(1);
  Primitives result =
      refinePlanes(scene.cloud, test::roughGraph(scene, degToRad(2.0), 0.02, random), SensorModel(),
                   RefinementParams());
  for (auto _ : state) {
    result.corners = findCorners(scene.cloud, result, CornerParams());
    result.lines = findLines(scene.cloud, result, LineParams());
    benchmark::DoNotOptimize(result);
  }
  state.counters["lines"] = static_cast<double>(result.lines.size());
  state.counters["corners"] = static_cast<double>(result.corners.size());
}
BENCHMARK(linesAndCorners)
    ->Arg(2000)
    ->Arg(8000)
    ->Arg(30000)
    ->Arg(100000)
    ->Arg(307000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace opp

BENCHMARK_MAIN();
