// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/io/atomic_file.h"

#include "common/flags.h"
#include "common/run_main.h"

#include <iostream>

namespace {

void run(opp::apps::CommandLine& line) {
  opp::apps::ParameterFlags parameters(line);
  TCLAP::ValueArg<std::string> write(
      "", "write", "Write a configuration file with every parameter instead of printing a table",
      false, "", "FILE.ini", line);
  line.parse();

  opp::mapping::MapperParams params;
  parameters.applyTo(params);
  if (!write.isSet()) return opp::mapping::writeParameterTable(std::cout, params);
  opp::mapping::writeFileAtomically(write.getValue(), [&](std::ostream& os) {
    os << "# Every parameter of opp-mapping; written by opp-config. Lines may be left out.\n\n";
    opp::mapping::writeParameters(os, params);
  });
}

}  // namespace

int main(int argc, char** argv) {
  return opp::apps::runMain(argc, argv, "opp-config",
                            "Shows every parameter with value, default, range and meaning.", run);
}
