// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace opp {

/// One constant for all: EIGEN_PI is a long double in Eigen 3.4 and M_PI is not standard C++.
inline constexpr double kPi = 3.14159265358979323846;

constexpr double degToRad(double degrees) { return degrees * kPi / 180.0; }
constexpr double radToDeg(double radians) { return radians * 180.0 / kPi; }

}  // namespace opp
