// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/furniture.h"

#include "opp/mapping/simulation/solids.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace opp::mapping {
namespace {

/// Adds boxes given by their lowest and highest corner in the furniture's frame.
class Joiner {
 public:
  Joiner(World& world, const Eigen::Isometry3d& map_from_furniture)
      : world_(world), map_from_furniture_(map_from_furniture) {}

  void box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    const Eigen::Vector3d base(0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), low.z());
    addBox(world_, map_from_furniture_ * Eigen::Translation3d(base), high - low);
  }

 private:
  World& world_;
  const Eigen::Isometry3d& map_from_furniture_;
};

/// Dimensions of parts [m], as furniture shops have them.
constexpr double kBoard = 0.03;
constexpr double kLeg = 0.06;
constexpr double kPlinth = 0.08;

void fourLegs(Joiner& joiner, double x, double y, double height) {
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      const Eigen::Vector3d low(sx > 0 ? x - kLeg : -x, sy > 0 ? y - kLeg : -y, 0.0);
      joiner.box(low, low + Eigen::Vector3d(kLeg, kLeg, height));
    }
  }
}

void table(Joiner& joiner, const Eigen::Vector3d& size) {
  const double x = 0.5 * size.x(), y = 0.5 * size.y();
  joiner.box({-x, -y, size.z() - kBoard}, {x, y, size.z()});
  fourLegs(joiner, x - 0.03, y - 0.03, size.z() - kBoard);
}

void chair(Joiner& joiner, const Eigen::Vector3d& size) {
  const double x = 0.5 * size.x(), y = 0.5 * size.y(), seat = 0.5 * size.z();
  joiner.box({-x, -y, seat - 0.04}, {x, y, seat});
  joiner.box({-x, -y, seat}, {-x + 0.04, y, size.z()});
  fourLegs(joiner, x, y, seat - 0.04);
}

void cabinet(Joiner& joiner, const Eigen::Vector3d& size) {
  const double x = 0.5 * size.x(), y = 0.5 * size.y(), gap = 0.015, door = 0.02;
  joiner.box({-x, -y, kPlinth}, {x - door, y, size.z()});
  joiner.box({-x, -y + 0.03, 0.0}, {x - 0.06, y - 0.03, kPlinth});
  joiner.box({x - door, -y + gap, kPlinth + gap}, {x, -gap, size.z() - gap});
  joiner.box({x - door, gap, kPlinth + gap}, {x, y - gap, size.z() - gap});
}

void shelf(Joiner& joiner, const Eigen::Vector3d& size) {
  const double x = 0.5 * size.x(), y = 0.5 * size.y(), z = size.z();
  joiner.box({-x, -y, 0.0}, {-x + 0.01, y, z});
  joiner.box({-x, -y, 0.0}, {x, -y + kBoard, z});
  joiner.box({-x, y - kBoard, 0.0}, {x, y, z});
  const int boards = std::max(2, 1 + static_cast<int>(std::lround(z / 0.4)));
  for (int k = 0; k < boards; ++k) {
    const double low = (z - kBoard) * k / (boards - 1);
    joiner.box({-x, -y + kBoard, low}, {x - 0.005, y - kBoard, low + kBoard});
  }
}

void bed(Joiner& joiner, const Eigen::Vector3d& size) {
  const double x = 0.5 * size.x(), y = 0.5 * size.y(), top = 0.55 * size.z();
  joiner.box({-x + 0.05, -y, 0.1}, {x, y, 0.3});
  joiner.box({-x + 0.05, -y + 0.03, 0.3}, {x - 0.03, y - 0.03, top});
  joiner.box({-x, -y, 0.0}, {-x + 0.05, y, size.z()});
  joiner.box({-x + 0.1, -y + 0.2, top}, {-x + 0.5, y - 0.2, top + 0.1});
  fourLegs(joiner, x - 0.05, y, 0.1);
}

void sofa(Joiner& joiner, const Eigen::Vector3d& size) {
  const double x = 0.5 * size.x(), y = 0.5 * size.y(), z = size.z();
  const double arm = 0.18, back = 0.22;
  joiner.box({-x, -y + arm, 0.0}, {x, y - arm, 0.5 * z});
  joiner.box({-x, -y + arm, 0.5 * z}, {-x + back, y - arm, z});
  joiner.box({-x, -y, 0.0}, {x - 0.02, -y + arm, 0.72 * z});
  joiner.box({-x, y - arm, 0.0}, {x - 0.02, y, 0.72 * z});
}

using Maker = void (*)(Joiner&, const Eigen::Vector3d&);
constexpr std::array<std::pair<std::string_view, Maker>, 6> kMakers = {{{"table", table},
                                                                        {"chair", chair},
                                                                        {"cabinet", cabinet},
                                                                        {"shelf", shelf},
                                                                        {"bed", bed},
                                                                        {"sofa", sofa}}};

}  // namespace

void addFurniture(World& world, std::string_view kind, const Eigen::Isometry3d& map_from_furniture,
                  const Eigen::Vector3d& size) {
  for (const auto& [name, make] : kMakers) {
    if (name != kind) continue;
    Joiner joiner(world, map_from_furniture);
    make(joiner, size);
    return;
  }
  throw std::invalid_argument("unknown furniture '" + std::string(kind) + "'");
}

bool isFurniture(std::string_view kind) {
  for (const auto& maker : kMakers) {
    if (maker.first == kind) return true;
  }
  return false;
}

}  // namespace opp::mapping
