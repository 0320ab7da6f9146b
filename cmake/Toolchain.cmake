# What every target is compiled with.

# Results must not depend on how the compiler fuses operations, nor on the machine it was built on: no contraction, no
# -march=native. Wide instructions are chosen at run time (Highway).
add_compile_options(-ffp-contract=off -fno-math-errno -fno-trapping-math)
string(REPLACE "-O2" "-O3" CMAKE_CXX_FLAGS_RELWITHDEBINFO "${CMAKE_CXX_FLAGS_RELWITHDEBINFO}")
string(REPLACE "-g" "-g1" CMAKE_CXX_FLAGS_RELWITHDEBINFO "${CMAKE_CXX_FLAGS_RELWITHDEBINFO}")
string(REPLACE "-DNDEBUG" "" CMAKE_CXX_FLAGS_RELWITHDEBINFO "${CMAKE_CXX_FLAGS_RELWITHDEBINFO}")

if(RAYMO_SANITIZE)
  add_compile_options(-fsanitize=${RAYMO_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${RAYMO_SANITIZE})
endif()

find_program(RAYMO_CCACHE ccache)
if(RAYMO_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${RAYMO_CCACHE})
endif()
find_program(RAYMO_MOLD mold)
if(RAYMO_MOLD)
  add_link_options(-fuse-ld=mold)
endif()

# Warnings belong to our own targets only.
add_library(raymo_warnings INTERFACE)
target_compile_options(raymo_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow)
if(RAYMO_WERROR)
  target_compile_options(raymo_warnings INTERFACE -Werror)
endif()

# One precompiled header of standard containers; nothing of ours.
function(raymo_use_pch target)
  target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <memory> <optional> <span> <string>
                            <string_view> <variant> <vector>)
endfunction()
