# raymo_layer(NAME USES layer... [LINKS target...] [TESTED_WITH target...])
#
# Declares the folder raymo/NAME as one layer: a static library `raymo_NAME` (alias raymo::NAME), its unit tests
# `unit.NAME` (every *_test.cpp below the folder), the test `layer.NAME`, which fails on an include of a layer that is
# not among USES (its tests may include those of TESTED_WITH, too), and `headers.NAME`, which compiles every header
# alone. Sources are found by globbing on purpose: a list would be a second place to register a file.
function(raymo_layer name)
  cmake_parse_arguments(ARG "" "" "USES;LINKS;TESTED_WITH" ${ARGN})
  set(dir ${PROJECT_SOURCE_DIR}/raymo/${name})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${dir}/*.cpp)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${dir}/*.hpp)
  set(tests ${sources})
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "_(test|laws)\\.cpp$")
  # Highway compiles *-inl.hpp once per instruction set, within another file; test_*.hpp belong to the tests.
  list(FILTER headers EXCLUDE REGEX "-inl\\.hpp$|/test_[a-z_]*\\.hpp$")

  set(scope PUBLIC)
  if(sources)
    add_library(raymo_${name} STATIC ${sources})
    raymo_compile(raymo_${name} layer)
  else()
    add_library(raymo_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(raymo::${name} ALIAS raymo_${name})
  target_include_directories(raymo_${name} ${scope} ${PROJECT_SOURCE_DIR})
  foreach(used ${ARG_USES})
    target_link_libraries(raymo_${name} ${scope} raymo::${used})
  endforeach()
  target_link_libraries(raymo_${name} ${scope} ${ARG_LINKS})

  if(RAYMO_TESTS)
    if(tests)
      add_executable(unit_${name} ${tests} $<TARGET_OBJECTS:raymo_doctest_main>)
      target_link_libraries(unit_${name} PRIVATE raymo::${name} doctest::doctest ${ARG_TESTED_WITH})
      raymo_compile(unit_${name} program)
      add_test(NAME unit.${name} COMMAND unit_${name})
    endif()
    list(TRANSFORM ARG_TESTED_WITH REPLACE "^raymo::" "")
    add_test(NAME layer.${name}
             COMMAND ${CMAKE_COMMAND} -DLAYER=${name} "-DALLOWED=${name};${ARG_USES}" "-DTESTED_WITH=${ARG_TESTED_WITH}"
                     -DDIR=${dir}
                     -P ${PROJECT_SOURCE_DIR}/cmake/CheckIncludes.cmake)
    raymo_check_headers(${name} ${headers})
  endif()
endfunction()

# Each header, included twice, is a translation unit of its own. They are built when the test runs, not before: whoever
# only wants the program does not wait for them.
function(raymo_check_headers name)
  set(units "")
  foreach(header ${ARGN})
    file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${header})
    string(MAKE_C_IDENTIFIER ${path} unit)
    set(unit ${PROJECT_BINARY_DIR}/headers/${unit}.cpp)
    file(CONFIGURE OUTPUT ${unit} CONTENT "#include \"${path}\"\n#include \"${path}\"\n")
    list(APPEND units ${unit})
  endforeach()
  if(units)
    add_library(headers_${name} OBJECT EXCLUDE_FROM_ALL ${units})
    target_link_libraries(headers_${name} PRIVATE raymo::${name} raymo_warnings)
    target_compile_options(headers_${name} PRIVATE ${RAYMO_LAYER_OPTIONS} -O0 -g0)
    add_test(NAME headers.${name} COMMAND ${CMAKE_COMMAND} --build ${PROJECT_BINARY_DIR} --target headers_${name})
    # One at a time: they share the build folder.
    set_tests_properties(headers.${name} PROPERTIES RESOURCE_LOCK build_folder TIMEOUT 600)
  endif()
endfunction()
