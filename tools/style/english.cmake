# SPDX-License-Identifier: Apache-2.0
# Checks that pages and messages use the standard terms: no word of the lists below. The build runs it; by hand:
#   cmake -D ROOT=$PWD -P tools/style/english.cmake
# Pages are checked outside of code, which shows names and what a program prints. Messages, help and the pages that a program
# writes are checked as string literals of the sources; docstrings outside of code as well.
cmake_minimum_required(VERSION 3.25)

# A word and what to write in its place.
set(replaced
  "stood|was, were"
  "lacking|missing"
  "mended|fixed, corrected"
  "mending|correction"
  "house|layers, folders"
  "at the soonest|at least, not before"
  "let go|released"
  "who only|to ... only"
  "whoever|anyone who"
  "told|identified, reported, known"
  "tell|identify, distinguish, separate"
  "tells|identifies, reports, shows"
  "stand|be, represent"
  "stands|is, represents"
  "lack|is missing in"
  "lacks|is missing in"
  "mend|fix, correct, remedy"
  "mends|fixes, corrects"
  "goes no faster|limited speed"
  "however much|at most"
  "is asked of|is required of"
  "untold|not identified, not known"
  "telling|identifying, which reports"
  "configures with|configure with"
  "for good|permanent"
  "anew|again"
  "rooms|folders"
  "looked for|searched for, checked"
  "be had|be available"
  "midst|middle, within"
  "asks of|requires of"
  "turned round|reversed, exchanged"
  "looks on|watches"
  "blamed|attributed, caused by")

set(pages README.md CONTRIBUTING.md CHANGELOG.md examples/README.md)
file(GLOB_RECURSE found RELATIVE ${ROOT} ${ROOT}/docs/*.md)
list(APPEND pages ${found})
# Pages that a program writes.
list(FILTER pages EXCLUDE REGEX "^docs/(findings/.*|findings|performance)\\.md$")

function(fault file number word instead line)
  string(STRIP "${line}" line)
  set_property(GLOBAL APPEND_STRING PROPERTY faults "\n  ${file}:${number}: '${word}', write: ${instead}\n    ${line}")
endfunction()

# Lines of a file without what CMake takes for a list, and whether a word of the lists is anywhere in it.
function(read_lines file words result)
  file(READ ${ROOT}/${file} text)
  string(TOLOWER "${text}" text)
  set(${result} "" PARENT_SCOPE)
  if(text MATCHES "(^|[^a-z0-9_])(${words})([^a-z0-9_]|$)")
    string(REPLACE "\\\"" "'" text "${text}")
    string(REPLACE "'\"'" "' '" text "${text}")
    string(REGEX REPLACE "[][;\\]" " " text "${text}")
    string(REGEX REPLACE "\n" " ;" text "${text}")
    set(${result} "${text}" PARENT_SCOPE)
  endif()
endfunction()

# check_line(FILE NUMBER TEXT REPLACED): a fault for each word of the list in the text.
function(check_line file number text replaced)
  foreach(pair IN LISTS replaced)
    string(REGEX MATCH "^([^|]*)[|](.*)$" matched "${pair}")
    set(word "${CMAKE_MATCH_1}")
    set(instead "${CMAKE_MATCH_2}")
    if(text MATCHES "(^|[^a-z0-9_])${word}([^a-z0-9_]|$)")
      fault(${file} ${number} "${word}" "${instead}" "${text}")
    endif()
  endforeach()
endfunction()

function(words_of replaced result)
  list(TRANSFORM replaced REPLACE "[|].*$" "")
  list(JOIN replaced "|" words)
  set(${result} "${words}" PARENT_SCOPE)
endfunction()

words_of("${replaced}" words)
foreach(page IN LISTS pages)
  read_lines(${page} "${words}" lines)
  set(number 0)
  set(in_code FALSE)
  foreach(line IN LISTS lines)
    math(EXPR number "${number} + 1")
    if(line MATCHES "^ *```")
      if(in_code)
        set(in_code FALSE)
      else()
        set(in_code TRUE)
      endif()
    elseif(NOT in_code AND NOT line MATCHES "^<!--")
      string(REGEX REPLACE "`[^`]*`" "`...`" line "${line}")
      check_line(${page} ${number} "${line}" "${replaced}")
    endif()
  endforeach()
endforeach()

set(sources "")
foreach(folder model hal firmware tools examples)
  foreach(pattern *.hpp *.h *.c *.cpp *.js *.py)
    file(GLOB_RECURSE found RELATIVE ${ROOT} ${ROOT}/${folder}/${pattern})
    list(APPEND sources ${found})
  endforeach()
endforeach()
# Scripts have no ending.
file(GLOB_RECURSE found RELATIVE ${ROOT} ${ROOT}/tools/*)
list(FILTER found INCLUDE REGEX "^([^.]*/)?[^./]+$")
list(APPEND sources ${found})
foreach(source IN LISTS sources)
  read_lines(${source} "${words}" lines)
  set(number 0)
  foreach(line IN LISTS lines)
    math(EXPR number "${number} + 1")
    # A docstring, also one behind a member, and the comments of a C header; else string literals.
    set(docstring "")
    if(line MATCHES "///(.*)$")
      set(docstring "${CMAKE_MATCH_1}")
    elseif(source MATCHES "[.]h$" AND line MATCHES "^ */?[*]")
      set(docstring "${line}")
    endif()
    if(NOT docstring STREQUAL "")
      string(REGEX REPLACE "`[^`]*`" "`...`" docstring "${docstring}")
      string(REGEX REPLACE "\"[^\"]*\"" "'...'" docstring "${docstring}")
      check_line(${source} ${number} "${docstring}" "${replaced}")
    elseif(line MATCHES "\"" AND NOT line MATCHES "^ *//")
      string(REGEX MATCHALL "\"[^\"]*\"" literals "${line}")
      check_line(${source} ${number} "${literals}" "${replaced}")
    endif()
  endforeach()
endforeach()

get_property(faults GLOBAL PROPERTY faults)
if(faults)
  message(FATAL_ERROR "words that have a standard term (tools/style/english.cmake has the list):${faults}")
endif()
