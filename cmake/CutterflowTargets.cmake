# How every library and test of the project is declared.

# cutterflow_library(NAME SOURCES a.cpp ... LINKS other ...): a static library that is included from the repository root.
function(cutterflow_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_include_directories(${name} PUBLIC "${CMAKE_SOURCE_DIR}")
  target_compile_options(${name} PRIVATE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Werror)
  target_link_libraries(${name} PUBLIC ${ARG_LINKS})
endfunction()

# A program for developers: with BUILD_TESTING=OFF only what is installed is built.
function(cutterflow_for_developers name)
  if(NOT BUILD_TESTING)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
  endif()
endfunction()

# cutterflow_test(NAME LABEL unit SOURCES test_x.cpp ... LINKS lib ... [RANKS n] [CORES n] [ARGS ...]): one GoogleTest program, one
# CTest entry. Labels: tree, unit, cli, mpi, liggghts, foam, coupled. With RANKS the program is started by mpirun and brings its own
# main. CORES: how many cores programs take that the test starts.
function(cutterflow_test name)
  cmake_parse_arguments(ARG "" "LABEL;RANKS;CORES;TIMEOUT" "SOURCES;LINKS;ARGS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  cutterflow_for_developers(${name})
  target_compile_options(${name} PRIVATE -Wall -Wextra)
  target_compile_definitions(${name} PRIVATE CUTTERFLOW_SOURCE_DIR="${CMAKE_SOURCE_DIR}" CUTTERFLOW_BUILD_DIR="${CMAKE_BINARY_DIR}")
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests")
  if(ARG_RANKS)
    target_link_libraries(${name} PRIVATE ${ARG_LINKS} GTest::gtest)
  else()
    target_link_libraries(${name} PRIVATE ${ARG_LINKS} GTest::gtest GTest::gtest_main)
  endif()
  cutterflow_add_ctest(${name} ${ARG_LABEL} "${ARG_RANKS}" "${ARG_TIMEOUT}" $<TARGET_FILE:${name}> ${ARG_ARGS})
  if(ARG_CORES)
    set_tests_properties(${name} PROPERTIES PROCESSORS ${ARG_CORES})
  endif()
endfunction()

# Registers a command as a CTest entry, on one rank or on several; Open MPI is told what a bare machine or a container needs.
function(cutterflow_add_ctest name label ranks timeout)
  if(ranks)
    add_test(NAME ${name} COMMAND mpirun --oversubscribe --bind-to none -n ${ranks} ${ARGN})
    set_tests_properties(${name} PROPERTIES PROCESSORS ${ranks})
  else()
    add_test(NAME ${name} COMMAND ${ARGN})
  endif()
  if(NOT timeout)
    set(timeout 120)
  endif()
  # Long tests start first.
  set_tests_properties(${name} PROPERTIES COST ${timeout})
  if(CUTTERFLOW_SANITIZE)  # sanitizers make programs several times slower
    math(EXPR timeout "6 * ${timeout}")
  endif()
  set_tests_properties(${name} PROPERTIES LABELS ${label} TIMEOUT ${timeout} ENVIRONMENT
    "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;WM_PROJECT_DIR=/usr/share/openfoam;OMPI_MCA_btl_vader_single_copy_mechanism=none;OMPI_MCA_mpi_yield_when_idle=1")
endfunction()
