# cmake --install DIR --prefix PREFIX: the program, its scenarios, and the libraries as a CMake package.
include(CMakePackageConfigHelpers)
set(PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/beamgyro)

# Components: runtime, dev (what names none), python.
install(TARGETS beamgyro RUNTIME COMPONENT runtime)
install(DIRECTORY scenarios specs DESTINATION ${CMAKE_INSTALL_DATADIR}/beamgyro COMPONENT runtime)
# What `beamgyro plot` runs.
install(DIRECTORY python/beamgyro/plots DESTINATION ${CMAKE_INSTALL_DATADIR}/beamgyro/python/beamgyro
  COMPONENT runtime USE_SOURCE_PERMISSIONS FILES_MATCHING PATTERN *.py PATTERN __pycache__ EXCLUDE)
install(FILES README.md CITATION.cff THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime FILES_MATCHING REGEX "[.](md|png|svg)$")
install(DIRECTORY ${BEAMGYRO_HELP_PAGES}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT runtime)
install(DIRECTORY ${BEAMGYRO_HELP_PAGES}/completions DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion
  COMPONENT runtime)

install(DIRECTORY include/beamgyro DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})  # no header of the rooms
install(EXPORT beamgyroTargets NAMESPACE beamgyro:: DESTINATION ${PACKAGE_DIR})
configure_package_config_file(cmake/beamgyroConfig.cmake.in ${PROJECT_BINARY_DIR}/beamgyroConfig.cmake
  INSTALL_DESTINATION ${PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/beamgyroConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/beamgyroConfig.cmake ${PROJECT_BINARY_DIR}/beamgyroConfigVersion.cmake
  DESTINATION ${PACKAGE_DIR})

# beamgyro.pc, for pkg-config: all static libraries, in a group, since it knows no order.
get_property(LIBRARY_FLAGS GLOBAL PROPERTY BEAMGYRO_LIBRARIES)
list(TRANSFORM LIBRARY_FLAGS PREPEND -l)
list(JOIN LIBRARY_FLAGS " " LIBRARY_FLAGS)
set(PKGCONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH PREFIX_FROM_PKGCONFIG /p/${PKGCONFIG_DIR} /p)
string(REGEX REPLACE "/$" "" PREFIX_FROM_PKGCONFIG ${PREFIX_FROM_PKGCONFIG})
configure_file(cmake/beamgyro.pc.in ${PROJECT_BINARY_DIR}/beamgyro.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/beamgyro.pc DESTINATION ${PKGCONFIG_DIR})
