# Writes OUTPUT with the git revision of SOURCE_DIR, touching it only on a change.
find_package(Git QUIET)
set(revision "unknown")
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} describe --always --dirty --abbrev=12
    WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE described RESULT_VARIABLE failed
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(revision "${described}")
  endif()
endif()
set(text "#include \"api/program_version.h\"\n\nconst char* const beamgyro::internal::kGitRevision = \"${revision}\";\n")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} present)
endif()
if(NOT "${text}" STREQUAL "${present}")
  file(WRITE ${OUTPUT} "${text}")
endif()
