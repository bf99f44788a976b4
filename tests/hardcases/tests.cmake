wr_test(hardcases hardcases command LABEL heavy)
wr_test(hardcases_dials hardcases command LABEL heavy)
pkg_check_modules(TEST_JSON REQUIRED IMPORTED_TARGET json-c)
target_link_libraries(run_hardcases_command PRIVATE PkgConfig::TEST_JSON)
