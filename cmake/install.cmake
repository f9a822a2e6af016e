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

# Everything at once. The name of the program is taken within this build.
add_library(beamgyro_everything INTERFACE)
set_target_properties(beamgyro_everything PROPERTIES EXPORT_NAME beamgyro)
target_link_libraries(beamgyro_everything INTERFACE
  beamgyro_report beamgyro_sensitivity beamgyro_validation beamgyro_compensation beamgyro_campaign beamgyro_set)
install(TARGETS beamgyro_everything EXPORT beamgyroTargets)

foreach(room parallel random config dataset sim compensation planning validation sensitivity report)
  install(DIRECTORY ${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/beamgyro FILES_MATCHING PATTERN *.h)
endforeach()
install(DIRECTORY include/beamgyro DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})  # C headers, under their own names
install(EXPORT beamgyroTargets NAMESPACE beamgyro:: DESTINATION ${PACKAGE_DIR})
configure_package_config_file(cmake/beamgyroConfig.cmake.in ${PROJECT_BINARY_DIR}/beamgyroConfig.cmake
  INSTALL_DESTINATION ${PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/beamgyroConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/beamgyroConfig.cmake ${PROJECT_BINARY_DIR}/beamgyroConfigVersion.cmake
  DESTINATION ${PACKAGE_DIR})
