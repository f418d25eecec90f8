// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>

namespace opp::mapping {

/// Makes or replaces a file so that at every moment `path` holds the old bytes or all of the new
/// ones: `write` fills a temporary file in the same folder, which is then renamed. If `write`
/// throws or the disk is full, the temporary file goes, the old file stays, and the error passes
/// on. A link is followed; a device or pipe (/dev/stdout) is written directly. Not a guard against
/// power failure: the bytes are not forced to the disk. \param write fills the binary stream it is
/// given. \throws std::runtime_error if the file cannot be written; whatever `write` throws.
void writeFileAtomically(const std::filesystem::path& path,
                         const std::function<void(std::ostream&)>& write);

/// The same for libraries that open files themselves: `write` makes the file at the path it is
/// given, which ends in the name (and so the extension) of `path`. That file must exist afterwards.
/// \throws std::runtime_error also if `path` is a device or pipe, which cannot be replaced.
void replaceFileAtomically(const std::filesystem::path& path,
                           const std::function<void(const std::filesystem::path&)>& write);

}  // namespace opp::mapping
