# cpack: the Debian packages beamgyro, libbeamgyro0.1, libbeamgyro-dev and python3-beamgyro; see scripts/package.sh.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME beamgyro)
set(CPACK_PACKAGE_VENDOR "beamgyro")
set(CPACK_PACKAGE_CONTACT "beamgyro authors <beamgyro@users.noreply.github.com>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime debian_lib debian_dev)
if(TARGET _core)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
  GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE gzip)
set(DEBIAN ${PROJECT_SOURCE_DIR}/packaging/debian)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME beamgyro)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "python3:any")  # draws the pictures
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "python3-beamgyro, libbeamgyro-dev")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "python3-h5py, python3-matplotlib")
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "simulator of vibrating-beam piezo gyros with thermal drift
Simulates a vibrating-beam piezoelectric gyro, from its beam, patches, glue and
mount up to the volts at its pin. The output of such a gyro drifts with
temperature. The program trains compensators on what a sensor can measure,
scores them on runs that they never saw, and writes them as C source for
firmware or as parameters of autopilots.

This package has the program with devices, scenarios, campaigns, models and
specifications to run and to copy from, and its documentation.")

# The name of the shared library with the version of its interface, as Debian has it.
set(SHARED_PACKAGE libbeamgyro${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_DEBIAN_LIB_PACKAGE_NAME ${SHARED_PACKAGE})
set(CPACK_DEBIAN_DEBIAN_LIB_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_DEBIAN_LIB_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEBIAN_LIB_PACKAGE_CONTROL_EXTRA ${DEBIAN}/triggers)
set(CPACK_DEBIAN_DEBIAN_LIB_DESCRIPTION "simulator of vibrating-beam piezo gyros - shared library
Simulates a vibrating-beam piezoelectric gyro, from its beam, patches, glue and
mount up to the volts at its pin, and trains and scores compensators of its
thermal drift.

This package has the shared library, for programs that are linked with it.")

set(CPACK_DEBIAN_DEBIAN_DEV_PACKAGE_NAME libbeamgyro-dev)
set(CPACK_DEBIAN_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEBIAN_DEV_PACKAGE_DEPENDS
  "${SHARED_PACKAGE} (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}), libsundials-dev (>= 6.4), libhdf5-dev (>= 1.10), libfmt-dev, libssl-dev (>= 3.0), libdeflate-dev")
set(CPACK_DEBIAN_DEBIAN_DEV_PACKAGE_SUGGESTS "beamgyro, cmake, pkg-config")
set(CPACK_DEBIAN_DEBIAN_DEV_DESCRIPTION "simulator of vibrating-beam piezo gyros - C++ library
Simulates a vibrating-beam piezoelectric gyro, from its beam, patches, glue and
mount up to the volts at its pin, and trains and scores compensators of its
thermal drift.

This package has the headers, the static libraries and the link to the shared
one, what find_package of
CMake and pkg-config read, and the C header of plug-in compensators.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-beamgyro)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
  "python3 (>= 3.11~), python3 (<< 3.12~), python3-numpy, python3-xarray, python3-h5py, python3-h5netcdf")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "beamgyro")  # loads plug-ins; the runs of validate(device=...)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${DEBIAN}/postinst;${DEBIAN}/prerm")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "simulator of vibrating-beam piezo gyros - Python package
Simulates a vibrating-beam piezoelectric gyro, from its beam, patches, glue and
mount up to the volts at its pin, and trains and scores compensators of its
thermal drift.

This package has the module beamgyro for Python 3: runs are datasets of xarray,
any callable is a compensator.")

# What Debian asks of every package, and no other installation has.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_BINARY_DIR}/finish_packages.cmake)
file(CONFIGURE OUTPUT ${CPACK_PRE_BUILD_SCRIPTS} @ONLY CONTENT [[
execute_process(COMMAND "@PROJECT_SOURCE_DIR@/packaging/finish_packages.sh"
  "${CPACK_TEMPORARY_DIRECTORY}" @PROJECT_VERSION@-@CPACK_DEBIAN_PACKAGE_RELEASE@ "@CPACK_PACKAGE_CONTACT@"
  COMMAND_ERROR_IS_FATAL ANY)
]])
include(CPack)
