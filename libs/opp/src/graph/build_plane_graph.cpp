// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/graph/build_plane_graph.h"

#include "opp/graph/union_find.h"

#include "detection/gather_hypotheses.h"
#include "graph/one_surface.h"
#include "graph/plane_support.h"
#include "graph/sample_assigner.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace opp {
namespace {

/// Part of a sample's error that its neighbours may share before planes are refined: assignment is
/// rough, and distortion bends surfaces. Refinement looks closer.
constexpr double kAlike = 0.25;

/// A plane under construction; stands for the hypotheses of one set.
struct Cluster {
  Plane plane;
  PointMoments moments;
  double votes = 0.0;
  double samples = 0.0;
  std::size_t hypothesis = 0;  ///< representative of the set
  Eigen::AlignedBox3f reach;   ///< where its samples can be
  double spacing = 0.0;        ///< of its samples [m]
};

struct Builder {
  const OrientedCloud& cloud;
  const OppHypotheses& hypotheses;
  const GraphParams& params;
  SampleAssigner assigner;
  UnionFind sets;
  std::vector<Cluster> clusters = {};
  std::vector<int> labels = {};  ///< cluster of each sample; −1: none
};

std::vector<std::size_t> descending(std::size_t count, const std::vector<double>& keys) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return keys[a] > keys[b]; });
  return order;
}

/// One cluster for each set of hypotheses of one plane.
void gatherClusters(Builder& builder) {
  const auto& planes = builder.hypotheses.planes;
  const GatheredHypotheses gathered = gatherHypotheses(planes, builder.params.merge_angle);
  std::vector<double> votes(planes.size());
  for (std::size_t h = 0; h < planes.size(); ++h) {
    builder.sets.join(gathered.leader_of[h], h);
    votes[gathered.leader_of[h]] += planes[h].votes;
  }
  for (std::size_t k = 0; k < gathered.leaders.size(); ++k) {
    const std::size_t leader = gathered.leaders[k];
    Cluster cluster;
    cluster.plane = planes[leader].plane;
    cluster.votes = votes[leader];
    cluster.hypothesis = leader;
    cluster.reach = gathered.boxes[k];
    builder.clusters.push_back(cluster);
  }
}

std::vector<SampleAssigner::LocalPlane> planesOf(const Builder& builder) {
  std::vector<SampleAssigner::LocalPlane> planes;
  for (const Cluster& cluster : builder.clusters) planes.push_back({cluster.plane, cluster.reach});
  return planes;
}

/// Gives the samples to the clusters, fits these, and drops clusters that no sample fixes; samples
/// of dropped clusters are left without one.
void assignAndFit(Builder& builder) {
  builder.labels = builder.assigner.assign(planesOf(builder));
  const auto moments = builder.assigner.moments(builder.labels, builder.clusters.size());
  std::vector<int> counts(builder.clusters.size());
  std::vector<double> extents(builder.clusters.size());
  for (std::size_t i = 0; i < builder.labels.size(); ++i) {
    if (builder.labels[i] < 0) continue;
    const auto c = static_cast<std::size_t>(builder.labels[i]);
    ++counts[c];
    extents[c] += builder.cloud.extent(i);
  }
  const double least = leastSupport(builder.cloud, builder.params).samples;
  std::vector<Cluster> kept;
  std::vector<int> kept_of(builder.clusters.size(), -1);
  const Eigen::Vector3d viewpoint = builder.cloud.viewpoint.cast<double>();
  for (std::size_t c = 0; c < builder.clusters.size(); ++c) {
    if (counts[c] < std::max(3.0, least)) continue;
    kept_of[c] = static_cast<int>(kept.size());
    kept.push_back(builder.clusters[c]);
    kept.back().moments = moments[c];
    kept.back().samples = counts[c];
    kept.back().spacing = extents[c] / counts[c];
    kept.back().plane = moments[c].fitPlane(viewpoint);
  }
  for (int& label : builder.labels) {
    if (label >= 0) label = kept_of[static_cast<std::size_t>(label)];
  }
  builder.clusters = std::move(kept);
}

/// Would the samples of both clusters still lie within the noise of their common plane? Tested for
/// each part, so that a large plane cannot swallow a small parallel one. Two copies of one plane
/// share its samples, each having the nearer ones: at worst these spread evenly over the gate, with
/// variance gate²/3. Parallel surfaces more than 2 gate / √3 apart always stay two. Side by side
/// even nearer ones do: the slanted plane through both fits either much worse than its own.
bool mergeable(const Builder& builder, const Cluster& a, const Cluster& b) {
  if (std::abs(a.plane.normal().dot(b.plane.normal())) < std::cos(builder.params.merge_angle)) {
    return false;
  }
  PointMoments both = a.moments;
  both.merge(b.moments);
  const Plane plane = both.fitPlane(builder.cloud.viewpoint.cast<double>());
  const auto fits = [&](const Cluster& part) {
    const double sigma = std::sqrt(part.samples / part.moments.weight());
    const double gate = builder.params.noise_gate * sigma + builder.params.flatness * part.spacing;
    return part.moments.squaredError(plane) < part.moments.weight() * gate * gate / 3.0;
  };
  return fits(a) && fits(b) &&
         isOneSurface(plane, {a.moments, a.plane}, {b.moments, b.plane}, kAlike);
}

/// Union of clusters that are one plane, strongest first.
void mergeClusters(Builder& builder) {
  std::vector<double> weights;
  for (const Cluster& cluster : builder.clusters) weights.push_back(cluster.moments.weight());
  std::vector<Cluster> merged;
  const Eigen::Vector3d viewpoint = builder.cloud.viewpoint.cast<double>();
  for (const std::size_t c : descending(builder.clusters.size(), weights)) {
    const Cluster& cluster = builder.clusters[c];
    const auto host = std::find_if(merged.begin(), merged.end(), [&](const Cluster& other) {
      return mergeable(builder, other, cluster);
    });
    if (host == merged.end()) {
      merged.push_back(cluster);
      continue;
    }
    builder.sets.join(host->hypothesis, cluster.hypothesis);
    host->moments.merge(cluster.moments);
    host->plane = host->moments.fitPlane(viewpoint);
    host->votes += cluster.votes;
    host->spacing = (host->samples * host->spacing + cluster.samples * cluster.spacing) /
                    (host->samples + cluster.samples);
    host->samples += cluster.samples;
    host->reach.extend(cluster.reach);
  }
  builder.clusters = std::move(merged);
}

std::vector<std::vector<int>> samplesOf(const Builder& builder) {
  std::vector<std::vector<int>> samples(builder.clusters.size());
  for (std::size_t i = 0; i < builder.labels.size(); ++i) {
    if (builder.labels[i] < 0) continue;
    samples[static_cast<std::size_t>(builder.labels[i])].push_back(static_cast<int>(i));
  }
  return samples;
}

/// Drops clusters without a connected patch, large and wide enough, of samples that no stronger
/// cluster explains: copies of a plane, and planes that cut through others (a slope along a stair).
/// The others are fitted to these samples, which frees a small plane that was drawn towards a large
/// one beside it.
void dropUnsupported(Builder& builder) {
  std::stable_sort(builder.clusters.begin(), builder.clusters.end(),
                   [](const Cluster& a, const Cluster& b) { return a.samples > b.samples; });
  builder.labels = builder.assigner.assignToFirst(planesOf(builder));
  const auto samples = samplesOf(builder);
  const auto moments = builder.assigner.moments(builder.labels, builder.clusters.size());
  const SupportPatch least = leastSupport(builder.cloud, builder.params);
  std::vector<Cluster> kept;
  for (std::size_t c = 0; c < builder.clusters.size(); ++c) {
    const SupportPatch patch = largestPatch(builder.cloud, builder.clusters[c].plane, samples[c]);
    if (patch.samples >= least.samples && patch.width >= least.width) {
      kept.push_back(builder.clusters[c]);
      kept.back().plane = moments[c].fitPlane(builder.cloud.viewpoint.cast<double>());
    }
  }
  builder.clusters = std::move(kept);
}

/// Orthogonal votes between clusters; 0 for pairs that no reference point voted for.
Eigen::MatrixXd edgeVotes(Builder& builder) {
  const auto count = static_cast<Eigen::Index>(builder.clusters.size());
  std::vector<Eigen::Index> node_of(builder.hypotheses.planes.size(), -1);
  for (std::size_t c = 0; c < builder.clusters.size(); ++c) {
    node_of[builder.sets.root(builder.clusters[c].hypothesis)] = static_cast<Eigen::Index>(c);
  }
  Eigen::MatrixXd votes = Eigen::MatrixXd::Zero(count, count);
  for (const OrthogonalPair& pair : builder.hypotheses.pairs) {
    const Eigen::Index a = node_of[builder.sets.root(static_cast<std::size_t>(pair.reference))];
    const Eigen::Index b = node_of[builder.sets.root(static_cast<std::size_t>(pair.partner))];
    if (a >= 0 && b >= 0 && a != b) votes(std::min(a, b), std::max(a, b)) += pair.votes;
  }
  return votes;
}

/// Edges of all pairs that are orthogonal and meet where there are samples. Votes are counted, not
/// required: between two small planes there may be no reference point.
std::vector<OrthogonalityEdge> findEdges(Builder& builder, const MeetingRule& rule) {
  const auto samples = samplesOf(builder);
  const Eigen::MatrixXd votes = edgeVotes(builder);
  std::vector<OrthogonalityEdge> edges;
  for (std::size_t a = 0; a < builder.clusters.size(); ++a) {
    for (std::size_t b = a + 1; b < builder.clusters.size(); ++b) {
      const Cluster &cluster_a = builder.clusters[a], &cluster_b = builder.clusters[b];
      if (!meet(builder.cloud, {cluster_a.plane, samples[a], cluster_a.spacing},
                {cluster_b.plane, samples[b], cluster_b.spacing}, rule)) {
        continue;
      }
      edges.push_back({{static_cast<int>(a), static_cast<int>(b)},
                       votes(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b))});
    }
  }
  return edges;
}

}  // namespace

PlaneGraph buildPlaneGraph(const OrientedCloud& cloud, const OppHypotheses& hypotheses,
                           const SensorModel& sensor, const GraphParams& params) {
  validate(params);
  if (hypotheses.planes.empty()) return {};
  Builder builder{cloud, hypotheses, params, SampleAssigner(cloud, sensor, params),
                  UnionFind(hypotheses.planes.size())};
  gatherClusters(builder);
  for (int round = 0; round < params.rounds; ++round) {
    assignAndFit(builder);
    mergeClusters(builder);
  }
  assignAndFit(builder);
  dropUnsupported(builder);
  assignAndFit(builder);  // the samples of dropped planes may support others
  PlaneGraph graph;
  for (const Cluster& cluster : builder.clusters) {
    graph.nodes.push_back(
        {cluster.plane, cluster.moments, cluster.votes, cluster.reach, cluster.spacing});
  }
  graph.meeting = {params.orthogonality, params.edge_reach, params.min_edge_length};
  graph.edges = findEdges(builder, graph.meeting);
  return graph;
}

}  // namespace opp
