// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"
#include "opp/mapping/simulation/simulator.h"
#include "opp/mapping/simulation/world.h"
#include "opp/params/field.h"

#include <Eigen/Geometry>

#include <memory>
#include <string_view>

namespace opp::mapping {

/// What counts as seen.
struct GroundTruthParams {
  static constexpr std::string_view kSection = "ground_truth";
  double cell = 0.025;
  double closing = 0.05;
  double reach = 0.2;
  int min_pixels = 300;
  double join_gap = 0.5;
  double near_gap = 0.05;

  /// Settings for a sensor: a lidar's rings are far apart, so its coverage is closed over more.
  static GroundTruthParams forSensor(SimulatedSensor sensor);

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.cell, Field{"cell", "m", 1e-3, 1.0, "raster of what was seen of a face"});
    f(p.closing, Field{"closing", "m", 0.0, 1.0, "gaps up to twice this wide count as seen"});
    f(p.reach, Field{"reach", "m", 1e-3, 1.0, "pixels this near belong to a line or corner"});
    f(p.min_pixels, Field{"min_pixels", "", 1.0, 1e9, "valid pixels that make a primitive seen"});
    f(p.join_gap, Field{"join_gap", "m", 0.0, 100.0, "coplanar faces this near are one plane"});
    f(p.near_gap, Field{"near_gap", "m", 0.0, 1.0, "faces this near may be taken for touching"});
  }
};

/// Collects what frames saw of a world and states it as a planar map, exact in geometry:
/// - Plane: coplanar flat faces, seen from the same side and at most `join_gap` apart (two sides of
///   a wall are two planes), with at least `min_pixels` valid pixels. Its polygons are its faces
///   clipped to what was seen; points counts pixels; observations are the frames that alone had
///   min_pixels on one of its faces.
/// - Line: where faces of two orthogonal planes touch along a seam and both were seen there, with
///   min_pixels within `reach` of it, a third of min_pixels at least on either plane.
/// - Corner: the same for a point of three mutually orthogonal planes.
/// What was seen, but not that much, is in PlanarMap::barely_seen: planes with at least one pixel;
/// for the planes of both lists, the rest of each seam and each corner, those of faces with a gap
/// of up to `near_gap` included (a sensor cannot tell a table 1 cm off the wall from one that
/// touches it). A program that finds them is not wrong.
/// Independent of all detection code. Memory: one counter for each cell of the faces hit.
class GroundTruth {
 public:
  /// \throws std::invalid_argument if a parameter is out of range. \p world must outlive this.
  GroundTruth(const World& world, const GroundTruthParams& params);
  ~GroundTruth();
  GroundTruth(GroundTruth&&) noexcept;
  GroundTruth& operator=(GroundTruth&&) noexcept;

  /// Counts the valid pixels of a frame. Linear in their number.
  void add(const SimulatedFrame& frame, const Eigen::Isometry3d& body_from_sensor);
  /// What all frames so far saw, in the map frame. Ids are indices.
  PlanarMap map() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace opp::mapping
