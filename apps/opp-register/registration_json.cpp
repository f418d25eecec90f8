// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp-register/registration_json.h"

#include <nlohmann/json.hpp>

namespace opp::apps {
namespace {

using Json = nlohmann::ordered_json;

template <typename Matrix>
Json rowsOf(const Matrix& matrix) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    Json row = Json::array();
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) row.push_back(matrix(r, c));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json pointOf(const Primitives& primitives, int corner) {
  const Eigen::Vector3d& p = primitives.corners[static_cast<std::size_t>(corner)].position;
  return {p.x(), p.y(), p.z()};
}

}  // namespace

std::string formatRegistration(const mapping::Registration& registration, const Primitives& target,
                               const Primitives& source) {
  Json matches = Json::array();
  for (const mapping::CornerMatch& m : registration.corner_matches) {
    matches.push_back({{"target", m.target_corner},
                       {"source", m.source_corner},
                       {"target_position", pointOf(target, m.target_corner)},
                       {"source_position", pointOf(source, m.source_corner)}});
  }
  const bool success = registration.success;
  const bool icp = registration.mode_used == mapping::RegistrationMode::kIcp;
  Json json = {
      {"success", success},
      {"reason", success ? Json() : Json(registration.reason)},
      {"mode_used", icp ? "icp" : "corners"},
      {"dof", registration.dof},
      {"target_from_source", success ? rowsOf(registration.target_from_source.matrix()) : Json()},
      {"overlap", registration.overlap},
      {"rmse_m", registration.rms},
      {"covariance", success ? rowsOf(registration.covariance) : Json()},
      {"corner_matches", std::move(matches)}};
  // One key a line, so that the file can be read and compared.
  std::string text = "{\n";
  for (auto item = json.begin(); item != json.end(); ++item) {
    text += " " + Json(item.key()).dump() + ": " + item.value().dump();
    text += std::next(item) == json.end() ? "\n" : ",\n";
  }
  return text + "}\n";
}

}  // namespace opp::apps
