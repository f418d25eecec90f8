// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"

namespace opp::test {

/// A sensor that bends planes by `distortion_quadratic` · range² [m].
inline SensorModel sensorThatBends(double distortion_quadratic) {
  SensorModel sensor;
  sensor.distortion_quadratic = distortion_quadratic;
  return sensor;
}

}  // namespace opp::test
