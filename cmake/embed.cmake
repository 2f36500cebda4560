# Embeds text files into the program. Included by CMakeLists.txt it adds the report's page and D3 to the library; run as a
# script (cmake -P) it writes the source, one raw string a file.
if(CMAKE_SCRIPT_MODE_FILE)
    set(text "// Written by cmake/embed.cmake.\n#include <string_view>\n\n#include \"report_parts.h\"\n\nnamespace pellucid::report_parts {\n\n")
    string(REPLACE "|" ";" pairs "${EMBED}")
    file(WRITE ${OUTPUT} "${text}")
    foreach(pair IN LISTS pairs)
        string(REGEX MATCH "^([^=]+)=(.+)$" matched "${pair}")
        file(READ "${CMAKE_MATCH_2}" content)
        file(APPEND ${OUTPUT} "const std::string_view ${CMAKE_MATCH_1} = R\"=embed=(")
        file(APPEND ${OUTPUT} "${content}")
        file(APPEND ${OUTPUT} ")=embed=\";\n")
    endforeach()
    file(APPEND ${OUTPUT} "\n}  // namespace pellucid::report_parts\n")
    return()
endif()

# D3 draws the curves: Debian's node-d3, which is version 5 (libjs-d3 is version 3 and lacks half of what is used).
find_file(PELLUCID_D3 d3.min.js PATHS /usr/share/nodejs/d3/dist NO_DEFAULT_PATH
          DOC "d3.min.js of version 5, embedded in report.html")
if(NOT PELLUCID_D3)
    message(FATAL_ERROR "d3.min.js is missing: install the package node-d3, or configure with -DPELLUCID_D3=FILE")
endif()

function(pellucid_embed_report target)
    set(folder ${PROJECT_SOURCE_DIR}/src/study/report)
    set(output ${PROJECT_BINARY_DIR}/embedded/report_parts.cpp)
    set(files kHead=${folder}/head.html kTemplate=${folder}/template.html kStyle=${folder}/report.css kD3=${PELLUCID_D3}
              kCharts=${folder}/charts.js kViewer=${folder}/viewer.js kTables=${folder}/tables.js
              kTuneTemplate=${folder}/tune.html kTune=${folder}/tune.js)
    set(sources ${files})
    list(TRANSFORM sources REPLACE "^[^=]+=" "")
    list(JOIN files "|" embed)
    add_custom_command(OUTPUT ${output}
                       COMMAND ${CMAKE_COMMAND} "-DEMBED=${embed}" -DOUTPUT=${output}
                               -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
                       DEPENDS ${sources} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
                       COMMENT "Embedding the report's page" VERBATIM)
    target_sources(${target} PRIVATE ${output})
    # Strings of any length: both compilers take them, the standard does not promise it.
    set_source_files_properties(${output} PROPERTIES INCLUDE_DIRECTORIES ${PROJECT_SOURCE_DIR}/src/study
                                                     COMPILE_OPTIONS -Wno-overlength-strings)
endfunction()
