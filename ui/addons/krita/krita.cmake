# wrinkle_krita.zip, for Krita's "Import Python Plugin from File". Copied first: the source folder may hold Python's caches.
set(plugin ${CMAKE_CURRENT_LIST_DIR})
set(plugin_files wrinkle_krita.desktop wrinkle_krita/__init__.py wrinkle_krita/exchange.py wrinkle_krita/extension.py)
foreach(file ${plugin_files})
    configure_file(${plugin}/${file} ${CMAKE_BINARY_DIR}/krita/${file} COPYONLY)
endforeach()
set(plugin_zip ${CMAKE_BINARY_DIR}/wrinkle_krita.zip)
list(TRANSFORM plugin_files PREPEND ${CMAKE_BINARY_DIR}/krita/ OUTPUT_VARIABLE plugin_copies)
add_custom_command(
    OUTPUT ${plugin_zip}
    COMMAND ${CMAKE_COMMAND} -E tar cf ${plugin_zip} --format=zip wrinkle_krita.desktop wrinkle_krita
    WORKING_DIRECTORY ${CMAKE_BINARY_DIR}/krita
    DEPENDS ${plugin_copies}
    VERBATIM)
add_custom_target(krita_plugin ALL DEPENDS ${plugin_zip})
install(FILES ${plugin_zip} DESTINATION ${CMAKE_INSTALL_DATADIR}/wrinkle/addons)
