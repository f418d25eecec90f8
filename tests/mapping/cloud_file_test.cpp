// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/cloud_file.h"

#include "support/random.h"
#include "support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <liblzf/lzf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

namespace opp::mapping {
namespace {

using Eigen::Vector3f;
using test::Random;
using test::TempFolder;

/// The bytes of numbers of type Stored, in either byte order.
template <typename Stored>
std::string bytesOf(double value, bool big_endian = false) {
  const auto stored = static_cast<Stored>(value);
  std::string bytes(sizeof stored, '\0');
  std::memcpy(bytes.data(), &stored, sizeof stored);  // the tests run on little-endian machines
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

PointCloud randomCloud(Random& random, int count, bool normals) {
  PointCloud cloud;
  for (int i = 0; i < count; ++i) {
    cloud.points.push_back(random.vector(10.0).cast<float>());
    if (normals) cloud.normals.push_back(random.unitVector().cast<float>());
  }
  return cloud;
}

/// A PLY file with a property of each kind that must be passed over.
template <typename Stored>
std::string binaryPly(const PointCloud& cloud, bool big_endian, const std::string& type) {
  std::ostringstream os;
  os << "ply\r\nformat binary_" << (big_endian ? "big" : "little") << "_endian 1.0\r\n"
     << "comment made by a test\nelement camera 1\nproperty float gain\nproperty list uchar short "
        "w\n"
     << "element vertex " << cloud.size() << "\nproperty uchar red\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    if (name[1] == '\0' || cloud.hasNormals()) os << "property " << type << ' ' << name << '\n';
  }
  os << "property list uchar int32 neighbors\nelement face 1\nproperty int a\nend_header\n"
     << bytesOf<float>(1.5, big_endian) << bytesOf<unsigned char>(2)
     << bytesOf<short>(7, big_endian) << bytesOf<short>(-7, big_endian);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    os << bytesOf<unsigned char>(200);
    for (int k = 0; k < 3; ++k) os << bytesOf<Stored>(double{cloud.points[i][k]}, big_endian);
    for (int k = 0; k < 3 && cloud.hasNormals(); ++k) {
      os << bytesOf<Stored>(double{cloud.normals[i][k]}, big_endian);
    }
    os << bytesOf<unsigned char>(static_cast<double>(i % 3));
    for (std::size_t k = 0; k < i % 3; ++k) os << bytesOf<std::int32_t>(5, big_endian);
  }
  os << bytesOf<std::int32_t>(3, big_endian);
  return os.str();
}

std::string textOf(float value) {
  std::ostringstream os;
  os.precision(9);
  os << value;
  return os.str();
}

std::string textPly(const PointCloud& cloud) {
  std::ostringstream os;
  os << "ply\nformat ascii 1.0\nelement vertex " << cloud.size()
     << "\nproperty double z\nproperty double y\nproperty double x\nproperty int "
        "label\nend_header\n";
  for (const Vector3f& p : cloud.points) {
    os << textOf(p.z()) << ' ' << textOf(p.y()) << "\t" << textOf(p.x()) << " -4\n";
  }
  return os.str();
}

std::string pcdHeader(std::size_t width, std::size_t height, const std::string& encoding) {
  std::ostringstream os;
  os << "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z _ normal_x normal_y normal_z label\n"
     << "SIZE 4 4 4 1 4 4 4 2\nTYPE F F F U F F F I\nCOUNT 1 1 1 4 1 1 1 1\nWIDTH " << width
     << "\nHEIGHT " << height << "\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS " << width * height << "\nDATA "
     << encoding << '\n';
  return os.str();
}

/// The seven-and-one fields of `pcdHeader`, point by point or field by field.
std::string pcdBody(const PointCloud& cloud, bool packed) {
  std::vector<std::string> columns(8);
  std::string rows;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (std::size_t field = 0; field < columns.size(); ++field) {
      std::string bytes(4, '\7');
      if (field < 3) bytes = bytesOf<float>(double{cloud.points[i][static_cast<int>(field)]});
      if (field > 3 && field < 7) {
        bytes = bytesOf<float>(double{cloud.normals[i][static_cast<int>(field) - 4]});
      }
      if (field == 7) bytes = bytesOf<short>(static_cast<double>(i) - 1.0);
      columns[field] += bytes;
      rows += bytes;
    }
  }
  if (!packed) return rows;
  std::string joined;
  for (const std::string& column : columns) joined += column;
  return joined;
}

std::string compressed(const std::string& plain) {
  std::string out(plain.size() * 2 + 64, '\0');
  const unsigned int size = lzf_compress(plain.data(), static_cast<unsigned int>(plain.size()),
                                         out.data(), static_cast<unsigned int>(out.size()));
  return bytesOf<std::uint32_t>(size) + bytesOf<std::uint32_t>(static_cast<double>(plain.size())) +
         out.substr(0, size);
}

std::string pcdFile(const PointCloud& cloud, std::size_t rows, const std::string& encoding) {
  const std::string header = pcdHeader(cloud.size() / rows, rows, encoding);
  if (encoding == "binary") return header + pcdBody(cloud, false);
  if (encoding == "binary_compressed") return header + compressed(pcdBody(cloud, true));
  std::ostringstream os;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int k = 0; k < 3; ++k) os << textOf(cloud.points[i][k]) << ' ';
    os << "7 7 7 7 ";
    for (int k = 0; k < 3; ++k) os << textOf(cloud.normals[i][k]) << ' ';
    os << static_cast<int>(i) - 1 << '\n';
  }
  return header + os.str();
}

PointCloud readBytes(const TempFolder& folder, const char* name, const std::string& bytes) {
  test::writeFile(folder / name, bytes);
  return readCloudFile(folder / name);
}

TEST(CloudFile, ReadsBinaryPlyOfEitherByteOrderAndPrecision) {
  const TempFolder folder;
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const PointCloud cloud = randomCloud(random, random.integer(0, 40), trial % 2 == 0);
    for (const bool big_endian : {false, true}) {
      for (const auto& bytes : {binaryPly<float>(cloud, big_endian, "float"),
                                binaryPly<double>(cloud, big_endian, "float64")}) {
        const PointCloud read = readBytes(folder, "cloud.ply", bytes);
        EXPECT_EQ(read.points, cloud.points);
        EXPECT_EQ(read.normals, cloud.normals);
        EXPECT_FALSE(read.organized());
      }
    }
  }
}

TEST(CloudFile, ReadsTextPlyWithPropertiesInAnyOrder) {
  const TempFolder folder;
  Random random(2);
  const PointCloud cloud = randomCloud(random, 20, false);
  EXPECT_EQ(readBytes(folder, "cloud.PLY", textPly(cloud)).points, cloud.points);
  const LabeledCloud labeled = readLabeledCloudFile(folder / "cloud.PLY");
  EXPECT_EQ(labeled.labels, std::vector<int>(20, -4));
}

TEST(CloudFile, ReadsEveryEncodingOfPcdWithGridViewpointAndLabels) {
  const TempFolder folder;
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const int rows = random.integer(1, 5);
    const PointCloud cloud = randomCloud(random, rows * random.integer(1, 30), true);
    for (const char* encoding : {"ascii", "binary", "binary_compressed"}) {
      test::writeFile(folder / "cloud.pcd",
                      pcdFile(cloud, static_cast<std::size_t>(rows), encoding));
      const LabeledCloud read = readLabeledCloudFile(folder / "cloud.pcd");
      EXPECT_EQ(read.cloud.points, cloud.points) << encoding;
      EXPECT_EQ(read.cloud.normals, cloud.normals) << encoding;
      EXPECT_EQ(read.cloud.viewpoint, Vector3f(1, 2, 3));
      EXPECT_EQ(read.cloud.rows, rows > 1 ? rows : 0);
      ASSERT_EQ(read.labels.size(), cloud.size());
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        ASSERT_EQ(read.labels[i], static_cast<int>(i) - 1) << encoding;
      }
    }
  }
}

TEST(CloudFile, IntensityStandsInForLabelsAndNanIsNoLabel) {
  const TempFolder folder;
  test::writeFile(folder / "a.pcd",
                  "VERSION .7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
                  "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n"
                  "1 2 3 12\nnan nan nan nan\n");
  const LabeledCloud read = readLabeledCloudFile(folder / "a.pcd");
  EXPECT_EQ(read.labels, (std::vector<int>{12, -1}));
  EXPECT_EQ(read.cloud.points[0], Vector3f(1, 2, 3));
  EXPECT_TRUE(read.cloud.points[1].array().isNaN().all());
}

TEST(CloudFile, ReadsXyzWithAndWithoutNormals) {
  const TempFolder folder;
  const PointCloud plain =
      readBytes(folder, "a.xyz", "# x y z\n1 2 3\r\n\n-1.5e0,2;+4 255 0 0 # red\n");
  EXPECT_EQ(plain.points, (std::vector<Vector3f>{{1, 2, 3}, {-1.5F, 2, 4}}));
  EXPECT_FALSE(plain.hasNormals());
  const PointCloud oriented = readBytes(folder, "a.txt", "1 2 3 0 0.6 -0.8\n4 5 6 1 0 0");
  EXPECT_EQ(oriented.points[1], Vector3f(4, 5, 6));
  EXPECT_EQ(oriented.normals, (std::vector<Vector3f>{{0, 0.6F, -0.8F}, {1, 0, 0}}));
  EXPECT_EQ(readBytes(folder, "a.xyz", "").size(), 0U);
}

TEST(CloudFile, WrittenLabelsAreReadBack) {
  const TempFolder folder;
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    PointCloud cloud = randomCloud(random, random.integer(0, 50), false);
    std::vector<int> labels;
    for (std::size_t i = 0; i < cloud.size(); ++i) labels.push_back(random.integer(-1, 40));
    writeLabeledPly(folder / "labels.ply", cloud, labels);
    const LabeledCloud read = readLabeledCloudFile(folder / "labels.ply");
    EXPECT_EQ(read.cloud.points, cloud.points);
    EXPECT_EQ(read.labels, labels);
  }
  EXPECT_THROW(writeLabeledPly(folder / "x.ply", PointCloud{}, {1}), std::invalid_argument);
  EXPECT_EQ(folder.contents(), std::vector<std::string>{"labels.ply"});
}

std::string errorOf(const TempFolder& folder, const char* name, const std::string& bytes) {
  try {
    readBytes(folder, name, bytes);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(CloudFile, ErrorsNameFileAndPlace) {
  using testing::AllOf;
  using testing::HasSubstr;
  const TempFolder folder;
  const auto expectError = [&](const char* name, const std::string& bytes, const char* place,
                               const char* what) {
    EXPECT_THAT(errorOf(folder, name, bytes),
                AllOf(HasSubstr((folder / name).string()), HasSubstr(place), HasSubstr(what)));
  };
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n";
  expectError("a.ply", "hello", "line 1", "not a PLY file");
  expectError("a.ply", ply + "1 2 3\n4 five 6\n", "line 9", "'five' is not a number");
  expectError("a.ply", ply + "1 2 3\n", "line 9", "truncated");
  expectError("a.ply", "ply\nformat ascii 2.0\n", "line 2", "unknown PLY format");
  expectError("a.ply", "ply\nformat ascii 1.0\nelement vertex -1\n", "line 3", "count");
  expectError("a.ply", "ply\nformat ascii 1.0\nelement a 1\nproperty half x\n", "line 4", "type");
  expectError("a.ply", "ply\nformat ascii 1.0\nend_header\n", "", "no element 'vertex'");
  expectError("a.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n",
              "", "no x, y and z");
  expectError("a.xyz", "1 2 3\n1 2\n", "line 2", "three numbers");
  expectError("a.xyz", "1 2 3\n1 2 z\n", "line 2", "'z' is not a number");
  expectError("a.pcd", "FIELDS x y z\nSIZE 4 4\n", "line 2", "one entry per field");
  expectError("a.pcd", "FIELDS x\nSIZE 2\nTYPE F\nCOUNT 1\nWIDTH 1\nHEIGHT 1\nDATA ascii\n1",
              "line 7", "SIZE 4 or 8");
  expectError("a.pcd", "FIELDS x\nWIDTH 3\nPOINTS 2\nDATA ascii\n", "line 4", "WIDTH x HEIGHT");
  expectError("a.pcd", "FIELDS x\nWIDTH 1\nDATA zip\n", "line 3", "unknown DATA");
  expectError("a.stl", "", "", "unknown kind");
  EXPECT_THROW(readCloudFile(folder / "missing.ply"), std::runtime_error);
  EXPECT_THROW(readCloudFile(folder.path()), std::runtime_error);
  EXPECT_THROW(readLabeledCloudFile(folder / "a.xyz"), std::runtime_error);
}

TEST(CloudFile, TruncatedFilesAreErrors) {
  const TempFolder folder;
  Random random(5);
  const PointCloud cloud = randomCloud(random, 12, true);
  const std::vector<std::pair<const char*, std::string>> files = {
      {"a.ply", binaryPly<float>(cloud, false, "float")},
      {"b.ply", binaryPly<double>(cloud, true, "double")},
      {"c.pcd", pcdFile(cloud, 3, "binary")},
      {"d.pcd", pcdFile(cloud, 1, "binary_compressed")}};
  for (const auto& [name, bytes] : files) {
    // Behind the points of the PLY files stands one face of four bytes, which nobody reads.
    const std::size_t end = bytes.size() - (name[2] == 'p' && name[3] == 'l' ? 4 : 0);
    for (std::size_t length = 0; length < end; length += 13) {
      EXPECT_NE(errorOf(folder, name, bytes.substr(0, length)), "no error")
          << name << ' ' << length;
    }
  }
}

TEST(CloudFile, DamagedBytesGiveACloudOrAnErrorButNoCrash) {
  const TempFolder folder;
  Random random(6);
  const PointCloud cloud = randomCloud(random, 12, true);
  const std::vector<std::pair<const char*, std::string>> files = {
      {"a.ply", binaryPly<float>(cloud, false, "float")},
      {"b.ply", textPly(cloud)},
      {"c.pcd", pcdFile(cloud, 3, "binary")},
      {"d.pcd", pcdFile(cloud, 1, "ascii")},
      {"e.pcd", pcdFile(cloud, 3, "binary_compressed")},
      {"f.xyz", "1 2 3\n4 5 6 0 0 1\n"}};
  int errors = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const auto& [name, bytes] = files[static_cast<std::size_t>(trial) % files.size()];
    std::string damaged = bytes;
    if (trial % 12 < 6) {
      for (int k = 0; k < 3; ++k) {
        const auto at =
            static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1));
        damaged[at] = static_cast<char>(random.integer(0, 255));
      }
    } else {
      damaged.resize(static_cast<std::size_t>(random.integer(0, 300)));
      for (char& c : damaged) c = static_cast<char>(random.integer(0, 255));
    }
    errors += errorOf(folder, name, damaged) == "no error" ? 0 : 1;
  }
  EXPECT_GT(errors, 149);  // random bytes are no cloud, and these are half of the trials
}

}  // namespace
}  // namespace opp::mapping
