# cmake --preset package && cmake --build --preset package && cpack --preset package
#
# A Debian package a component. Dependencies on libraries are found by dpkg-shlibdeps.
find_program(GZIP gzip)
set(RELEVO_RELEASE_RFC "Mon, 30 Nov 2026 12:00:00 +0000")
set(components relevo librelevo0 librelevo-dev relevo-data python3-relevo)
set(exact "(= ${PROJECT_VERSION})")
set(CPACK_PACKAGE_VENDOR "The Relevo authors")
set(RELEVO_MAINTAINER "The Relevo authors <relevo@example.org>" CACHE STRING "Who answers for the packages")
set(CPACK_PACKAGE_CONTACT ${RELEVO_MAINTAINER})
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR}/lib)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# relevo_package(<component> SUMMARY <text> TEXT <lines>... [DEPENDS <list>] [RECOMMENDS <list>] [SECTION <word>] [ALL])
function(relevo_package component)
    cmake_parse_arguments(DEB "ALL" "SUMMARY;DEPENDS;RECOMMENDS;SECTION" "TEXT" ${ARGN})
    string(TOUPPER ${component} name)
    list(JOIN DEB_TEXT "\n" text)
    set(values PACKAGE_NAME ${component} DESCRIPTION "${DEB_SUMMARY}\n${text}" PACKAGE_DEPENDS "${DEB_DEPENDS}"
        PACKAGE_RECOMMENDS "${DEB_RECOMMENDS}")
    if(DEB_SECTION)
        list(APPEND values PACKAGE_SECTION ${DEB_SECTION})
    endif()
    if(DEB_ALL)
        list(APPEND values PACKAGE_ARCHITECTURE all PACKAGE_SHLIBDEPS OFF)
    endif()
    while(values)
        list(POP_FRONT values key value)
        set(CPACK_DEBIAN_${name}_${key} "${value}" PARENT_SCOPE)
    endwhile()
endfunction()

relevo_package(relevo
    SUMMARY "terrain and sun: any DEM in the sunlight of a date"
    TEXT "Opens any elevation raster, shows it as the sun lights it at a place, date and"
         "time, and computes shadows, hours of direct sun, horizons and sky views."
         "The window, the command line, manual pages and completions."
    DEPENDS "librelevo0 ${exact}, relevo-data ${exact}"
    RECOMMENDS "libgl1-mesa-dri")
relevo_package(librelevo0
    SUMMARY "terrain and sun: library"
    TEXT "DEMs, figures of sunlight over them, and pictures for other programs, with the"
         "modules that the library and the program load."
    DEPENDS "relevo-data ${exact}, fonts-liberation, tzdata, libegl1, libopengl0 | libgl1"
    RECOMMENDS "libgl1-mesa-dri" SECTION libs)
relevo_package(librelevo-dev
    SUMMARY "terrain and sun: headers of the library and of plugins"
    TEXT "For programs that use the library, and for native effect plugins: headers,"
         "CMake package, pkg-config files and examples."
    DEPENDS "librelevo0 ${exact}" SECTION libdevel)
relevo_package(relevo-data
    SUMMARY "terrain and sun: effects, shaders and data"
    TEXT "Effects, shaders, presets, ground materials, skies, time zones, the climate and"
         "two small DEMs."
    DEPENDS "" ALL)
relevo_package(python3-relevo
    SUMMARY "terrain and sun: Python package"
    TEXT "DEMs, figures of sunlight over them, and pictures as NumPy arrays."
    DEPENDS "librelevo0 ${exact}, python3 (>= 3.9), python3-numpy" RECOMMENDS "python3-rasterio, python3-xarray" SECTION python)
set(CPACK_DEBIAN_RELEVO-DATA_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_LIBRELEVO-DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_PYTHON3-RELEVO_PACKAGE_SHLIBDEPS OFF)

# Programs that are linked later get their dependency from the library's own file.
set(CPACK_DEBIAN_LIBRELEVO0_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_SOURCE_DIR}/debian/triggers
    ${CMAKE_CURRENT_BINARY_DIR}/shlibs)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/shlibs "librelevo 0 librelevo0 (>= ${PROJECT_VERSION})\n")

# Python's files are compiled when they are installed, so that nothing is left when they are removed.
set(CPACK_DEBIAN_PYTHON3-RELEVO_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_SOURCE_DIR}/debian/python3-relevo/postinst
    ${CMAKE_CURRENT_SOURCE_DIR}/debian/python3-relevo/prerm)

# Copyright and changelog of every package.
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/changelog
"relevo (${PROJECT_VERSION}) unstable; urgency=medium

  * Release ${PROJECT_VERSION}; /usr/share/doc/relevo/CHANGELOG.md.gz has what is new.

 -- ${CPACK_PACKAGE_CONTACT}  ${RELEVO_RELEASE_RFC}
")
set(compressed ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz)
if(GZIP)
    file(COPY_FILE ${CMAKE_SOURCE_DIR}/CHANGELOG.md ${CMAKE_CURRENT_BINARY_DIR}/CHANGELOG.md)
    foreach(text changelog CHANGELOG.md)
        execute_process(COMMAND ${GZIP} -9nc ${CMAKE_CURRENT_BINARY_DIR}/${text}
            OUTPUT_FILE ${CMAKE_CURRENT_BINARY_DIR}/${text}.gz)
    endforeach()
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/CHANGELOG.md.gz DESTINATION ${doc})
    foreach(component ${components})
        install(FILES ${CMAKE_CURRENT_SOURCE_DIR}/debian/copyright
            DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${component} COMPONENT ${component})
        install(FILES ${compressed} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${component} COMPONENT ${component})
    endforeach()
endif()
include(CPack)
