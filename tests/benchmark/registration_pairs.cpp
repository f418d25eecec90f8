// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
// Aligns pairs of a rawlog's scans without initial guess and compares with the true poses: recall
// and false accepts against overlap. Detection is done once a scan, before, and is not timed.
// Poses are interpolated; where the truth begins late, `--set association.max_time_difference=0.02`
// takes the nearest one (what the TUM benchmark's own scripts do).
// Beside it, what dense ICP makes of the pair when it is started at the true pose: what the
// sensor's distortion and the truth's own error leave for anyone. With --other: pairs of scans of
// two places that have nothing in common; each pose that is accepted is wrong.
#include "opp/mapping/pipeline/feature_stream.h"
#include "opp/mapping/registration/align_globally.h"
#include "opp/mapping/registration/corner_icp.h"

#include "common/flags.h"
#include "common/run_main.h"
#include "posed_frames.h"
#include "registration/voxel_index.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <ctime>
#include <fstream>
#include <iomanip>
#include <iostream>

namespace {

using namespace opp;
using namespace opp::mapping;

struct Params {
  PrimitiveParams primitives;
  GlobalAlignmentParams alignment;
  AssociationParams association;
  CornerIcpParams icp;

  template <typename Self, typename F>
  static void visitSections(Self&& p, F&& f) {
    PrimitiveParams::visitSections(p.primitives, f);
    f(p.alignment);
    f(p.association);
    f(p.icp);
  }
};

using Frame = PosedFrame;

struct PairResult {
  std::size_t target = 0, source = 0;
  double overlap = 0.0;  ///< of the true pose
  bool six_dof = false;  ///< true planes of three independent normals are shared
  bool more = false;     ///< and at the true pose enough beyond three surfaces to confirm it
  GlobalAlignment alignment;
  double angle = 0.0;         ///< error [rad]
  double distance = 0.0;      ///< error [m]
  double milliseconds = 0.0;  ///< CPU time
  double doubt = 0.0;         ///< squared error over covariance; 6 on average if both are right
  bool icp_good = false;      ///< dense ICP that starts at the true pose ends near it

  bool accepted() const { return alignment.outcome == AlignmentOutcome::kAligned; }
  bool good() const { return accepted() && near(angle, distance); }
  static bool near(double angle, double distance) {
    return angle <= degToRad(1.0) && distance <= 0.03;
  }
  bool wrong() const { return accepted() && (angle > degToRad(5.0) || distance > 0.10); }
};

/// Share of the smaller scan's samples that have one of the other scan in reach that faces the same
/// way, and whether planes with three independent normals are among what they share.
void judgeTruth(const Frame& target, const Frame& source, PairResult& result) {
  const OrientedCloud& t = target.features.cloud_in_body;
  const OrientedCloud& s = source.features.cloud_in_body;
  const VoxelIndex index(t, 2.0 * t.spacing);
  const Eigen::Isometry3f pose =
      (target.map_from_body.inverse() * source.map_from_body).cast<float>();
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  const std::vector<int>& target_labels = target.features.primitives_in_body.labels;
  const std::vector<int>& source_labels = source.features.primitives_in_body.labels;
  std::map<std::pair<int, int>, int> shared;
  double matched = 0.0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const std::int32_t k = index.near(pose * s.points[i], pose.linear() * s.normals[i], 0.7F);
    if (k < 0) continue;
    matched += 1.0;
    const int p = target_labels[static_cast<std::size_t>(k)], q = source_labels[i];
    if (p >= 0 && q >= 0) ++shared[{p, q}];
  }
  result.overlap = matched / static_cast<double>(std::min(s.size(), t.size()));
  for (const auto& [planes, count] : shared) {
    const Eigen::Vector3d n =
        target.features.primitives_in_body.planes[static_cast<std::size_t>(planes.first)]
            .plane.normal();
    if (count >= 30) normals += n * n.transpose();
  }
  // Normals 30° off the plane of the others count as independent: sin² 30° = 0.25.
  result.six_dof = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(normals).eigenvalues()[0] > 0.25;
}

PairResult alignPair(const std::vector<Frame>& frames, std::size_t target, std::size_t source,
                     const Params& params) {
  PairResult result;
  result.target = target;
  result.source = source;
  judgeTruth(frames[target], frames[source], result);
  const std::clock_t start = std::clock();
  result.alignment = alignGlobally(frames[target].features, frames[source].features,
                                   params.primitives.sensor, params.alignment);
  result.milliseconds = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const Eigen::Isometry3d truth =
      frames[target].map_from_body.inverse() * frames[source].map_from_body;
  result.more = judgePose(frames[target].features, frames[source].features, truth,
                          params.primitives.sensor, params.alignment)
                    .confirmation >= params.alignment.min_confirmation;
  const CornerIcpResult icp =
      cornerIcp(frames[target].features.cloud_in_body, frames[source].features.cloud_in_body, {},
                truth, params.icp);
  const Vector6d icp_error = difference(truth, icp.target_from_source);
  result.icp_good = PairResult::near(icp_error.head<3>().norm(), icp_error.tail<3>().norm());
  // For pairs that are not accepted: the error of the best hypothesis, to see what is missing.
  if (result.alignment.hypotheses.empty()) return result;
  const Vector6d error = difference(truth, result.alignment.hypotheses.front().target_from_source);
  result.angle = error.head<3>().norm();
  result.distance = error.tail<3>().norm();
  if (result.accepted()) result.doubt = error.dot(result.alignment.covariance.ldlt().solve(error));
  return result;
}

/// Position of the frame with that index in the rawlog.
std::size_t positionOf(std::size_t index, const std::vector<Frame>& frames) {
  const auto found = std::find_if(frames.begin(), frames.end(), [index](const Frame& f) {
    return f.features.scan_index == index;
  });
  if (found == frames.end()) {
    throw std::runtime_error("no frame " + std::to_string(index) +
                             " with a true pose within association.max_time_difference");
  }
  return static_cast<std::size_t>(found - frames.begin());
}

std::vector<std::array<std::size_t, 2>> pairsOf(const std::string& file,
                                                const std::vector<Frame>& frames) {
  std::vector<std::array<std::size_t, 2>> pairs;
  if (file.empty()) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      for (std::size_t j = i + 1; j < frames.size(); ++j) pairs.push_back({i, j});
    }
    return pairs;
  }
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file);
  std::size_t i = 0, j = 0;
  double overlap = 0.0;
  while (stream >> i >> j >> overlap) {
    pairs.push_back({positionOf(i, frames), positionOf(j, frames)});
  }
  return pairs;
}

void writeCsv(const std::string& file, const std::vector<Frame>& frames,
              const std::vector<PairResult>& results) {
  std::ofstream csv(file);
  csv << "target,source,overlap,six_dof,more,outcome,dof,angle_deg,distance_m,score,conflict,"
         "clarity,confirmation,corners,doubt,icp_good,ms\n";
  for (const PairResult& r : results) {
    const GlobalAlignment& a = r.alignment;
    csv << frames[r.target].features.scan_index << ',' << frames[r.source].features.scan_index
        << ',' << r.overlap << ',' << r.six_dof << ',' << r.more << ','
        << static_cast<int>(a.outcome) << ',' << a.observed_dof << ',' << radToDeg(r.angle) << ','
        << r.distance << ',' << (a.hypotheses.empty() ? 0.0 : a.hypotheses[0].score) << ','
        << (a.hypotheses.empty() ? 0.0 : a.hypotheses[0].conflict) << ',' << a.clarity << ','
        << a.confirmation << ',' << a.corner_matches.size() << ',' << r.doubt << ',' << r.icp_good
        << ',' << r.milliseconds << '\n';
  }
}

template <typename Filter>
void printRow(const std::string& name, const std::vector<PairResult>& results, Filter filter) {
  int count = 0, good = 0, accepted = 0, wrong = 0, icp_good = 0;
  std::array<int, 5> outcomes{};
  std::vector<double> times, doubts;
  for (const PairResult& r : results) {
    if (!filter(r)) continue;
    ++count;
    good += r.good();
    icp_good += r.icp_good;
    accepted += r.accepted();
    wrong += r.wrong();
    ++outcomes[static_cast<std::size_t>(r.alignment.outcome)];
    times.push_back(r.milliseconds);
    if (r.accepted()) doubts.push_back(r.doubt);
  }
  if (count == 0) return;
  std::sort(times.begin(), times.end());
  std::sort(doubts.begin(), doubts.end());
  std::cout << std::setw(22) << name << std::setw(7) << count << std::setw(7) << good
            << std::setw(8) << std::fixed << std::setprecision(1) << 100.0 * good / count
            << std::setw(6) << icp_good << std::setw(9) << accepted << std::setw(7) << wrong
            << std::setw(10) << outcomes[1] << std::setw(13) << outcomes[2] << std::setw(12)
            << outcomes[4] << std::setw(11) << outcomes[3] << std::setw(8)
            << times[times.size() / 2] << std::setw(8) << times.back() << std::setw(8)
            << (doubts.empty() ? 0.0 : doubts[doubts.size() / 2]) << '\n';
}

void printTable(const std::vector<PairResult>& results) {
  std::cout << "               overlap  pairs   good  recall   icp accepted  wrong ambiguous "
               "insufficient "
               "unconfirmed no-overlap  ms p50  ms max   doubt\n";
  for (const double low : {0.0, 0.3, 0.5, 0.7}) {
    const double high = low < 0.3 ? 0.3 : low < 0.5 ? 0.5 : low < 0.7 ? 0.7 : 2.0;
    std::ostringstream name;
    name << low << " - " << std::min(high, 1.0);
    printRow(name.str(), results,
             [&](const PairResult& r) { return r.overlap >= low && r.overlap < high; });
  }
  printRow(">= 0.3", results, [](const PairResult& r) { return r.overlap >= 0.3; });
  printRow(">= 0.3 and 6 dof", results,
           [](const PairResult& r) { return r.overlap >= 0.3 && r.six_dof; });
  printRow("and no bare corner", results,
           [](const PairResult& r) { return r.overlap >= 0.3 && r.six_dof && r.more; });
}

/// Counts what is accepted of all pairs of two places.
void printStrangers(const std::vector<Frame>& frames, const std::string& rawlog, std::size_t every,
                    const Params& params) {
  RawlogOptions options;
  options.every = every;
  RawlogReader reader(rawlog, options);
  FeatureStream stream(reader, params.primitives, 0);
  std::array<int, 5> outcomes{};
  while (auto other = stream.next()) {
    for (const Frame& frame : frames) {
      const GlobalAlignment alignment = alignGlobally(frame.features, other->features,
                                                      params.primitives.sensor, params.alignment);
      ++outcomes[static_cast<std::size_t>(alignment.outcome)];
      if (alignment.outcome != AlignmentOutcome::kAligned) continue;
      std::cout << "accepted: " << frame.features.scan_index << " with "
                << other->features.scan_index << ", overlap " << alignment.overlap << ", clarity "
                << alignment.clarity << ", confirmation " << alignment.confirmation << '\n';
    }
  }
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    std::cout << std::setw(7) << outcomes[k] << "  " << describe(static_cast<AlignmentOutcome>(k))
              << '\n';
  }
}

void run(apps::CommandLine& line) {
  TCLAP::ValueArg<std::string> rawlog("i", "input", "Rawlog", true, "", "FILE.rawlog", line);
  TCLAP::ValueArg<std::string> gt("", "gt", "True poses", true, "", "FILE.tum", line);
  TCLAP::ValueArg<int> every("", "every", "Each K-th frame", false, 1, "K", line);
  TCLAP::ValueArg<std::string> pairs("", "pairs", "Pairs of frames; default: all", false, "",
                                     "FILE.txt", line);
  TCLAP::ValueArg<std::string> csv("", "csv", "One line a pair", false, "", "FILE.csv", line);
  TCLAP::ValueArg<std::string> other("", "other", "Each frame with each of another place", false,
                                     "", "FILE.rawlog", line);
  apps::ParameterFlags parameters(line);
  line.parse();
  Params params;
  parameters.applyTo(params);
  const auto frames =
      readPosedFrames(rawlog.getValue(), gt.getValue(), static_cast<std::size_t>(every.getValue()),
                      params.primitives, params.association);
  if (other.isSet()) {
    printStrangers(frames, other.getValue(), static_cast<std::size_t>(every.getValue()), params);
    return;
  }
  std::vector<PairResult> results;
  for (const auto& [i, j] : pairsOf(pairs.getValue(), frames)) {
    results.push_back(alignPair(frames, i, j, params));
  }
  if (csv.isSet()) writeCsv(csv.getValue(), frames, results);
  printTable(results);
}

}  // namespace

int main(int argc, char** argv) {
  return apps::runMain(argc, argv, "registration_pairs",
                       "Aligns pairs of scans and compares with the truth.", run);
}
