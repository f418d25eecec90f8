# SPDX-FileCopyrightText: 2026 The opp-mapping authors
# SPDX-License-Identifier: BSD-3-Clause
# opp_embed_scenes(TARGET file.ini...): makes built_in_scenes.h out of scene files, so that programs
# need no installed data.
function(opp_embed_scenes target)
  set(OPP_SCENE_LIST "")
  set(OPP_SCENE_COUNT 0)
  foreach(file ${ARGN})
    get_filename_component(name ${file} NAME_WE)
    file(READ ${file} text)
    string(APPEND OPP_SCENE_LIST "    {\"${name}\", R\"scene(${text})scene\"},\n")
    math(EXPR OPP_SCENE_COUNT "${OPP_SCENE_COUNT} + 1")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  endforeach()
  configure_file(src/simulation/built_in_scenes.h.in ${CMAKE_CURRENT_BINARY_DIR}/generated/built_in_scenes.h @ONLY)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/generated)
endfunction()
