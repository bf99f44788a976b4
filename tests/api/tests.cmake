wr_script(c_library guide_programs.sh repository ${CMAKE_BINARY_DIR} ${PROJECT_SOURCE_DIR})
wr_script(python python.sh repository ${CMAKE_BINARY_DIR} ${PROJECT_SOURCE_DIR})
