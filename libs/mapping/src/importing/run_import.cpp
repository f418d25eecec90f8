// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/importing/run_import.h"

#include "opp/mapping/io/cloud_file.h"
#include "opp/mapping/io/gray16_png.h"
#include "opp/mapping/io/rawlog_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace opp::mapping {
namespace {

namespace fs = std::filesystem;

/// What the sets, and sensors in saturation, write where there is no depth, beside 0.
constexpr std::uint16_t kNoDepth = std::numeric_limits<std::uint16_t>::max();
constexpr std::size_t kKittiFloats = 4;  ///< x, y, z, reflectance

RawlogDepthImage readDepth(const fs::path& file, const ImportPlan& plan) {
  Gray16Image image = readGray16Png(file);
  RawlogDepthImage depth;
  depth.width = image.width;
  depth.height = image.height;
  depth.fx = plan.intrinsics.fx;
  depth.fy = std::abs(plan.intrinsics.fy);
  depth.cx = plan.intrinsics.cx;
  depth.cy = plan.intrinsics.cy;
  depth.range_unit = plan.range_unit;
  depth.max_range = plan.range_unit * (kNoDepth - 1);
  std::replace(image.pixels.begin(), image.pixels.end(), kNoDepth, std::uint16_t{0});
  if (plan.intrinsics.fy < 0.0) {
    // Rows run upward: with v' = height − 1 − v the same ray has a positive focal length.
    depth.cy = image.height - 1 - depth.cy;
    const auto width = static_cast<std::ptrdiff_t>(image.width);
    for (std::ptrdiff_t row = 0; row < image.height / 2; ++row) {
      const auto top = image.pixels.begin() + row * width;
      std::swap_ranges(top, top + width, image.pixels.end() - (row + 1) * width);
    }
  }
  if (depth.cx >= depth.width || depth.cy >= depth.height) {
    throw std::runtime_error(file.string() + ": has " + std::to_string(depth.width) + " x " +
                             std::to_string(depth.height) +
                             " pixels, but the principal point lies outside; give --intrinsics "
                             "that fit");
  }
  depth.counts = std::move(image.pixels);
  return depth;
}

/// Points of a KITTI file, bit by bit: little-endian floats x, y, z, reflectance.
std::vector<Eigen::Vector3f> readKittiPoints(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream),
                                std::istreambuf_iterator<char>()};
  constexpr std::size_t kPointBytes = kKittiFloats * sizeof(float);
  if (!stream.is_open() || bytes.size() % kPointBytes != 0) {
    throw std::runtime_error(file.string() + ": is no file of points of 16 bytes");
  }
  std::vector<Eigen::Vector3f> points(bytes.size() / kPointBytes);
  for (std::size_t k = 0; k < points.size(); ++k) {
    std::memcpy(points[k].data(), bytes.data() + k * kPointBytes, 3 * sizeof(float));
  }
  return points;
}

/// The measured points of a cloud file, bit by bit.
std::vector<Eigen::Vector3f> readCloudPoints(const fs::path& file) {
  std::vector<Eigen::Vector3f> points = readCloudFile(file).points;
  const auto is_lost = [](const Eigen::Vector3f& point) { return !point.allFinite(); };
  points.erase(std::remove_if(points.begin(), points.end(), is_lost), points.end());
  return points;
}

}  // namespace

void runImport(const ImportPlan& plan, const fs::path& rawlog,
               const std::function<void(std::size_t)>& progress) {
  RawlogWriter writer(rawlog);
  std::size_t done = 0;
  for (const ImportFrame& frame : plan.frames) {
    RawlogStamp stamp;
    stamp.timestamp = frame.timestamp;
    stamp.label = plan.kind == FrameKind::kDepthPng ? "DEPTH" : "LIDAR";
    switch (plan.kind) {
      case FrameKind::kDepthPng:
        writer.write(stamp, readDepth(frame.file, plan));
        break;
      case FrameKind::kKittiPoints:
        writer.write(stamp, readKittiPoints(frame.file));
        break;
      case FrameKind::kCloudFile:
        writer.write(stamp, readCloudPoints(frame.file));
        break;
    }
    if (progress) progress(++done);
  }
  writer.close();
}

}  // namespace opp::mapping
