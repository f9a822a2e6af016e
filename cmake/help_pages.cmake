# The manual pages and the completion of bash, made from the help of the program that was built.
set(BEAMGYRO_HELP_PAGES ${PROJECT_BINARY_DIR}/help_pages)
file(MAKE_DIRECTORY ${BEAMGYRO_HELP_PAGES}/man1 ${BEAMGYRO_HELP_PAGES}/completions)
find_program(BEAMGYRO_PYTHON_PROGRAM NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)

set(MAKER ${PROJECT_SOURCE_DIR}/packaging/help_pages.py)
set(COMMANDS ${PROJECT_SOURCE_DIR}/docs/reference/commands.md)
add_custom_command(OUTPUT ${BEAMGYRO_HELP_PAGES}/completions/beamgyro
  COMMAND ${BEAMGYRO_PYTHON_PROGRAM} ${MAKER} $<TARGET_FILE:beamgyro> ${COMMANDS} ${BEAMGYRO_HELP_PAGES}
  DEPENDS beamgyro ${MAKER} ${PROJECT_SOURCE_DIR}/packaging/completion.bash ${COMMANDS}
  COMMENT "Making the manual pages" VERBATIM)
if(NOT BEAMGYRO_SANITIZE)
  add_custom_target(beamgyro_help_pages ALL DEPENDS ${BEAMGYRO_HELP_PAGES}/completions/beamgyro)
endif()
