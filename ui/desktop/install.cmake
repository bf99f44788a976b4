# What `cmake --install` puts where, but for the program and its modules, which their rooms install. The
# program finds its data under ../share/wrinkle beside its own folder, and its modules likewise, so the
# whole can be moved.
set(desktop ${CMAKE_CURRENT_LIST_DIR})

install(DIRECTORY ${PROJECT_SOURCE_DIR}/samples DESTINATION ${CMAKE_INSTALL_DATADIR}/wrinkle
        PATTERN CMakeLists.txt EXCLUDE)
# The guide, which the window shows, where its links to the samples lead on.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/ui/guide DESTINATION ${CMAKE_INSTALL_DATADIR}/wrinkle/ui
        PATTERN "*.sh" EXCLUDE)
if(EXISTS ${PROJECT_SOURCE_DIR}/brushes)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/brushes DESTINATION ${CMAKE_INSTALL_DATADIR}/wrinkle
            PATTERN "*.py" EXCLUDE)
endif()
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/LICENSE
        DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_file(${desktop}/wrinkle.1 ${CMAKE_BINARY_DIR}/wrinkle.1 @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/wrinkle.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${desktop}/wrinkle.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(FILES ${desktop}/org.wrinkle.Wrinkle.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo)
install(FILES ${desktop}/wrinkle-mime.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages
        RENAME wrinkle.xml)

set(icons ${CMAKE_INSTALL_DATADIR}/icons/hicolor)
install(FILES ${PROJECT_SOURCE_DIR}/ui/icon.svg DESTINATION ${icons}/scalable/apps
        RENAME wrinkle.svg)
foreach(size 16 32 48 64 128 256) # drawn by icons.sh
    install(FILES ${desktop}/icons/wrinkle-${size}.png DESTINATION ${icons}/${size}x${size}/apps RENAME wrinkle.png)
endforeach()

include(ui/addons/addons.cmake)
