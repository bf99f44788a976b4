# The Blender add-on as a zip that Blender installs from the disk.
set(addon ${CMAKE_CURRENT_LIST_DIR}/wrinkle_blender)
set(zip ${CMAKE_BINARY_DIR}/wrinkle-blender.zip)
set(sources __init__.py compat.py link.py mapset.py material.py meshes.py panel.py program.py watch.py)
set(paths ${sources})
list(TRANSFORM paths PREPEND ${addon}/)
list(TRANSFORM sources PREPEND wrinkle_blender/)
add_custom_command(
    OUTPUT ${zip}
    COMMAND ${CMAKE_COMMAND} -E tar cf ${zip} --format=zip -- ${sources}
    WORKING_DIRECTORY ${CMAKE_CURRENT_LIST_DIR}
    DEPENDS ${paths}
    VERBATIM)
add_custom_target(blender_addon ALL DEPENDS ${zip})
install(FILES ${zip} DESTINATION ${CMAKE_INSTALL_DATADIR}/wrinkle/addons)
