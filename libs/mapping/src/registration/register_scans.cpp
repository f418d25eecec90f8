// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/register_scans.h"

#include "opp/mapping/registration/corner_icp.h"

namespace opp::mapping {
namespace {

class Registrar {
 public:
  Registrar(const AlignmentInput& target, const AlignmentInput& source, const SensorModel& sensor,
            const GlobalAlignmentParams& alignment, const CornerIcpParams& icp)
      : target_(target), source_(source), sensor_(sensor), alignment_(alignment), icp_(icp) {}

  Registration byIcp(const Eigen::Isometry3d& initial) const {
    return answer(judged(icp({}, initial).target_from_source), RegistrationMode::kIcp, 6);
  }

  /// Plain ICP reaches farther, refinement with planes is more exact.
  Registration nearGuess(const Eigen::Isometry3d& initial) const {
    const Eigen::Isometry3d start = icp({}, initial).target_from_source;
    return answer(alignNear(target_, source_, start, sensor_, alignment_), RegistrationMode::kIcp,
                  6);
  }

  Registration withoutGuess() const {
    return answer(alignGlobally(target_, source_, sensor_, alignment_), RegistrationMode::kCorners,
                  6);
  }

  Registration byCorners(const std::optional<Eigen::Isometry3d>& initial) const {
    const Registration start = initial ? nearGuess(*initial) : withoutGuess();
    if (!start.success) return withMode(start, RegistrationMode::kCorners);
    const CornerIcpResult constrained =
        icp(positionsOf(start.corner_matches), start.target_from_source);
    return answer(judged(constrained.target_from_source), RegistrationMode::kCorners,
                  constrained.dof);
  }

 private:
  CornerIcpResult icp(const std::vector<CornerPair>& corners,
                      const Eigen::Isometry3d& initial) const {
    return cornerIcp(target_.features->cloud_in_body, source_.features->cloud_in_body, corners,
                     initial, icp_);
  }

  GlobalAlignment judged(const Eigen::Isometry3d& pose) const {
    return judgePose(target_, source_, pose, sensor_, alignment_);
  }

  std::vector<CornerPair> positionsOf(const std::vector<CornerMatch>& matches) const {
    std::vector<CornerPair> pairs;
    for (const CornerMatch& m : matches) {
      pairs.push_back(
          {target_.features->primitives_in_body.corners[static_cast<std::size_t>(m.target_corner)]
               .position,
           source_.features->primitives_in_body.corners[static_cast<std::size_t>(m.source_corner)]
               .position});
    }
    return pairs;
  }

  Registration answer(const GlobalAlignment& found, RegistrationMode mode, int dof) const {
    Registration result;
    result.success = found.outcome == AlignmentOutcome::kAligned;
    if (!result.success) result.reason = reasonOf(found.outcome);
    result.mode_used = mode;
    result.target_from_source = found.target_from_source;
    result.covariance = found.covariance;
    result.dof = dof;
    result.overlap = found.overlap;
    result.rms = found.rms;
    result.corner_matches = found.corner_matches;
    return result;
  }

  std::string reasonOf(AlignmentOutcome outcome) const {
    if (target_.features->cloud_in_body.size() == 0) return "the target holds no surface";
    if (source_.features->cloud_in_body.size() == 0) return "the source holds no surface";
    return std::string(describe(outcome));
  }

  static Registration withMode(Registration result, RegistrationMode mode) {
    result.mode_used = mode;
    return result;
  }

  const AlignmentInput& target_;
  const AlignmentInput& source_;
  const SensorModel& sensor_;
  const GlobalAlignmentParams& alignment_;
  const CornerIcpParams& icp_;
};

}  // namespace

Registration registerScans(const AlignmentInput& target, const AlignmentInput& source,
                           const std::optional<Eigen::Isometry3d>& initial_target_from_source,
                           RegistrationMode mode, const SensorModel& sensor,
                           const GlobalAlignmentParams& alignment, const CornerIcpParams& icp) {
  const Registrar registrar(target, source, sensor, alignment, icp);
  const auto& initial = initial_target_from_source;
  if (mode == RegistrationMode::kIcp) {
    return registrar.byIcp(initial.value_or(Eigen::Isometry3d::Identity()));
  }
  if (mode == RegistrationMode::kCorners) return registrar.byCorners(initial);
  if (initial) {
    Registration near = registrar.nearGuess(*initial);
    if (near.success) return near;
  }
  return registrar.withoutGuess();
}

}  // namespace opp::mapping
