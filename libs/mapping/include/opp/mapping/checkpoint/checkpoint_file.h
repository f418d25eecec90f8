// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/checkpoint/run_identity.h"
#include "opp/mapping/pipeline/mapping_run.h"

#include <filesystem>

namespace opp::mapping {

/// Writes all of a run that goes on later, whole or not at all (`writeFileAtomically`). The size is
/// about that of the samples of all keyframes.
/// \throws std::runtime_error if the file cannot be written.
void writeCheckpoint(const std::filesystem::path& file, const RunIdentity& identity,
                     const MappingRun& run);

/// Takes up the run that was written: what comes after is the same to the bit as if it had never
/// stopped. \param run new, made of the parameters that `identity` has.
/// \throws std::runtime_error that says what to do if the file cannot be read, is damaged, or comes
/// of a run of another identity; `run` is then of no more use.
void readCheckpoint(const std::filesystem::path& file, const RunIdentity& identity,
                    MappingRun& run);

}  // namespace opp::mapping
