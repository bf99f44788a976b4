# Tests of the repository as a whole, of what is installed, and of the samples.

wr_script(stock_files stock.sh repository ${PROJECT_SOURCE_DIR})
set_tests_properties(stock_files PROPERTIES SKIP_RETURN_CODE 77)
wr_script(rooms rooms.sh repository ${PROJECT_SOURCE_DIR})
wr_script(system system.sh repository ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR})
wr_script(flatpak flatpak.sh repository ${PROJECT_SOURCE_DIR})
wr_script(desktop desktop.sh repository ${PROJECT_SOURCE_DIR})
wr_script(fixed_paths fixed_paths.sh repository ${PROJECT_SOURCE_DIR})
wr_script(headers headers.sh repository ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR})
wr_script(format format.sh repository ${PROJECT_SOURCE_DIR})
wr_script(arguments arguments.sh repository ${PROJECT_SOURCE_DIR})
wr_script(shape shape.sh repository ${PROJECT_SOURCE_DIR})
wr_script(prose prose.sh repository ${PROJECT_SOURCE_DIR})
wr_script(shell shell.sh repository ${PROJECT_SOURCE_DIR})
wr_script(words_source words.sh repository ${PROJECT_SOURCE_DIR})
wr_script(messages messages.sh repository ${PROJECT_SOURCE_DIR})
wr_script(start start.sh repository ${PROJECT_SOURCE_DIR})
if(NOT WR_SANITIZE)
    wr_script(symbols symbols.sh repository ${CMAKE_BINARY_DIR})
    string(COMPARE EQUAL "${WR_SANITIZE}${CMAKE_BUILD_TYPE}" "RelWithDebInfo" fortified)
    wr_script(hardened hardened.sh repository ${CMAKE_BINARY_DIR} $<BOOL:${fortified}>)
endif()

if(TARGET wrinkle)
    wr_script(papers papers.sh repository ${PROJECT_SOURCE_DIR})
    wr_script(readme readme.sh repository ${PROJECT_SOURCE_DIR} $<TARGET_FILE:wrinkle>)
    wr_script(install install.sh repository ${CMAKE_BINARY_DIR})
    wr_script(packages_source packages_source.sh repository ${PROJECT_SOURCE_DIR})
    if(NOT WR_SANITIZE)
        wr_script(packages packages.sh slow ${PROJECT_SOURCE_DIR} $<TARGET_FILE:wrinkle>)
        wr_script(aarch64 aarch64.sh slow ${PROJECT_SOURCE_DIR} $<TARGET_FILE:wrinkle> ${CMAKE_CURRENT_BINARY_DIR}/aarch64)
        set_tests_properties(packages PROPERTIES TIMEOUT 5400 SKIP_RETURN_CODE 77)
        set_tests_properties(aarch64 PROPERTIES TIMEOUT 28800 SKIP_RETURN_CODE 77) # samples took 5 to 14 times as long in QEMU
    endif()
    wr_script(known_normals known_normals.sh repository $<TARGET_FILE:wrinkle> ${PROJECT_SOURCE_DIR})

    add_executable(golden ${CMAKE_CURRENT_LIST_DIR}/golden.c)
    target_link_libraries(golden PRIVATE wr_image)
    target_compile_definitions(golden PRIVATE WR_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                               WR_BINARY_DIR="${CMAKE_BINARY_DIR}")
    add_dependencies(golden wrinkle)
    # Every sample is run, and compared with its picture where there is one; a new one is seen by the
    # folder's time.
    file(GLOB samples RELATIVE ${PROJECT_SOURCE_DIR}/samples ${PROJECT_SOURCE_DIR}/samples/*.wrinkle)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/samples
                 ${CMAKE_CURRENT_LIST_DIR}/golden)
    foreach(sample ${samples})
        get_filename_component(name ${sample} NAME_WE)
        wr_script(sample_${name} sample.sh repository ${PROJECT_SOURCE_DIR}/samples/${sample}
                 $<TARGET_FILE:wrinkle>)
        if(EXISTS ${CMAKE_CURRENT_LIST_DIR}/golden/${name}.exr)
            add_test(NAME golden_${name} COMMAND golden ${name})
            set_tests_properties(golden_${name} PROPERTIES LABELS golden)
        endif()
    endforeach()
endif()

# Mutations: `check` compares the tables with the source; `run` breaks each line in a build of its own, which takes
# minutes. hard_rows prints single rows of the hard cases for them.
add_executable(hard_rows ${CMAKE_CURRENT_LIST_DIR}/hard_rows.c)
target_link_libraries(hard_rows PRIVATE wr_hardcases)
foreach(table mutations mutations_files mutations_plan)
    wr_script(${table} mutate.sh repository ${PROJECT_SOURCE_DIR} check ${table}.txt)
    if(table STREQUAL "mutations" OR NOT WR_SANITIZE)
        wr_script(${table}_run mutate.sh slow ${PROJECT_SOURCE_DIR} run ${CMAKE_CURRENT_BINARY_DIR}/${table} ${table}.txt)
        set_tests_properties(${table}_run PROPERTIES TIMEOUT 3600 RUN_SERIAL ON)
    endif()
endforeach()

# Tables that stand beside others: does the compiler stop at one that lacks a row?
wr_script(table_rows table_rows.sh repository ${PROJECT_SOURCE_DIR} check)
if(TARGET wr_ui)
    wr_script(table_rows_run table_rows.sh slow ${PROJECT_SOURCE_DIR} run ${CMAKE_BINARY_DIR}
              ${CMAKE_CURRENT_BINARY_DIR}/table_rows)
    wr_script(recipes recipes.sh heavy ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR} ${CMAKE_CURRENT_BINARY_DIR}/recipes)
    set_tests_properties(table_rows_run recipes PROPERTIES TIMEOUT 600)
endif()
wr_script(outside outside.sh repository ${PROJECT_SOURCE_DIR})
wr_script(reproducible reproducible.sh slow ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/reproducible)
set_tests_properties(outside PROPERTIES TIMEOUT 1200)
