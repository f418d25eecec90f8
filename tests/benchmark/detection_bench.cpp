// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
// Time of each stage from a depth image or from samples to corners, on one thread. Every benchmark
// runs the whole chain; fromDepth and fromSamples report the stage that they are named after,
// recorded reports all stages of a scan of the shared data as counters [ms].
#include "opp/cloud/oriented_cloud.h"
#include "opp/detect_primitives.h"
#include "opp/mapping/io/cloud_file.h"
#include "opp/mapping/io/rawlog_reader.h"

#include "support/depth_image.h"
#include "support/random.h"
#include "support/shared_data.h"
#include "support/synthetic_room.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

namespace opp {
namespace {

using Stage = double StageTimings::*;

/// A Kinect's view of a corner of a room with a cupboard and a box, in about `pixels` pixels.
PointCloud depthImage(std::int64_t pixels) {
  const auto sides = [](const Eigen::Vector3d& low, const Eigen::Vector3d& high, double sign) {
    std::vector<Plane> planes;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d normal = sign * Eigen::Vector3d::Unit(axis);
      planes.push_back(Plane::fromPointNormal(low, normal));
      planes.push_back(Plane::fromPointNormal(high, -normal));
    }
    return planes;
  };
  const auto room = test::insideOf(sides({-1.0, -1.5, -1.2}, {3.2, 2.0, 1.4}, 1.0));
  const auto cupboard = test::outsideOf(sides({2.5, 0.4, -1.2}, {3.2, 1.4, 0.6}, -1.0));
  const auto box = test::outsideOf(sides({1.6, -0.9, -1.2}, {2.2, -0.3, -0.7}, -1.0));
  // Turned down and aside, so that no surface is parallel to the image.
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()))
                                   .toRotationMatrix();
  const auto nearest = [&](const Eigen::Vector3d& ray) {
    double range = room(turn * ray);
    for (const auto* object : {&cupboard, &box}) {
      const double hit = (*object)(turn * ray);
      if (hit > 0.0 && hit < range) range = hit;
    }
    return range;
  };
  const double scale = std::sqrt(static_cast<double>(pixels) / (640.0 * 480.0));
  test::Camera camera;
  camera.rows = static_cast<int>(std::round(camera.rows * scale));
  camera.cols = static_cast<int>(std::round(camera.cols * scale));
  camera.focal_length *= scale;
  PointCloud cloud = test::renderDepth(camera, nearest);
  test::Random random(1);
  test::addRangeNoise(cloud, SensorModel(), random);
  return cloud;
}

/// About `count` samples of a furnished room (12 to 15 planes) with 3 mm of noise.
OrientedCloud samples(std::int64_t count) {
  test::SyntheticOptions options;
  options.sigma = 0.003;
  options.normal_sigma = 0.1;
  options.spacing = std::sqrt(85.0 / static_cast<double>(count));  // 85 m² are visible
  return test::sampleScene(test::furnishedRoom(1), {0.0, 0.0, 1.5}, Eigen::Isometry3d::Identity(),
                           options)
      .cloud;
}

void report(benchmark::State& state, const Primitives& found) {
  state.counters["planes"] = static_cast<double>(found.planes.size());
  state.counters["lines"] = static_cast<double>(found.lines.size());
  state.counters["corners"] = static_cast<double>(found.corners.size());
}

void fromDepth(benchmark::State& state, Stage stage) {
  const PointCloud cloud = depthImage(state.range(0));
  const PrimitiveParams params;
  Primitives found;
  for (auto _ : state) {
    StageTimings timings;
    ScanSurface surface = makeScanSurface(cloud, params.sensor, params.sampling, &timings);
    found = detectPrimitives(cloud, surface, params, 1, &timings);
    state.SetIterationTime(timings.*stage);
  }
  report(state, found);
}

void fromSamples(benchmark::State& state, Stage stage) {
  const OrientedCloud cloud = samples(state.range(0));
  Primitives found;
  for (auto _ : state) {
    StageTimings timings;
    found = detectPrimitives(cloud, PrimitiveParams(), 1, &timings);
    state.SetIterationTime(timings.*stage);
  }
  report(state, found);
}

void wholeChain(benchmark::State& state) {
  const PointCloud cloud = depthImage(state.range(0));
  const PrimitiveParams params;
  Primitives found;
  for (auto _ : state) {
    ScanSurface surface = makeScanSurface(cloud, params.sensor, params.sampling);
    found = detectPrimitives(cloud, surface, params);
    benchmark::DoNotOptimize(found);
  }
  report(state, found);
}

/// The cloud of a file of the shared data; of a rawlog the first one.
PointCloud recordedCloud(const std::filesystem::path& path) {
  if (path.extension() != ".rawlog") return mapping::readCloudFile(path);
  auto scan = mapping::RawlogReader(path, {}).nextScan();
  return scan ? std::move(scan->cloud_in_body) : PointCloud();
}

void recorded(benchmark::State& state, const std::string& name) {
  const std::filesystem::path path = test::sharedData(name);
  if (!std::filesystem::exists(path)) return state.SkipWithError("the shared data are not there");
  const PointCloud cloud = recordedCloud(path);
  PrimitiveParams params;
  if (cloud.hasNormals()) params.sensor.min_range = 0.0;  // as opp-detect for clouds
  Primitives found;
  StageTimings sum, timings;
  const std::pair<const char*, Stage> stages[] = {
      {"normals", &StageTimings::normals},  {"sampling", &StageTimings::sampling},
      {"voting", &StageTimings::voting},    {"clustering", &StageTimings::clustering},
      {"narrow", &StageTimings::narrow},    {"refinement", &StageTimings::refinement},
      {"corners_", &StageTimings::corners}, {"lines_", &StageTimings::lines}};
  for (auto _ : state) {
    ScanSurface surface = makeScanSurface(cloud, params.sensor, params.sampling, &timings);
    found = detectPrimitives(cloud, surface, params, 1, &timings);
    for (const auto& stage : stages) sum.*stage.second += timings.*stage.second;
  }
  report(state, found);
  for (const auto& [label, stage] : stages) {
    state.counters[label] = 1e3 * sum.*stage / static_cast<double>(state.iterations());
  }
}

void imageSizes(benchmark::internal::Benchmark* bench) {
  for (const int pixels : {19200, 76800, 307200}) bench->Arg(pixels);
  bench->Unit(benchmark::kMillisecond);
}

void sampleCounts(benchmark::internal::Benchmark* bench) {
  for (const int count : {2000, 8000, 30000, 100000, 307000}) bench->Arg(count);
  bench->Unit(benchmark::kMillisecond)->UseManualTime();
}

BENCHMARK_CAPTURE(fromDepth, normals, &StageTimings::normals)->Apply(imageSizes)->UseManualTime();
BENCHMARK_CAPTURE(fromDepth, sampling, &StageTimings::sampling)->Apply(imageSizes)->UseManualTime();
BENCHMARK_CAPTURE(fromDepth, narrow, &StageTimings::narrow)->Apply(imageSizes)->UseManualTime();
BENCHMARK_CAPTURE(fromSamples, voting, &StageTimings::voting)->Apply(sampleCounts);
BENCHMARK_CAPTURE(fromSamples, clustering, &StageTimings::clustering)->Apply(sampleCounts);
BENCHMARK_CAPTURE(fromSamples, refinement, &StageTimings::refinement)->Apply(sampleCounts);
BENCHMARK_CAPTURE(fromSamples, lines, &StageTimings::lines)->Apply(sampleCounts);
BENCHMARK_CAPTURE(fromSamples, corners, &StageTimings::corners)->Apply(sampleCounts);
BENCHMARK(wholeChain)->Apply(imageSizes);
BENCHMARK_CAPTURE(recorded, icl_nuim, "fixtures/icl_nuim_frame.ply")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(recorded, icl, "icl_of_kt3.rawlog")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(recorded, tum, "tum_fr3_structure_notexture_far.rawlog")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(recorded, kinect, "fixtures/tests_rgbd.rawlog")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace opp

BENCHMARK_MAIN();
