# raymo_layer(NAME USES layer... [LINKS target...])
#
# Declares the folder raymo/NAME as one layer: a static library `raymo_NAME` (alias raymo::NAME), its unit tests
# `unit.NAME` (every *_test.cpp below the folder), and the test `layer.NAME`, which fails on an include of a layer that
# is not among USES. Sources are found by globbing on purpose: a list would be a second place to register a file.
function(raymo_layer name)
  cmake_parse_arguments(ARG "" "" "USES;LINKS" ${ARGN})
  set(dir ${PROJECT_SOURCE_DIR}/raymo/${name})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${dir}/*.cpp)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${dir}/*.hpp)
  set(tests ${sources})
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "_(test|laws)\\.cpp$")

  set(scope PUBLIC)
  if(sources)
    add_library(raymo_${name} STATIC ${sources})
    target_link_libraries(raymo_${name} PRIVATE raymo_warnings)
    raymo_use_pch(raymo_${name})
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
      target_link_libraries(unit_${name} PRIVATE raymo::${name} raymo_warnings doctest::doctest)
      add_test(NAME unit.${name} COMMAND unit_${name})
    endif()
    add_test(NAME layer.${name}
             COMMAND ${CMAKE_COMMAND} -DLAYER=${name} "-DALLOWED=${name};${ARG_USES}" -DDIR=${dir}
                     -P ${PROJECT_SOURCE_DIR}/cmake/CheckIncludes.cmake)
  endif()
endfunction()
