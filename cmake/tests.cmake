# One GoogleTest program a label, from tests/<label>/*_test.cpp, and the consumer of the installed package.
# The slow label is built, so that it cannot rot, but ctest knows it only under PELLUCID_SLOW_TESTS.
find_package(GTest REQUIRED)
include(GoogleTest)
set(PELLUCID_SHARED_SCENES "${PROJECT_SOURCE_DIR}/../shared/scenes" CACHE PATH
    "Scenes with references that some tests use where they are there")

foreach(label unit statistical analytic golden slow)
    file(GLOB sources CONFIGURE_DEPENDS tests/${label}/*_test.cpp)
    if(NOT sources)
        continue()
    endif()
    set(program ${label}_tests)
    add_executable(${program} ${sources})
    set_target_properties(${program} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
    target_link_libraries(${program} PRIVATE pellucid GTest::gtest_main fmt::fmt nlohmann_json::nlohmann_json)
    target_compile_definitions(${program} PRIVATE
        PELLUCID_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
        PELLUCID_SHARED_SCENES="${PELLUCID_SHARED_SCENES}"
        PELLUCID_BINARY="${PROJECT_BINARY_DIR}/pellucid")
    pellucid_configure(${program})
    # Link time is not optimised here: the objects' own machine code gives the same bits and links in a second.
    target_link_options(${program} PRIVATE $<$<BOOL:${PELLUCID_LTO}>:-fno-lto>)
    if(TARGET pellucid_cli)
        add_dependencies(${program} pellucid_cli)
    endif()
    if(label STREQUAL "slow")
        set(timeout 3600)
    else()
        set(timeout 600)
    endif()
    if(NOT label STREQUAL "slow" OR PELLUCID_SLOW_TESTS)
        gtest_discover_tests(${program} DISCOVERY_MODE PRE_TEST TEST_PREFIX "${label}."
                             WORKING_DIRECTORY ${PROJECT_BINARY_DIR} PROPERTIES LABELS ${label} TIMEOUT ${timeout})
    endif()
endforeach()

# A program outside the build, against the installed package. Instrumented builds would need their flags there too.
if(EXISTS ${PROJECT_SOURCE_DIR}/tests/consumer/CMakeLists.txt AND NOT PELLUCID_SANITIZE AND NOT PELLUCID_COVERAGE)
    add_test(NAME consumer
             COMMAND ${CMAKE_COMMAND} -DBUILD_DIR=${PROJECT_BINARY_DIR} -DSOURCE_DIR=${PROJECT_SOURCE_DIR}/tests/consumer
                     -DGENERATOR=${CMAKE_GENERATOR} -DCOMPILER=${CMAKE_CXX_COMPILER} -DCONFIG=$<CONFIG>
                     -P ${PROJECT_SOURCE_DIR}/tests/consumer/run.cmake)
    set_tests_properties(consumer PROPERTIES LABELS package TIMEOUT 600)
endif()

# The report of a small comparison in headless Chromium; skipped where that is missing.
if(TARGET pellucid_cli)
    add_test(NAME report COMMAND bash ${PROJECT_SOURCE_DIR}/tests/report/check_report.sh --make $<TARGET_FILE:pellucid_cli>
                                 ${PROJECT_SOURCE_DIR}/scenes/ring.glb)
    set_tests_properties(report PROPERTIES LABELS report TIMEOUT 600 SKIP_RETURN_CODE 77)
    # Kills at random moments, no memory, a full disk. By hand 50 kills; here as many as a default run has time for.
    add_test(NAME faults COMMAND bash ${PROJECT_SOURCE_DIR}/tests/faults/kill_test.sh $<TARGET_FILE:pellucid_cli>
                                 ${PROJECT_SOURCE_DIR}/scenes/ring.glb 12)
    set_tests_properties(faults PROPERTIES LABELS faults TIMEOUT 600)
endif()

# The fuzz targets without libFuzzer: their seeds, and changes of them that are the same each time. `./run fuzz` searches.
file(GLOB sources CONFIGURE_DEPENDS tests/fuzz/*_fuzz.cpp)
foreach(source ${sources})
    cmake_path(GET source STEM target)
    string(REGEX REPLACE "_fuzz$" "" name ${target})
    add_executable(${name}_replay ${source} tests/fuzz/replay.cpp)
    set_target_properties(${name}_replay PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/fuzz)
    target_link_libraries(${name}_replay PRIVATE pellucid)
    pellucid_configure(${name}_replay)
    target_link_options(${name}_replay PRIVATE $<$<BOOL:${PELLUCID_LTO}>:-fno-lto>)
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/fuzz/${name})
    set(changes 10000)
    if(name STREQUAL "environment") # images go through a library with threads of its own
        set(changes 200)
    endif()
    add_test(NAME fuzz.${name} COMMAND ${name}_replay ${PROJECT_SOURCE_DIR}/tests/fuzz/seeds/${name} ${changes}
             WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/fuzz/${name})
    set_tests_properties(fuzz.${name} PROPERTIES LABELS fuzz TIMEOUT 600)
endforeach()
