# For tangents_blender.sh.
add_executable(tangents_dump EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/tangents_dump.c)
target_link_libraries(tangents_dump PRIVATE wr_command)
