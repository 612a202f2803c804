# Writes a header that says what this build is made from: cmake -D SOURCE=… -D OUTPUT=… … -P write_build_info.cmake
#
# Runs at every build, so that the header tells the sources as they are compiled and not as they were configured, and
# touches its output only when the text changes. Works without git and outside a checkout.

# What decides a run's numbers: the methods, the metrics and what executes them. An edit of a report template or of the
# command line leaves recorded runs usable.
file(
  GLOB_RECURSE sources
  RELATIVE ${SOURCE}
  ${SOURCE}/methods/*.h
  ${SOURCE}/methods/*.cpp
  ${SOURCE}/experiments/metrics/*.h
  ${SOURCE}/experiments/metrics/*.cpp)
foreach(name execute pictures procedural_exemplars)
  foreach(extension h cpp)
    if(EXISTS ${SOURCE}/experiments/${name}.${extension})
      list(APPEND sources experiments/${name}.${extension})
    endif()
  endforeach()
endforeach()
list(SORT sources)
set(listing "")
foreach(source IN LISTS sources)
  file(SHA256 ${SOURCE}/${source} hash)
  string(APPEND listing "${hash} ${source}\n")
endforeach()
string(SHA256 code_version "${listing}")
string(SUBSTRING ${code_version} 0 16 code_version)

# A source tree unpacked inside somebody else's checkout has no .git of its own and must not borrow that commit.
set(git_commit unknown)
set(git_state unknown)
set(diff "")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(
    COMMAND ${GIT} -C ${SOURCE} rev-parse --verify HEAD
    OUTPUT_VARIABLE commit
    RESULT_VARIABLE failed
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(git_commit ${commit})
    execute_process(
      COMMAND ${GIT} -C ${SOURCE} --no-optional-locks status --porcelain
      OUTPUT_VARIABLE changes
      RESULT_VARIABLE failed
      OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(NOT failed AND changes STREQUAL "")
      set(git_state clean)
    elseif(NOT failed)
      set(git_state dirty)
      execute_process(
        COMMAND ${GIT} -C ${SOURCE} --no-optional-locks diff --no-color --no-ext-diff HEAD
        OUTPUT_VARIABLE diff
        ERROR_QUIET)
      # Sources that git does not know yet are compiled all the same.
      execute_process(
        COMMAND ${GIT} -C ${SOURCE} ls-files --others --exclude-standard -- cmake configs experiments methods paper_figures
        OUTPUT_VARIABLE untracked
        OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
      string(REPLACE "\n" ";" untracked "${untracked}")
      foreach(file IN LISTS untracked)
        execute_process(
          COMMAND ${GIT} -C ${SOURCE} diff --no-color --no-ext-diff --no-index /dev/null ${file}
          OUTPUT_VARIABLE new_file
          ERROR_QUIET)
        string(APPEND diff "${new_file}")
      endforeach()
    endif()
  endif()
endif()

# The text of a raw string literal must not contain the literal's own end.
string(SHA256 delimiter "${diff}")
string(SUBSTRING ${delimiter} 0 16 delimiter)

set(text
    "// Written by cmake/write_build_info.cmake at each build.
#pragma once

namespace textonbench::build_info {

inline constexpr const char* version = \"${VERSION}\";
inline constexpr const char* code_version = \"${code_version}\";
inline constexpr const char* git_commit = \"${git_commit}\";
inline constexpr const char* git_state = \"${git_state}\";
inline constexpr const char* compiler = \"${COMPILER}\";
inline constexpr const char* flags = R\"flags(${FLAGS})flags\";
inline constexpr const char* build_type = \"${BUILD_TYPE}\";
inline constexpr const char* source_diff = R\"${delimiter}(${diff})${delimiter}\";

}  // namespace textonbench::build_info
")
set(previous "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} previous)
endif()
if(NOT previous STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
