# SPDX-FileCopyrightText: 2026 The opp-mapping authors
# SPDX-License-Identifier: BSD-3-Clause
# opp_embed_report(TARGET): makes report_resources.h out of the report's page and of three.js, so that
# programs need no installed data.
set(OPP_THREE_JS_FOLDER /usr/share/javascript/three CACHE PATH "Where three.js is (Debian: libjs-three)")

# Appends a constant to OPP_REPORT_RESOURCES: the text of one or more files in pieces that every
# compiler takes as literals.
function(opp_add_report_resource constant)
  set(text "")
  foreach(file ${ARGN})
    file(READ ${file} part)
    string(APPEND text "${part}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  endforeach()
  string(FIND "${text}" ")report\"" end_of_literal)
  if(NOT end_of_literal EQUAL -1)
    message(FATAL_ERROR "${ARGN}: holds the characters that end the literal it is embedded in")
  endif()
  string(LENGTH "${text}" length)
  set(pieces "")
  set(count 0)
  set(start 0)
  while(start LESS length)
    string(SUBSTRING "${text}" ${start} 16000 piece)
    string(APPEND pieces "R\"report(${piece})report\"sv,\n")
    math(EXPR start "${start} + 16000")
    math(EXPR count "${count} + 1")
  endwhile()
  set(OPP_REPORT_RESOURCES "${OPP_REPORT_RESOURCES}
inline constexpr std::array<std::string_view, ${count}> ${constant} = {{
${pieces}}};
" PARENT_SCOPE)
endfunction()

function(opp_embed_report target)
  set(three_js build/three.min.js examples/js/controls/OrbitControls.js examples/js/loaders/GLTFLoader.js)
  list(TRANSFORM three_js PREPEND ${OPP_THREE_JS_FOLDER}/)
  foreach(file ${three_js})
    if(NOT EXISTS ${file})
      message(FATAL_ERROR "three.js for report.html: there is no ${file}. "
                          "Install libjs-three, or set OPP_THREE_JS_FOLDER.")
    endif()
  endforeach()
  set(OPP_REPORT_RESOURCES "")
  opp_add_report_resource(kPage src/report/page.html)
  opp_add_report_resource(kStyle src/report/style.css)
  opp_add_report_resource(kViewer src/report/viewer.js)
  opp_add_report_resource(kThreeJsLicence src/report/three_js_licence.txt)
  opp_add_report_resource(kThreeJs ${three_js})
  configure_file(src/report/report_resources.h.in ${CMAKE_CURRENT_BINARY_DIR}/generated/report_resources.h @ONLY)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/generated)
endfunction()
