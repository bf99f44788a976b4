# Each language's .po becomes the .mo that the window reads, where gettext's msgfmt is there; without it the window speaks
# English. msgfmt refuses a translation of a format whose arguments are others than the English one's.
find_program(MSGFMT msgfmt)
if(MSGFMT)
    foreach(language de fr)
        set(po ${CMAKE_CURRENT_LIST_DIR}/${language}.po)
        set(mo ${CMAKE_BINARY_DIR}/locale/${language}/LC_MESSAGES/wrinkle.mo)
        add_custom_command(
            OUTPUT ${mo}
            COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/locale/${language}/LC_MESSAGES
            COMMAND ${MSGFMT} --check -o ${mo} ${po}
            DEPENDS ${po}
            VERBATIM)
        list(APPEND words ${mo})
        install(FILES ${mo} DESTINATION ${CMAKE_INSTALL_DATADIR}/locale/${language}/LC_MESSAGES)
    endforeach()
    add_custom_target(words ALL DEPENDS ${words})
    add_dependencies(wr_ui words)
else()
    message(STATUS "The window is only in English: msgfmt is missing (Debian: gettext)")
endif()
