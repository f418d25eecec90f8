// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/registration/register_scans.h"

#include <string>

namespace opp::apps {

/// The answer as JSON text in the form of the contract, ending in a line break. Without success the
/// pose and its covariance are null. Covariance: of rotation (rad) and translation (m) in the
/// target's axes, R ← Exp(ω) R, t ← t + v. Corner matches: ids as opp-detect numbers them, and
/// where they are in both clouds. The same answer gives the same bytes.
std::string formatRegistration(const mapping::Registration& registration, const Primitives& target,
                               const Primitives& source);

}  // namespace opp::apps
