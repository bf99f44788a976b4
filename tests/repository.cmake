# Tests of the repository as a whole, of what is installed, and of the samples.

# wr_check(NAME SCRIPT ARGUMENTS...): a shell script of this folder as a test.
function(wr_check name script)
    add_test(NAME ${name} COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/${script} ${ARGN})
    set_tests_properties(${name} PROPERTIES LABELS repository)
endfunction()

wr_check(rooms rooms.sh ${PROJECT_SOURCE_DIR})
wr_check(system system.sh ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR})
wr_check(headers headers.sh ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR})
wr_check(format format.sh ${PROJECT_SOURCE_DIR})
wr_check(arguments arguments.sh ${PROJECT_SOURCE_DIR})
wr_check(shape shape.sh ${PROJECT_SOURCE_DIR})
wr_check(prose prose.sh ${PROJECT_SOURCE_DIR})
wr_check(shell shell.sh ${PROJECT_SOURCE_DIR})
wr_check(words_source words.sh ${PROJECT_SOURCE_DIR})
wr_check(messages messages.sh ${PROJECT_SOURCE_DIR})
wr_check(start start.sh ${PROJECT_SOURCE_DIR})
if(NOT WR_SANITIZE)
    wr_check(symbols symbols.sh ${CMAKE_BINARY_DIR})
    string(COMPARE EQUAL "${WR_SANITIZE}${CMAKE_BUILD_TYPE}" "RelWithDebInfo" fortified)
    wr_check(hardened hardened.sh ${CMAKE_BINARY_DIR} $<BOOL:${fortified}>)
endif()

if(TARGET wrinkle)
    wr_check(papers papers.sh ${PROJECT_SOURCE_DIR})
    wr_check(readme readme.sh ${PROJECT_SOURCE_DIR} $<TARGET_FILE:wrinkle>)
    wr_check(install install.sh ${CMAKE_BINARY_DIR})
    wr_check(known_normals known_normals.sh $<TARGET_FILE:wrinkle> ${PROJECT_SOURCE_DIR})
    wr_check(accuracy accuracy.sh ${PROJECT_SOURCE_DIR} $<TARGET_FILE:wrinkle>)
    set_tests_properties(accuracy PROPERTIES TIMEOUT 1500)

    add_executable(golden golden.c)
    target_link_libraries(golden PRIVATE wr_image)
    target_compile_definitions(golden PRIVATE WR_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                               WR_BINARY_DIR="${CMAKE_BINARY_DIR}")
    add_dependencies(golden wrinkle)
    # Every sample is run, and compared with its picture where there is one; a new one is seen by the
    # folder's time.
    file(GLOB samples RELATIVE ${PROJECT_SOURCE_DIR}/samples ${PROJECT_SOURCE_DIR}/samples/*.wrinkle)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/samples
                 ${CMAKE_CURRENT_SOURCE_DIR}/golden)
    foreach(sample ${samples})
        get_filename_component(name ${sample} NAME_WE)
        wr_check(sample_${name} sample.sh ${PROJECT_SOURCE_DIR}/samples/${sample}
                 $<TARGET_FILE:wrinkle>)
        if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/golden/${name}.exr)
            add_test(NAME golden_${name} COMMAND golden ${name})
            set_tests_properties(golden_${name} PROPERTIES LABELS golden)
        endif()
    endforeach()
endif()
