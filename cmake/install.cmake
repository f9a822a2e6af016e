# cmake --install DIR --prefix PREFIX: the program, its scenarios, and the libraries as a CMake package.
include(CMakePackageConfigHelpers)
set(NO_CACHES PATTERN __pycache__ EXCLUDE PATTERN .*_cache EXCLUDE)

# Components: runtime, dev, python; debian_dev and debian_lib are those of the packages libbeamgyro-dev and libbeamgyro0.1.
install(TARGETS beamgyro RUNTIME COMPONENT runtime)
install(DIRECTORY scenarios specs examples DESTINATION ${CMAKE_INSTALL_DATADIR}/beamgyro COMPONENT runtime
  USE_SOURCE_PERMISSIONS ${NO_CACHES})
# The scripts that the pages tell users to run; the others work on the sources.
install(PROGRAMS scripts/flight_log_to_csv.py scripts/slurm_generate.sh
  DESTINATION ${CMAKE_INSTALL_DATADIR}/beamgyro/scripts COMPONENT runtime)
# What `beamgyro plot` runs.
install(DIRECTORY python/beamgyro/plots DESTINATION ${CMAKE_INSTALL_DATADIR}/beamgyro/python/beamgyro
  COMPONENT runtime USE_SOURCE_PERMISSIONS FILES_MATCHING PATTERN *.py ${NO_CACHES})
# The pages, and what they link to, in the same places as in the sources.
install(FILES README.md CHANGELOG.md CITATION.cff CONTRIBUTING.md LICENSE THIRD_PARTY.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
install(DIRECTORY docs bench DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime
  FILES_MATCHING REGEX "[.](md|png|svg|toml)$" PATTERN site EXCLUDE)
install(DIRECTORY ${BEAMGYRO_HELP_PAGES}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT runtime)
install(DIRECTORY ${BEAMGYRO_HELP_PAGES}/completions DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion
  COMPONENT runtime)

write_basic_package_version_file(${PROJECT_BINARY_DIR}/beamgyroConfigVersion.cmake COMPATIBILITY SameMinorVersion)
get_property(LIBRARIES GLOBAL PROPERTY BEAMGYRO_LIBRARIES)
# For pkg-config: all static libraries, in a group, since it knows no order.
list(TRANSFORM LIBRARIES PREPEND -l OUTPUT_VARIABLE LIBRARY_FLAGS)
list(JOIN LIBRARY_FLAGS " " LIBRARY_FLAGS)

# install_library(<component> <component of the shared library> <library folder>): headers, libraries, and what find_package and pkg-config read.
function(install_library component shared_component library_dir)
  set(options COMPONENT ${component} ${ARGN})
  set(made ${PROJECT_BINARY_DIR}/${component})
  set(package_dir ${library_dir}/cmake/beamgyro)
  install(DIRECTORY include/beamgyro DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${options})  # no header of the rooms
  install(TARGETS ${LIBRARIES} beamgyro_api EXPORT ${component}
    ARCHIVE DESTINATION ${library_dir} ${options})
  install(TARGETS beamgyro_shared EXPORT ${component}_shared
    LIBRARY DESTINATION ${library_dir} COMPONENT ${shared_component} NAMELINK_COMPONENT ${component} ${ARGN})
  install(EXPORT ${component} FILE beamgyroTargets.cmake NAMESPACE beamgyro:: DESTINATION ${package_dir} ${options})
  install(EXPORT ${component}_shared FILE beamgyroSharedTarget.cmake NAMESPACE beamgyro::
    DESTINATION ${package_dir} ${options})
  configure_package_config_file(cmake/beamgyroConfig.cmake.in ${made}/beamgyroConfig.cmake
    INSTALL_DESTINATION ${package_dir})
  install(FILES ${made}/beamgyroConfig.cmake ${PROJECT_BINARY_DIR}/beamgyroConfigVersion.cmake
    DESTINATION ${package_dir} ${options})
  file(RELATIVE_PATH PREFIX_FROM_PKGCONFIG /p/${library_dir}/pkgconfig /p)
  string(REGEX REPLACE "/$" "" PREFIX_FROM_PKGCONFIG ${PREFIX_FROM_PKGCONFIG})
  foreach(module beamgyro beamgyro-shared)
    configure_file(cmake/${module}.pc.in ${made}/${module}.pc @ONLY)
    install(FILES ${made}/${module}.pc DESTINATION ${library_dir}/pkgconfig ${options})
  endforeach()
endfunction()
install_library(dev dev ${CMAKE_INSTALL_LIBDIR})
# GNUInstallDirs has this folder for the prefix /usr only, which cpack sets later.
install_library(debian_dev debian_lib lib/${CMAKE_LIBRARY_ARCHITECTURE} EXCLUDE_FROM_ALL)
