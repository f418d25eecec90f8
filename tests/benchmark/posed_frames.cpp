// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "posed_frames.h"

#include "opp/mapping/io/tum_trajectory.h"
#include "opp/mapping/pipeline/feature_stream.h"

#include <filesystem>

namespace opp::mapping {

std::vector<PosedFrame> readPosedFrames(const std::string& rawlog, const std::string& poses,
                                        std::size_t every, const PrimitiveParams& primitives,
                                        const AssociationParams& association) {
  const Trajectory truth = readTumTrajectory(std::filesystem::path(poses));
  RawlogOptions options;
  options.every = every;
  RawlogReader reader(rawlog, options);
  FeatureStream stream(reader, primitives, 0);
  std::vector<PosedFrame> frames;
  while (auto frame = stream.next()) {
    const auto pose = poseAt(truth, frame->features.timestamp, association);
    if (pose) frames.push_back({std::move(frame->features), *pose});
  }
  return frames;
}

}  // namespace opp::mapping
