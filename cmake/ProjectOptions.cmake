# SPDX-FileCopyrightText: 2026 The opp-mapping authors
# SPDX-License-Identifier: BSD-3-Clause
# Compile options of our own targets; never exported to users of the libraries.
add_library(project_options INTERFACE)
target_compile_options(project_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
if(OPP_WARNINGS_AS_ERRORS)
  target_compile_options(project_options INTERFACE -Werror)
endif()
if(OPP_SANITIZE)
  target_compile_options(project_options INTERFACE -fsanitize=${OPP_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(project_options INTERFACE -fsanitize=${OPP_SANITIZE})
endif()
