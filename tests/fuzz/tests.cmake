# Fuzzers: built and run for some seconds where clang and its libFuzzer are installed (package clang and
# libclang-rt-*-dev). For a longer run: BUILD-FOLDER/fuzz_NAME -max_total_time=600.
# They have sanitizers of their own, so sanitized builds do without, whose rooms cannot be linked with clang's.
if(WR_SANITIZE)
    return()
endif()
find_program(WR_CLANG NAMES clang clang-14 clang-15 clang-16)
set(fuzz_flags -std=c17 -g -O1 -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all)
if(WR_CLANG AND NOT DEFINED WR_HAVE_FUZZER)
    set(try ${CMAKE_BINARY_DIR}/try_fuzzer.c)
    file(WRITE ${try} "int LLVMFuzzerTestOneInput(const unsigned char *data, unsigned long size);\n"
                      "int LLVMFuzzerTestOneInput(const unsigned char *data, unsigned long size)\n"
                      "{\n    return size > 1000000 && data[0];\n}\n")
    execute_process(COMMAND ${WR_CLANG} ${fuzz_flags} ${try} -o ${CMAKE_BINARY_DIR}/try_fuzzer
                    RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(failed EQUAL 0)
        set(WR_HAVE_FUZZER ON CACHE INTERNAL "clang can build fuzzers")
    else()
        set(WR_HAVE_FUZZER OFF CACHE INTERNAL "clang can build fuzzers")
    endif()
endif()

# wr_fuzz(NAME SOURCES... [ROOMS rooms] [LIBRARIES flags]): tests/fuzz/fuzz_NAME.c with the sources that it
# exercises, by paths from src/, built for fuzzing; rooms are linked as they are.
function(wr_fuzz name)
    cmake_parse_arguments(FUZZ "" "" "ROOMS;LIBRARIES" ${ARGN})
    if(NOT WR_CLANG OR NOT WR_HAVE_FUZZER)
        return()
    endif()
    list(TRANSFORM FUZZ_UNPARSED_ARGUMENTS PREPEND ${PROJECT_SOURCE_DIR}/src/
         OUTPUT_VARIABLE sources)
    set(targets wr_system)
    set(rooms "")
    foreach(room ${FUZZ_ROOMS})
        list(APPEND rooms $<TARGET_FILE:wr_${room}>)
        list(APPEND targets wr_${room})
    endforeach()
    file(GLOB headers ${PROJECT_SOURCE_DIR}/src/*/*.h)
    set(program ${CMAKE_BINARY_DIR}/fuzz_${name})
    add_custom_command(OUTPUT ${program}
        COMMAND ${WR_CLANG} ${fuzz_flags} -D_GNU_SOURCE -I${PROJECT_SOURCE_DIR}/src -I${PROJECT_SOURCE_DIR}/tests
                ${CMAKE_CURRENT_LIST_DIR}/fuzz_${name}.c ${sources}
                ${rooms} $<TARGET_FILE:wr_system> ${FUZZ_LIBRARIES} -lxxhash -lmd -lm -o ${program}
        DEPENDS ${CMAKE_CURRENT_LIST_DIR}/fuzz_${name}.c ${sources} ${headers} ${targets} VERBATIM)
    add_custom_target(fuzz_${name} ALL DEPENDS ${program})
    # four seconds; forty with WR_FULL
    add_test(NAME fuzz_${name} COMMAND bash -c "exec \"$0\" \"$@\" -max_total_time=4\${WR_FULL:+0}" ${program}
                                       -seed=1 -runs=100000 -max_len=2000 -artifact_prefix=${CMAKE_BINARY_DIR}/fuzz_${name}-)
    set_tests_properties(fuzz_${name} PROPERTIES LABELS fuzz)
endfunction()

wr_fuzz(journal document/recovery_journal.c document/recovery_lines.c document/recover.c base/error.c base/message.c
        base/cpu.c base/file.c base/hash.c base/memory.c base/progress.c base/text.c)

set(tip_sources brush/tip.c base/error.c base/message.c base/exactmath.c
    base/memory.c base/text.c)
wr_fuzz(gbr ${tip_sources} LIBRARIES -lsleef)
wr_fuzz(gih ${tip_sources} LIBRARIES -lsleef)

wr_fuzz(font image/font_load.c image/font_outline.c base/error.c base/message.c base/memory.c base/text.c
        LIBRARIES ${SHAPING_CFLAGS} -lfreetype -lharfbuzz -lfribidi -lz)

wr_fuzz(exr image/exr.c base/cpu.c base/error.c base/message.c base/file.c base/hash.c base/memory.c base/pool.c base/progress.c base/text.c
        LIBRARIES -isystem ${EXR_FOLDER} ${EXR_CORE} -ldeflate)

wr_fuzz(raw generate/terrain_raw.c base/error.c base/message.c base/memory.c base/progress.c base/text.c)

set(image_libraries -lOpenEXRCore -ldeflate -lfreetype -lharfbuzz -lfribidi -lfontconfig -lpng16 -lz -lsleef)
# Through the reader process, whose library may crash where the program must not.
wr_fuzz(mesh ROOMS image base LIBRARIES ${image_libraries} -ljson-c -ldl -lpthread)
wr_fuzz(commands command/parse.c command/value.c command/scene_args.c
        ROOMS command export accuracy render document generate brush scene shade surface noise image field
              base
        LIBRARIES -lmypaint ${image_libraries} -ljson-c -lzip -lexpat -ldl -lpthread)
wr_fuzz(myb brush/mypaint_engine.c brush/preset.c
        ROOMS brush surface image field base LIBRARIES -lmypaint ${image_libraries} -ljson-c -ldl -lpthread)
