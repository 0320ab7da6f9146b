# What every target is compiled with.

# Results must not depend on how the compiler fuses operations, nor on the machine it was built on: no contraction, no
# -march=native. Wide instructions are chosen at run time (Highway).
add_compile_options(-ffp-contract=off -fno-math-errno -fno-trapping-math)

# RelWithDebInfo is the build that is tested: as fast as a release, with assertions and line numbers.
string(REPLACE "-O2" "-O3" CMAKE_CXX_FLAGS_RELWITHDEBINFO "${CMAKE_CXX_FLAGS_RELWITHDEBINFO}")
string(REGEX REPLACE "-g( |$)" "-g1\\1" CMAKE_CXX_FLAGS_RELWITHDEBINFO "${CMAKE_CXX_FLAGS_RELWITHDEBINFO}")
string(REPLACE "-DNDEBUG" "" CMAKE_CXX_FLAGS_RELWITHDEBINFO "${CMAKE_CXX_FLAGS_RELWITHDEBINFO}")

if(RAYMO_SANITIZE)
  add_compile_options(-fsanitize=${RAYMO_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${RAYMO_SANITIZE})
  add_compile_definitions(RAYMO_INLINE=inline RAYMO_INLINE_BODY=)
endif()
if(RAYMO_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "RAYMO_FUZZ needs clang, for libFuzzer: use `make fuzz` or the preset fuzz")
  endif()
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# A compiler cache and a faster linker, where they are installed.
find_program(RAYMO_CCACHE ccache)
if(RAYMO_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # A precompiled header is known to ccache by its content, not by its time.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${RAYMO_CCACHE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-fpch-preprocess)
  else()
    add_compile_options("SHELL:-Xclang -fno-pch-timestamp")
  endif()
endif()
find_program(RAYMO_MOLD mold)
if(RAYMO_MOLD)
  add_link_options(-fuse-ld=mold)
endif()

# Warnings belong to our own targets only.
add_library(raymo_warnings INTERFACE)
target_compile_options(raymo_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # g++ 12 warns of impossible sizes within std::string where it is inlined (gcc.gnu.org/PR105329), and of the empty
  # half of a std::optional. Clang and the sanitizers watch over both.
  target_compile_options(raymo_warnings INTERFACE -Wno-stringop-overflow -Wno-restrict -Wno-array-bounds
                                                  -Wno-maybe-uninitialized)
elseif(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # std::stable_sort of libstdc++ 12 calls a function that C++20 deprecates.
  target_compile_options(raymo_warnings INTERFACE -Wno-deprecated-declarations)
endif()
if(RAYMO_WERROR)
  target_compile_options(raymo_warnings INTERFACE -Werror)
endif()

# One precompiled header of standard containers; nothing of ours. It is compiled twice: for the layers, which know no
# exceptions, and for the programs and tests, which do.
set(RAYMO_STANDARD_HEADERS <algorithm> <array> <cmath> <cstdint> <functional> <memory> <optional> <span> <string>
                           <string_view> <variant> <vector>)
set(RAYMO_LAYER_OPTIONS -fno-exceptions)
if(RAYMO_PCH)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/pch.cpp CONTENT "// Carries the precompiled header.\n")
  add_library(raymo_layer_pch OBJECT ${PROJECT_BINARY_DIR}/pch.cpp)
  target_compile_options(raymo_layer_pch PRIVATE ${RAYMO_LAYER_OPTIONS})
  add_library(raymo_program_pch OBJECT ${PROJECT_BINARY_DIR}/pch.cpp)
  foreach(pch raymo_layer_pch raymo_program_pch)
    target_precompile_headers(${pch} PRIVATE ${RAYMO_STANDARD_HEADERS})
  endforeach()
endif()

# raymo_compile(TARGET layer|program): the warnings, the exceptions and the precompiled header of its kind.
function(raymo_compile target kind)
  target_link_libraries(${target} PRIVATE raymo_warnings)
  if(kind STREQUAL "layer")
    target_compile_options(${target} PRIVATE ${RAYMO_LAYER_OPTIONS})
  endif()
  if(RAYMO_PCH)
    target_precompile_headers(${target} REUSE_FROM raymo_${kind}_pch)
  endif()
endfunction()
