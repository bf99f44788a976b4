if(WR_SYSTEM_FORM STREQUAL "linux")
    wr_test(sandbox base sandbox OWN)
    target_link_libraries(test_sandbox PRIVATE PkgConfig::SECCOMP)
endif()
