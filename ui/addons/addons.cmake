# wr_addon(PROGRAM FILES...): the files of the folder PROGRAM as wrinkle-PROGRAM.zip, which that program installs. Copied
# first: the source folder may hold Python's caches, and Krita wants entries of folders too.
function(wr_addon program)
    set(place ${CMAKE_BINARY_DIR}/addons/${program})
    set(zip ${CMAKE_BINARY_DIR}/wrinkle-${program}.zip)
    foreach(file ${ARGN})
        configure_file(ui/addons/${program}/${file} ${place}/${file} COPYONLY)
    endforeach()
    list(TRANSFORM ARGN PREPEND ${place}/ OUTPUT_VARIABLE copies)
    list(TRANSFORM ARGN REPLACE "/.*" "" OUTPUT_VARIABLE entries)
    list(REMOVE_DUPLICATES entries)
    add_custom_command(
        OUTPUT ${zip}
        COMMAND ${CMAKE_COMMAND} -E tar cf ${zip} --format=zip -- ${entries}
        WORKING_DIRECTORY ${place}
        DEPENDS ${copies}
        VERBATIM)
    add_custom_target(${program}_addon ALL DEPENDS ${zip})
    install(FILES ${zip} DESTINATION ${CMAKE_INSTALL_DATADIR}/wrinkle/addons)
endfunction()

wr_addon(blender wrinkle_blender/__init__.py wrinkle_blender/compat.py wrinkle_blender/link.py wrinkle_blender/mapset.py
         wrinkle_blender/material.py wrinkle_blender/meshes.py wrinkle_blender/panel.py wrinkle_blender/program.py
         wrinkle_blender/watch.py)
wr_addon(krita wrinkle_krita.desktop wrinkle_krita/__init__.py wrinkle_krita/exchange.py wrinkle_krita/extension.py)
