// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detection/fit_voters.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace opp {
namespace {

/// Of the moments, which are summed in single precision.
constexpr double kRounding = 1e-5;

}  // namespace

Eigen::Vector3d meanNormal(const Partners& voters, const Eigen::Vector3d& start) {
  Eigen::Vector3f sum = start.cast<float>();
  const Eigen::Vector3f side = sum;
  for (Eigen::Index k = 0; k < voters.size; ++k) {
    const Eigen::Vector3f normal(voters.nx[k], voters.ny[k], voters.nz[k]);
    sum += std::copysign(1.0F, normal.dot(side)) * normal;
  }
  return sum.cast<double>().normalized();
}

double densestHeight(const Partners& voters, const Eigen::Vector3d& normal) {
  const Eigen::Vector3f n = normal.cast<float>();
  const auto heightOf = [&](Eigen::Index k) {
    return n.x() * voters.x[k] + n.y() * voters.y[k] + n.z() * voters.z[k];
  };
  float lowest = heightOf(0);
  for (Eigen::Index k = 1; k < voters.size; ++k) lowest = std::min(lowest, heightOf(k));
  // Bins as wide as a gate; heights beyond the last fall into it, and a peak is not that deep.
  constexpr int kBins = 128;
  const float bins_per_metre =
      static_cast<float>(voters.size) / voters.gate.head(voters.size).sum();
  std::array<float, kBins + 1> counts{}, sums{};
  for (Eigen::Index k = 0; k < voters.size; ++k) {
    const float height = heightOf(k);
    const float bin = std::min((height - lowest) * bins_per_metre, static_cast<float>(kBins - 1));
    counts[static_cast<std::size_t>(bin)] += 1.0F;
    sums[static_cast<std::size_t>(bin)] += height;
  }
  std::size_t best = 0;
  for (std::size_t bin = 1; bin < kBins; ++bin) {
    if (counts[bin] + counts[bin + 1] > counts[best] + counts[best + 1]) best = bin;
  }
  return static_cast<double>((sums[best] + sums[best + 1]) / (counts[best] + counts[best + 1]));
}

VoterFitter::VoterFitter(Eigen::Index capacity)
    : u_(capacity), v_(capacity), h_(capacity), weight_(capacity) {}

int VoterFitter::weigh(const Partners& voters, const VotersFit& fit,
                       const Eigen::Matrix<double, 3, 2>& tangents, double widening) {
  const Eigen::Vector3f t1 = tangents.col(0).cast<float>(), t2 = tangents.col(1).cast<float>();
  const Eigen::Vector3f n = fit.plane.normal().cast<float>(), origin = fit.mean.cast<float>();
  const auto limit = static_cast<float>(widening);
  const float *x = voters.x.data(), *y = voters.y.data(), *z = voters.z.data();
  const float* gate = voters.gate.data();
  float *u = u_.data(), *v = v_.data(), *h = h_.data(), *weight = weight_.data();
  const Eigen::Index count = voters.size;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Vector3f step = Eigen::Vector3f(x[k], y[k], z[k]) - origin;
    u[k] = t1.dot(step);
    v[k] = t2.dot(step);
    h[k] = n.dot(step);
    // 1 or 0 by the sign bit: with a condition the loop does not vectorize.
    const float within = 0.5F + std::copysign(0.5F, limit * gate[k] - std::abs(h[k]));
    weight[k] = within / (gate[k] * gate[k]);
  }
  int votes = 0;
  for (Eigen::Index k = 0; k < count; ++k) votes += weight[k] > 0.0F ? 1 : 0;
  return votes;
}

std::optional<VotersFit> VoterFitter::fit(const Partners& voters, const Eigen::Vector3d& origin,
                                          const Eigen::Vector3d& normal, int min_votes) {
  VotersFit fit{Plane::fromPointNormal(origin, normal), origin, 0};
  // The first plane's normal is only as good as the normals, so its gate is wider.
  for (const double widening : {2.0, 1.0}) {
    const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(fit.plane.normal());
    fit.votes = weigh(voters, fit, tangents, widening);
    if (fit.votes < std::max(1, min_votes)) return std::nullopt;
    const auto u = u_.head(voters.size).matrix(), v = v_.head(voters.size).matrix(),
               h = h_.head(voters.size).matrix(), w = weight_.head(voters.size).matrix();
    const auto sum = [&](const auto& a, const auto& b) {
      return static_cast<double>((w.array() * a.array() * b.array()).sum());
    };
    const auto weight = static_cast<double>(w.sum());
    const Eigen::Vector3d mean =
        Eigen::Vector3f(w.dot(u), w.dot(v), w.dot(h)).cast<double>() / weight;
    const double square_u = sum(u, u), square_v = sum(v, v);
    // One vote's normal fixes the slope where the points do not (collinear ones): 1 rad per gate².
    const double prior = 1.0 + kRounding * (square_u + square_v);
    const double uu = square_u - weight * mean[0] * mean[0] + prior;
    const double vv = square_v - weight * mean[1] * mean[1] + prior;
    const double uv = sum(u, v) - weight * mean[0] * mean[1];
    const double uh = sum(u, h) - weight * mean[0] * mean[2];
    const double vh = sum(v, h) - weight * mean[1] * mean[2];
    const double determinant = uu * vv - uv * uv;
    const Eigen::Vector2d slope((vv * uh - uv * vh) / determinant,
                                (uu * vh - uv * uh) / determinant);
    const Eigen::Vector3d n = fit.plane.normal();
    fit.mean += tangents * mean.head<2>() + mean[2] * n;
    fit.plane = Plane::fromPointNormal(fit.mean, n - tangents * slope);
  }
  return fit;
}

}  // namespace opp
