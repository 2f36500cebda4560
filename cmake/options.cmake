# What can be chosen about a build, and the two functions that give the choice to a target.
option(PELLUCID_TESTS "Build the tests" ON)
option(PELLUCID_SLOW_TESTS "Register the tests labelled slow with ctest (they are built in any case)" OFF)
option(PELLUCID_BENCHMARKS "Build tests/bench with Google Benchmark" OFF)
option(PELLUCID_FUZZ "Build tests/fuzz with libFuzzer (clang only)" OFF)
option(PELLUCID_WERROR "Warnings are errors" OFF)
option(PELLUCID_LTO "Optimise the library and the command as one (g++)" OFF)
option(PELLUCID_NATIVE
       "-march=native: uses the machine's vector units; images differ in the last bits from the portable build" OFF)
option(PELLUCID_STD_THREADS "base/parallel runs on std::jthread instead of TBB (for ThreadSanitizer)" OFF)
option(PELLUCID_FP_TRAPS "Invalid floating-point operations inside parallel bodies end the program" OFF)
set(PELLUCID_SANITIZE "" CACHE STRING "Value of -fsanitize= for everything, e.g. address,undefined or thread")
option(PELLUCID_COVERAGE "Instrument for gcov" OFF)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release or RelWithDebInfo" FORCE)
endif()

# Instrumentation must reach every object of a program, so it is set for the whole directory.
if(PELLUCID_SANITIZE)
    add_compile_options(-fsanitize=${PELLUCID_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        add_compile_options(-Wno-maybe-uninitialized) # false alarms in instrumented std::regex (GCC bug 105562)
    endif()
    add_link_options(-fsanitize=${PELLUCID_SANITIZE})
endif()
if(PELLUCID_COVERAGE)
    add_compile_options(--coverage -fprofile-update=atomic)
    add_link_options(--coverage)
endif()

# Warnings, the processor and the floating-point model.
#
# The portable build asks for x86-64-v2 (SSE4.2, every x86 machine since about 2009) instead of the SSE2 baseline:
# floor, ceil and round become single instructions where the baseline calls libm, and nothing in v2 changes a result.
# v3 would add fused multiply-add, which does.
#
# The image must be the same at any thread count; one binary gives that under every flag here. The portable build
# also switches contraction off, so that g++ and clang, and inlined and called copies of one function, round alike.
# The native build lets the compiler fuse: that is where its last bits differ. -fno-math-errno (sqrt without a call)
# changes no value. -ffast-math is never used: NaN must stay visible to be counted.
function(pellucid_configure target)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
                                             $<$<BOOL:${PELLUCID_WERROR}>:-Werror> -fno-math-errno)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
        target_compile_options(${target} PRIVATE -Wno-restrict) # false alarms on "text" + std::string (GCC bug 105651)
    endif()
    if(PELLUCID_NATIVE)
        target_compile_options(${target} PRIVATE -march=native -ffp-contract=fast)
    else()
        target_compile_options(${target} PRIVATE -ffp-contract=off)
        if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
            target_compile_options(${target} PRIVATE -march=x86-64-v2)
        endif()
    endif()
    target_compile_definitions(${target} PRIVATE $<$<BOOL:${PELLUCID_STD_THREADS}>:PELLUCID_STD_THREADS>
                                                 $<$<BOOL:${PELLUCID_FP_TRAPS}>:PELLUCID_FP_TRAPS>)
endfunction()

# Link-time optimisation for the library and the command. Objects are fat: they hold machine code too, so tests link
# them the quick way and an installed archive serves any compiler.
if(PELLUCID_LTO)
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        message(FATAL_ERROR "PELLUCID_LTO needs g++ (fat objects); configure with -DPELLUCID_LTO=OFF")
    endif()
    # Parallel code generation; CMake's own property would make slim objects.
    set(PELLUCID_LTO_FLAGS -flto=auto -ffat-lto-objects)
endif()
function(pellucid_optimise target)
    target_compile_options(${target} PRIVATE ${PELLUCID_LTO_FLAGS})
    get_target_property(kind ${target} TYPE)
    if(kind STREQUAL "EXECUTABLE" AND PELLUCID_LTO)
        target_link_options(${target} PRIVATE -flto=auto -O3)
    endif()
endfunction()
