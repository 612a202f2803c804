# Writes a header that says what this build is made from: cmake -D SOURCE=… -D OUTPUT=… … -P write_build_info.cmake
#
# Runs at every build, so that the header tells the sources as they are compiled and not as they were configured, and
# touches its output only when the text changes. Works without git and outside a checkout.

cmake_minimum_required(VERSION 3.25)

# What decides a run's numbers: a method, the metrics, and what executes them, each with the headers that it includes and
# what these declare. An edit of a report template, of the command line or of another method leaves recorded runs usable.
file(
  GLOB units
  RELATIVE ${SOURCE}
  ${SOURCE}/methods/*/*.cpp ${SOURCE}/experiments/metrics/*.cpp ${SOURCE}/experiments/execute.cpp
  ${SOURCE}/experiments/gpu_run.cpp ${SOURCE}/experiments/procedural_exemplars.cpp)
list(FILTER units EXCLUDE REGEX "^methods/base/")
list(SORT units)
set(followed
    "^(methods/|gpu/|experiments/metrics/|experiments/(execute|frame_timing|gpu_run|pictures|procedural_exemplars|shader_models)\\.)"
)
# A source whose first line of all includes is a header of its folder defines what that header declares.
file(
  GLOB_RECURSE bodies
  RELATIVE ${SOURCE}
  ${SOURCE}/methods/*.cpp ${SOURCE}/gpu/*.cpp ${SOURCE}/experiments/*.cpp)
foreach(body IN LISTS bodies)
  file(STRINGS ${SOURCE}/${body} first LIMIT_COUNT 1 REGEX "^#include ")
  if(first MATCHES "^#include \"([^\"]*)\"")
    set(header ${CMAKE_MATCH_1})
    get_filename_component(folder ${body} DIRECTORY)
    if(header MATCHES "^${folder}/[^/]*$")
      list(APPEND bodies_of_${header} ${body})
    endif()
  endif()
endforeach()

# The shaders are part of what their loader declares.
file(
  GLOB shaders
  RELATIVE ${SOURCE}
  ${SOURCE}/gpu/shaders/*.glsl)
list(APPEND bodies_of_gpu/shader_source.h ${shaders})

# Files that `file` leads to by itself, in `next_<file>`, and its hash, in `hash_<file>`.
macro(read_source file)
  if(NOT DEFINED hash_${file})
    file(SHA256 ${SOURCE}/${file} hash_${file})
    file(STRINGS ${SOURCE}/${file} lines REGEX "^#include \"")
    set(next_${file} ${bodies_of_${file}})
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include \"([^\"]*)\".*" "\\1" included "${line}")
      if(included MATCHES "${followed}" AND EXISTS ${SOURCE}/${included})
        list(APPEND next_${file} ${included})
      endif()
    endforeach()
  endif()
endmacro()

set(source_versions "")
foreach(unit IN LISTS units)
  set(reached "")
  set(ahead ${unit})
  while(ahead)
    list(POP_FRONT ahead file)
    if(NOT file IN_LIST reached)
      list(APPEND reached ${file})
      read_source(${file})
      list(APPEND ahead ${next_${file}})
    endif()
  endwhile()
  list(SORT reached)
  set(listing "")
  foreach(file IN LISTS reached)
    string(APPEND listing "${hash_${file}} ${file}\n")
  endforeach()
  string(SHA256 version "${listing}")
  string(SUBSTRING ${version} 0 16 version)
  string(REGEX REPLACE "\\.cpp$" "" unit ${unit})
  string(APPEND source_versions "    {\"${unit}\", \"${version}\"},\n")
endforeach()

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
        COMMAND ${GIT} -C ${SOURCE} ls-files --others --exclude-standard -- cmake configs experiments gpu methods paper_figures
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

#include <string_view>

namespace textonbench::build_info {

inline constexpr const char* version = \"${VERSION}\";
inline constexpr const char* git_commit = \"${git_commit}\";
inline constexpr const char* git_state = \"${git_state}\";
inline constexpr const char* compiler = \"${COMPILER}\";
inline constexpr const char* flags = R\"flags(${FLAGS})flags\";
inline constexpr const char* build_type = \"${BUILD_TYPE}\";
struct SourceVersion {
  std::string_view path, version;
};
inline constexpr SourceVersion source_versions[] = {
${source_versions}};
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
