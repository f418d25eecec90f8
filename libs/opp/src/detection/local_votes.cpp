// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detection/local_votes.h"

#include "opp/detection/pair_feature.h"

namespace opp {
namespace {

/// What a pair votes for.
enum Kind : std::int32_t { kInReach = 1, kCoplanar = 2, kOrthogonal = 4 };

/// Kinds (bits) of each partner's pair with the reference point of normal `n`; without branches, so
/// that the loop vectorizes.
void classify(const Partners& partners, const Eigen::Vector3f& n, const PairTest test,
              float squared_radius, std::int32_t* kinds) {
  const float *x = partners.x.data(), *y = partners.y.data(), *z = partners.z.data();
  const float *nx = partners.nx.data(), *ny = partners.ny.data(), *nz = partners.nz.data();
  const Eigen::Vector3f origin = Eigen::Vector3f::Zero(), normal = n;
  const Eigen::Index count = partners.size;
  for (Eigen::Index k = 0; k < count; ++k) {
    const PairFeature f = pairFeature(origin, normal, {x[k], y[k], z[k]}, {nx[k], ny[k], nz[k]});
    const std::int32_t in_reach =
        (f.squared_distance < squared_radius) & (f.squared_distance > 0.0F);
    kinds[k] = in_reach * (kInReach + kCoplanar * std::int32_t{test.coplanar(f)} +
                           kOrthogonal * std::int32_t{test.orthogonal(f)});
  }
}

/// θ of each partner.
void directionAngles(const Partners& partners, const Eigen::Matrix<float, 3, 2>& tangents,
                     float* thetas) {
  const float *nx = partners.nx.data(), *ny = partners.ny.data(), *nz = partners.nz.data();
  const Eigen::Vector3f t1 = tangents.col(0), t2 = tangents.col(1);
  const Eigen::Index count = partners.size;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Vector3f normal(nx[k], ny[k], nz[k]);
    thetas[k] = directionAngle({t1.dot(normal), t2.dot(normal)});
  }
}

}  // namespace

LocalVotes::LocalVotes(const VotingScene& scene)
    : partners(scene.params.partners),
      coplanar(scene.params.partners),
      table(scene.params.theta_bins, scene.params.rho_bins, scene.radius),
      scene_(scene),
      kinds_(static_cast<std::size_t>(scene.params.partners)),
      thetas_(static_cast<std::size_t>(scene.params.partners)),
      chosen_(static_cast<std::size_t>(scene.params.partners)) {}

void LocalVotes::pairUp(std::uint32_t r) {
  drawPartners(scene_, r, cells_, partners);
  classify(partners, scene_.samples[r].normal, PairTest(scene_.params.normal_tolerance),
           static_cast<float>(scene_.radius * scene_.radius), kinds_.data());
  pairs = 0;
  std::size_t found = 0;
  coplanar.size = 0;
  for (Eigen::Index k = 0; k < partners.size; ++k) {
    const std::int32_t kind = kinds_[static_cast<std::size_t>(k)];
    pairs += static_cast<std::size_t>(kind & kInReach);
    // Without a branch, which would be taken at random.
    chosen_[found] = k;
    found += (kind & kCoplanar) != 0 ? 1 : 0;
  }
  for (std::size_t c = 0; c < found; ++c) coplanar.add(partners, chosen_[c]);
}

void LocalVotes::castOrthogonal(const Eigen::Matrix<float, 3, 2>& tangents) {
  directionAngles(partners, tangents, thetas_.data());
  table.clear();
  for (Eigen::Index k = 0; k < partners.size; ++k) {
    if ((kinds_[static_cast<std::size_t>(k)] & kOrthogonal) == 0) continue;
    const float rho = -(partners.nx[k] * partners.x[k] + partners.ny[k] * partners.y[k] +
                        partners.nz[k] * partners.z[k]);
    table.cast(thetas_[static_cast<std::size_t>(k)], rho, static_cast<std::uint32_t>(k));
  }
}

}  // namespace opp
