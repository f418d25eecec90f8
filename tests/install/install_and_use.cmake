# SPDX-FileCopyrightText: 2026 The opp-mapping authors
# SPDX-License-Identifier: BSD-3-Clause
# cmake -D build_folder=... -D consumer=... [-D sanitize=...] -P install_and_use.cmake
set(work ${build_folder}/tests/install/work)
file(REMOVE_RECURSE ${work})

set(linker_flags "")
if(sanitize)  # the installed libraries of such a build need its runtime
  set(linker_flags -DCMAKE_EXE_LINKER_FLAGS=-fsanitize=${sanitize})
endif()
foreach(step
    "--install;${build_folder};--prefix;${work}/prefix"
    "-G;Ninja;-S;${consumer};-B;${work}/build;-DCMAKE_PREFIX_PATH=${work}/prefix;${linker_flags}"
    "--build;${work}/build")
  execute_process(COMMAND ${CMAKE_COMMAND} ${step} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
execute_process(COMMAND ${work}/build/use_opp COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${work}/build/use_mapping COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${work}/prefix/bin/opp-config -c ${work}/prefix/share/opp-mapping/config/lidar.ini
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
