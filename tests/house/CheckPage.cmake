# Fails when PAGE is not what PROGRAM prints. Run with cmake -P.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${PROGRAM} OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
file(READ ${PAGE} page)
if(NOT page STREQUAL printed)
  message(FATAL_ERROR "${PAGE} does not follow the schemas any more: run `make docs`.\n${printed}")
endif()
