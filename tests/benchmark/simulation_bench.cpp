// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Time of one simulated frame on one thread, on average over the way through the apartment:
//     build/release/bin/simulation_bench
#include "opp/mapping/simulation/simulator.h"

#include <benchmark/benchmark.h>

namespace {

using namespace opp::mapping;

void frameOfTheApartment(benchmark::State& state, SimulatedSensor sensor) {
  SimulationOptions options;
  options.sensor = sensor;
  options.frames = 30;
  const Simulator simulator(loadScene("apartment"), options);
  int index = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(simulator.frame(index));
    index = (index + 1) % simulator.frames();
  }
}

BENCHMARK_CAPTURE(frameOfTheApartment, kinect_vga, SimulatedSensor::kKinect)
    ->Iterations(30)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frameOfTheApartment, ideal_vga, SimulatedSensor::kIdeal)
    ->Iterations(30)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frameOfTheApartment, lidar16, SimulatedSensor::kLidar16)
    ->Iterations(30)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frameOfTheApartment, lidar64, SimulatedSensor::kLidar64)
    ->Iterations(30)
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
