# Writes OUT: source_commit() of host/cli/source_commit.hpp for the repository at ROOT. Touches it only when it changes.
execute_process(COMMAND git -C ${ROOT} describe --always --dirty --abbrev=12 --exclude=* OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
execute_process(COMMAND git -C ${ROOT} rev-parse --show-toplevel OUTPUT_VARIABLE top ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
file(REAL_PATH ${ROOT} root)
if(failed OR NOT top STREQUAL root) # no git, no repository, or another one around an unpacked archive
  set(commit "")
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#include \"host/cli/source_commit.hpp\"\nconst char* clvr::source_commit() { return \"${commit}\"; }\n")
