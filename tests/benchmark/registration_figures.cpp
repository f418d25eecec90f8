// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
// Figures for Sommer et al. 2020, Fig. 5, 7 and 9, as CSV on stdout;
// tests/benchmark/plot_registration runs it on several sequences and plots.
//   icp:    error, time and steps of ICP against down-sampling, of pairs of scans `--apart` frames
//           apart that share a corner, started at "no motion", with 6 free parameters and as few as
//           their corners allow (3, 1, 0)
//   corner: error of the pose that one pair of corners with its frames gives by itself, of all
//   pairs
#include "opp/geometry/constants.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/registration/corner_icp.h"

#include "common/flags.h"
#include "common/run_main.h"
#include "posed_frames.h"
#include "registration/pose_candidates.h"
#include "registration/pose_judge.h"

#include <ctime>
#include <iostream>
#include <numeric>
#include <set>
#include <utility>

namespace {

using namespace opp;
using namespace opp::mapping;

const std::array<std::size_t, 9> kFactors = {1, 2, 5, 10, 20, 50, 100, 200, 500};

struct Params {
  MapperParams mapper;
  AssociationParams association;

  template <typename Self, typename F>
  static void visitSections(Self&& p, F&& f) {
    MapperParams::visitSections(p.mapper, f);
    f(p.association);
  }
};

/// Every `factor`-th sample, spread over all by steps of the golden section.
OrientedCloud thinned(const OrientedCloud& cloud, std::size_t factor) {
  OrientedCloud result;
  result.viewpoint = cloud.viewpoint;
  result.spacing = cloud.spacing * std::sqrt(static_cast<double>(factor));
  const std::size_t count = cloud.size();
  auto step = std::max<std::size_t>(1, static_cast<std::size_t>(0.618 * double(count)));
  while (std::gcd(step, count) != 1) ++step;
  for (std::size_t k = 0; k < count / factor; ++k) {
    const std::size_t i = k * step % count;
    result.points.push_back(cloud.points[i]);
    result.normals.push_back(cloud.normals[i]);
    result.sigmas.push_back(cloud.sigmas[i]);
    result.weights.push_back(cloud.weights[i]);
  }
  return result;
}

void printError(const Eigen::Isometry3d& truth, const Eigen::Isometry3d& estimate) {
  const Vector6d error = difference(truth, estimate);
  std::cout << radToDeg(error.head<3>().norm()) << ',' << error.tail<3>().norm();
}

/// The corners that global alignment found in both scans, most certain first.
std::vector<CornerPair> commonCorners(const ScanFeatures& target, const ScanFeatures& source,
                                      const MapperParams& params) {
  const GlobalAlignment found =
      alignGlobally(target, source, params.primitives.sensor, params.global_alignment);
  if (found.outcome != AlignmentOutcome::kAligned) return {};
  std::vector<std::pair<double, CornerPair>> ranked;
  for (const CornerMatch& m : found.corner_matches) {
    const Corner& t = target.primitives_in_body.corners[std::size_t(m.target_corner)];
    const Corner& s = source.primitives_in_body.corners[std::size_t(m.source_corner)];
    ranked.push_back({t.covariance.trace() + s.covariance.trace(), {t.position, s.position}});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<CornerPair> corners;
  for (const auto& entry : ranked) corners.push_back(entry.second);
  return corners;
}

void printIcp(const std::vector<PosedFrame>& frames, const std::vector<PosedFrame>& dense,
              std::size_t apart, const MapperParams& params) {
  std::cout << "target,source,dof,factor,angle_deg,distance_m,ms,steps\n";
  for (std::size_t i = 0; i + apart < frames.size(); ++i) {
    const std::size_t j = i + apart;
    const std::vector<CornerPair> corners =
        commonCorners(frames[i].features, frames[j].features, params);
    if (corners.empty()) continue;
    const Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
    const std::set<std::size_t> numbers = {0, 1, std::min<std::size_t>(2, corners.size()),
                                           corners.size()};
    const Eigen::Isometry3d truth = frames[i].map_from_body.inverse() * frames[j].map_from_body;
    for (const std::size_t factor : kFactors) {
      const OrientedCloud target = thinned(dense[i].features.cloud_in_body, factor);
      const OrientedCloud source = thinned(dense[j].features.cloud_in_body, factor);
      for (const std::size_t used : numbers) {
        const std::vector<CornerPair> some(corners.begin(), corners.begin() + std::ptrdiff_t(used));
        const std::clock_t begin = std::clock();
        const CornerIcpResult icp = cornerIcp(target, source, some, start, params.corner_icp);
        const double ms = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        std::cout << frames[i].features.scan_index << ',' << frames[j].features.scan_index << ','
                  << icp.dof << ',' << factor << ',';
        printError(truth, icp.target_from_source);
        std::cout << ',' << ms << ',' << icp.iterations << '\n';
      }
    }
  }
}

/// The 24 rotations that take the axes of a frame to axes.
std::vector<Eigen::Matrix3d> axisRotations() {
  std::vector<Eigen::Matrix3d> result;
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d r = Eigen::Matrix3d::Zero();
      for (int k = 0; k < 3; ++k) {
        r(order[std::size_t(k)], k) = (signs >> k) % 2 == 0 ? 1.0 : -1.0;
      }
      if (r.determinant() > 0.0) result.push_back(r);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return result;
}

/// Every pose that lays a corner of the source with its frame on one of the target, best first.
std::vector<Candidate> cornerPoses(const ScanModel& target, const ScanModel& source, double slack,
                                   const GlobalAlignmentParams& params) {
  static const std::vector<Eigen::Matrix3d> kTurns = axisRotations();
  std::vector<Candidate> result;
  for (const Corner& t : target.primitives().corners) {
    for (const Corner& s : source.primitives().corners) {
      for (const Eigen::Matrix3d& turn : kTurns) {
        const Eigen::Matrix3d r = t.cloud_from_corner * turn * s.cloud_from_corner.transpose();
        if (!compatibleCorners(target, t, source, s, r, params)) continue;
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() = r;
        pose.translation() = t.position - r * s.position;
        Candidate c;
        c.pose = informationAt(target, source, pose, params);
        c.verification = verifyPose(target, source, pose, slack, params);
        c.score = c.verification.score();
        result.push_back(std::move(c));
      }
    }
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  return result;
}

/// Several corners of one pair of scans give nearly the same pose; these are no rivals.
std::vector<Candidate> withoutTwins(const std::vector<Candidate>& all, double step,
                                    const GlobalAlignmentParams& params) {
  std::vector<Candidate> result;
  for (const Candidate& c : all) {
    const bool twin = std::any_of(result.begin(), result.end(), [&](const Candidate& other) {
      const Vector6d d = difference(c.pose.target_from_source, other.pose.target_from_source);
      return d.head<3>().norm() <= params.distinct_rotation && d.tail<3>().norm() < step;
    });
    if (!twin) result.push_back(c);
  }
  return result;
}

void printCorner(const std::vector<PosedFrame>& frames, const MapperParams& params) {
  std::vector<ScanModel> models;
  for (const PosedFrame& frame : frames) {
    models.emplace_back(frame.features, params.primitives.sensor, params.global_alignment);
  }
  std::cout << "target,source,overlap,corners,accepted,angle_deg,distance_m\n";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (std::size_t j = i + 1; j < frames.size(); ++j) {
      const Eigen::Isometry3d truth = frames[i].map_from_body.inverse() * frames[j].map_from_body;
      const PoseJudge judge(models[i], models[j], params.global_alignment);
      const double overlap = verifyPose(models[i], models[j], truth, 0.5 * models[i].voxels.cell(),
                                        params.global_alignment)
                                 .overlap();
      const std::vector<Candidate> candidates = withoutTwins(
          cornerPoses(models[i], models[j], judge.refinedSlack(), params.global_alignment),
          judge.distinctStep(), params.global_alignment);
      bool accepted = false;
      if (!candidates.empty()) {
        const GlobalAlignment answer = judge.judge(candidates);
        accepted = answer.outcome == AlignmentOutcome::kAligned &&
                   answer.confirmation >= params.global_alignment.min_confirmation;
      }
      std::cout << frames[i].features.scan_index << ',' << frames[j].features.scan_index << ','
                << overlap << ','
                << std::min(models[i].primitives().corners.size(),
                            models[j].primitives().corners.size())
                << ',' << accepted << ',';
      printError(truth, candidates.empty() ? Eigen::Isometry3d::Identity()
                                           : candidates.front().pose.target_from_source);
      std::cout << '\n';
    }
  }
}

void run(apps::CommandLine& line) {
  TCLAP::ValueArg<std::string> rawlog("i", "input", "Rawlog", true, "", "FILE.rawlog", line);
  TCLAP::ValueArg<std::string> gt("", "gt", "True poses", true, "", "FILE.tum", line);
  TCLAP::ValueArg<int> every("", "every", "Each K-th frame", false, 15, "K", line);
  TCLAP::ValueArg<int> apart("", "apart", "ICP: frames (of those kept) between a pair", false, 1,
                             "N", line);
  TCLAP::ValueArg<int> samples("", "samples", "ICP: samples of a dense scan", false, 60000, "N",
                               line);
  TCLAP::SwitchArg corner("", "corner", "Single corners instead of ICP", line);
  apps::ParameterFlags parameters(line);
  line.parse();
  Params params;
  parameters.applyTo(params);
  const auto read = [&](const PrimitiveParams& primitives) {
    return readPosedFrames(rawlog.getValue(), gt.getValue(), std::size_t(every.getValue()),
                           primitives, params.association);
  };
  const std::vector<PosedFrame> frames = read(params.mapper.primitives);
  if (corner.getValue()) {
    printCorner(frames, params.mapper);
    return;
  }
  PrimitiveParams dense = params.mapper.primitives;
  dense.sampling.target_samples = samples.getValue();
  dense.sampling.spacing_per_sigma = 0.0;
  printIcp(frames, read(dense), std::size_t(apart.getValue()), params.mapper);
}

}  // namespace

int main(int argc, char** argv) {
  return apps::runMain(argc, argv, "registration_figures",
                       "Prints what the figures on registration by corners are drawn from.", run);
}
