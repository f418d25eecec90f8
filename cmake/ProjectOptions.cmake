# SPDX-FileCopyrightText: 2026 The opp-mapping authors
# SPDX-License-Identifier: BSD-3-Clause
# Compile options of our own targets; never exported to users of the libraries.
add_library(project_options INTERFACE)
target_compile_options(project_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
if(OPP_WARNINGS_AS_ERRORS)
  target_compile_options(project_options INTERFACE -Werror)
endif()
if(OPP_SANITIZE)
  # A finding ends the program, so that the test fails: by itself undefined behaviour is only printed.
  target_compile_options(project_options INTERFACE
    -fsanitize=${OPP_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(project_options INTERFACE -fsanitize=${OPP_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
    target_compile_options(project_options INTERFACE
      -fsanitize-ignorelist=${CMAKE_CURRENT_LIST_DIR}/sanitizer_ignorelist.txt)
  endif()
endif()
