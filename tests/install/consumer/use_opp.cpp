// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include <opp/geometry/plane.h>

#include <iostream>

int main() {
  const opp::Plane floor = opp::Plane::fromPointNormal({0.0, 0.0, -1.0}, {0.0, 0.0, 2.0});
  std::cout << floor << '\n';
  return floor.signedDistance({0.0, 0.0, 2.0}) == 3.0 ? 0 : 1;
}
