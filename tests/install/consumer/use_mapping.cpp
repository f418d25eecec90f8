// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include <opp/mapping/core/mapper_params.h>
#include <opp/mapping/core/version.h>
#include <opp/mapping/io/parameters.h>

#include <iostream>

int main() {
  opp::mapping::MapperParams params;
  opp::mapping::setParameter("sensor.max_range = 3 m", params);
  opp::mapping::writeParameterTable(std::cout, params);
  std::cout << "opp-mapping " << opp::mapping::version() << '\n';
  return params.primitives.sensor.max_range == 3.0 ? 0 : 1;
}
