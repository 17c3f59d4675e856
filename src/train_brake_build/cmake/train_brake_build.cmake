# How every C++ target of the workspace is compiled. A package that finds train_brake_build has these functions:
#
#   train_brake_configure_target(target)              C++17, warnings, reproducible arithmetic, sanitizers
#   train_brake_add_package_library(lib...)           the package's own library: src/*.cpp and include/, installed, with
#                                                     the tests in test/ and the fuzz targets in fuzz/; uses lib...
#   train_brake_add_archive(target)                   the library's objects once more, as the archive target_static
#   train_brake_add_gtests(file... LIBRARIES lib...)  one GoogleTest executable per file
#   train_brake_add_fuzz_targets(file... LIBRARIES lib...)  one fuzz target per file

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  # CMake's Release is -O3 -DNDEBUG.
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type: Release, RelWithDebInfo or Debug" FORCE)
endif()

# std::from_chars and std::to_chars for double, __builtin_bit_cast: GCC has them since version 11.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 11)
  message(FATAL_ERROR "${CMAKE_CXX_COMPILER} is GCC ${CMAKE_CXX_COMPILER_VERSION}; train_brake needs GCC 11 or newer. "
    "Choose another compiler by -DCMAKE_CXX_COMPILER=PATH in a new build folder.")
endif()

option(TRAIN_BRAKE_WARNINGS_AS_ERRORS "Stop at compiler warnings" ON)
set(TRAIN_BRAKE_SANITIZE "" CACHE STRING "Sanitizers: empty, \"address,undefined\" or \"thread\"")
option(TRAIN_BRAKE_FUZZ "Build the fuzz targets as fuzzers, not as tests (needs clang)" OFF)

function(train_brake_configure_target target)
  set_target_properties(${target} PROPERTIES
    CXX_STANDARD 17 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    # Laws are written over lanes, whose conditions know & and | only.
    $<$<CXX_COMPILER_ID:Clang>:-Wno-bitwise-instead-of-logical>
    # The same bits on every target: no multiply-add where the source does not ask for one.
    -ffp-contract=off
    # errno is never read, so sqrt is one instruction.
    -fno-math-errno
    # Functions of a shared library may be inlined into each other.
    -fno-semantic-interposition)
  if(TRAIN_BRAKE_SANITIZE)
    # Warnings stay warnings here: instrumented code confuses the compiler's flow analysis.
    set(sanitize -fsanitize=${TRAIN_BRAKE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_compile_options(${target} PRIVATE ${sanitize} -g1)  # lines in reports, no variables
    target_compile_definitions(${target} PRIVATE TRAIN_BRAKE_SANITIZED)
    target_link_libraries(${target} ${sanitize})
  elseif(TRAIN_BRAKE_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# A test named foo_test.cpp becomes the target <package>_foo_test (target names are unique in a workspace).
# Tests find the top-level config folder as TRAIN_BRAKE_CONFIG_DIR.
function(train_brake_add_gtests)
  cmake_parse_arguments(arg "" "" "LIBRARIES" ${ARGN})
  get_filename_component(config_dir ${PROJECT_SOURCE_DIR}/../../config ABSOLUTE)
  if(TARGET GTest::gtest_main)
    set(gtest_main GTest::gtest_main)
  else()
    set(gtest_main ${GTEST_MAIN_LIBRARIES})
  endif()
  foreach(source ${arg_UNPARSED_ARGUMENTS})
    get_filename_component(stem ${source} NAME_WE)
    set(target ${PROJECT_NAME}_${stem})
    catkin_add_gtest(${target} ${source})
    target_link_libraries(${target} ${arg_LIBRARIES} ${gtest_main})
    target_compile_definitions(${target} PRIVATE TRAIN_BRAKE_CONFIG_DIR="${config_dir}")
    train_brake_configure_target(${target})
  endforeach()
endfunction()

# A file foo_fuzz.cpp becomes the target <package>_foo_fuzz: with TRAIN_BRAKE_FUZZ a fuzzer, part of the target fuzzers
# (tools/fuzz.sh runs them), else a test that runs it over the files in fuzz/corpus/foo.
function(train_brake_add_fuzz_targets)
  cmake_parse_arguments(arg "" "" "LIBRARIES" ${ARGN})
  if(NOT TRAIN_BRAKE_FUZZ)
    train_brake_add_gtests(${arg_UNPARSED_ARGUMENTS} LIBRARIES ${arg_LIBRARIES})
  elseif(NOT TARGET fuzzers)
    add_custom_target(fuzzers)
  endif()
  foreach(source ${arg_UNPARSED_ARGUMENTS})
    get_filename_component(stem ${source} NAME_WE)
    set(target ${PROJECT_NAME}_${stem})
    if(TRAIN_BRAKE_FUZZ)
      add_executable(${target} ${source})
      target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/../train_brake_build/fuzz)
      add_dependencies(fuzzers ${target})
      target_link_libraries(${target} ${arg_LIBRARIES} -fsanitize=fuzzer)
      get_filename_component(config_dir ${PROJECT_SOURCE_DIR}/../../config ABSOLUTE)
      target_compile_definitions(${target} PRIVATE TRAIN_BRAKE_CONFIG_DIR="${config_dir}")
      train_brake_configure_target(${target})
    else()
      string(REGEX REPLACE "_fuzz$" "" name ${stem})
      target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/../train_brake_build/fuzz)
      target_sources(${target} PRIVATE ${PROJECT_SOURCE_DIR}/../train_brake_build/fuzz/replay.cpp)
      target_compile_definitions(${target} PRIVATE TRAIN_BRAKE_CORPUS="${PROJECT_SOURCE_DIR}/fuzz/corpus/${name}")
    endif()
  endforeach()
endfunction()

# The objects of a library once more as an archive, target_static, for programs that have it in themselves.
function(train_brake_add_archive target)
  add_library(${target}_static STATIC $<TARGET_OBJECTS:${target}>)
  set_target_properties(${target}_static PROPERTIES LINKER_LANGUAGE CXX)
  install(TARGETS ${target}_static ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
endfunction()

# After catkin_package(). A macro, because catkin's functions read variables of the package.
macro(train_brake_add_package_library)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.cpp)
  add_library(${PROJECT_NAME} ${sources})
  if(catkin_EXPORTED_TARGETS)
    add_dependencies(${PROJECT_NAME} ${catkin_EXPORTED_TARGETS})
  endif()
  target_include_directories(${PROJECT_NAME} PUBLIC include)
  target_include_directories(${PROJECT_NAME} SYSTEM PUBLIC ${catkin_INCLUDE_DIRS})
  target_link_libraries(${PROJECT_NAME} ${catkin_LIBRARIES} ${ARGN})
  train_brake_configure_target(${PROJECT_NAME})

  install(TARGETS ${PROJECT_NAME}
    ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
    LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  )
  install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})

  if(CATKIN_ENABLE_TESTING)
    file(GLOB tests CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/test/*_test.cpp)
    train_brake_add_gtests(${tests} LIBRARIES ${PROJECT_NAME})
    file(GLOB fuzz_targets CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/fuzz/*_fuzz.cpp)
    if(fuzz_targets)
      train_brake_add_fuzz_targets(${fuzz_targets} LIBRARIES ${PROJECT_NAME})
    endif()
  endif()
endmacro()
