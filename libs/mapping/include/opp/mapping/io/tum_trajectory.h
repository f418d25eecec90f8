// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/trajectory.h"

#include <filesystem>
#include <iosfwd>
#include <string>

namespace opp::mapping {

/// Reads a trajectory in TUM text form: one pose a line, `timestamp tx ty tz qx qy qz qw`,
/// separated by blanks; empty lines and what follows a `#` are ignored. Lines may come in any order
/// (each carries its own time) and are returned in ascending order of time. A line that repeats
/// another one exactly is dropped; two different poses for one moment are an error, because nothing
/// tells which one is meant. Quaternions are normalized; a norm further than 1 % from one is an
/// error (4 written decimals alone give 0.02 %). \param name what errors call the stream:
/// "name:line: ...". \return empty if there is no pose. \throws std::runtime_error on malformed
/// lines, numbers that are not finite, and contradicting poses.
Trajectory readTumTrajectory(std::istream& stream, const std::string& name);

/// As above, from a file. \throws std::runtime_error also if it cannot be read.
Trajectory readTumTrajectory(const std::filesystem::path& path);

/// The trajectory as TUM text with a comment that names the columns: time with 6 decimals, the rest
/// with 9 significant digits, qw ≥ 0. The same bytes in every locale.
/// \throws std::invalid_argument if a pose or a time is not finite.
std::string formatTumTrajectory(const Trajectory& trajectory);

/// Writes `formatTumTrajectory` to a file, whole or not at all.
/// \throws std::invalid_argument as above, std::runtime_error if the file cannot be written.
void writeTumTrajectory(const std::filesystem::path& path, const Trajectory& trajectory);

}  // namespace opp::mapping
