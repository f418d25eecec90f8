// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/planar_map_schema.h"

namespace opp::test {
namespace {

constexpr const char* kValidate = R"(
import json, sys, jsonschema
schema = json.load(open(sys.argv[1]))
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
for name in sys.argv[2:]:
    for error in validator.iter_errors(json.load(open(name))):
        sys.exit(f"{name}: {error.json_path}: {error.message}")
)";

}  // namespace

CommandResult validatePlanarMaps(const std::vector<std::filesystem::path>& files) {
  // Debian's python3, not one that comes first in PATH: python3-jsonschema installs into it.
  std::vector<std::string> command{"/usr/bin/python3", "-c", kValidate,
                                   OPP_SOURCE_FOLDER "/docs/planar_map.schema.json"};
  for (const auto& file : files) command.push_back(file.string());
  return runCommand(command);
}

}  // namespace opp::test
