# SPDX-License-Identifier: Apache-2.0
# The arrows between the rooms as the link lists draw them; layering.cmake checks the same arrows among the sources.

# Targets of ours that a target of a room may link, as `room:target`. What has no room (settings) is for all, and tests link
# what they like.
set(link_model "^model:")
set(link_hal "^hal:")
set(link_firmware "^(firmware|model|hal):")
# tools/interface
set(link_interface "^(interface|model):|^firmware:hotfire_image$")
set(link_tools "^(tools|interface|model):|^hal:hotfire_hal(_sim|_recording|_live|_schedule)?$")

function(targets_below folder result)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(subfolders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(subfolder IN LISTS subfolders)
    targets_below(${subfolder} further)
    list(APPEND targets ${further})
  endforeach()
  set(${result} ${targets} PARENT_SCOPE)
endfunction()

# The first folder of the tree that a target is defined in; empty for the root and for what is not ours.
function(room_of target result)
  set(room "")
  get_target_property(folder ${target} SOURCE_DIR)
  cmake_path(IS_PREFIX PROJECT_SOURCE_DIR "${folder}" ours)
  get_target_property(imported ${target} IMPORTED)
  if(ours AND NOT imported)
    file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${folder})
    string(REGEX REPLACE "^tools/interface" "interface" folder "${folder}")
    string(REGEX MATCH "^[^/]+" room "${folder}")
  endif()
  set(${result} "${room}" PARENT_SCOPE)
endfunction()

# Called when every target is known: a link against the arrows ends the configuration.
function(check_link_arrows)
  foreach(folder model hal firmware tools)
    targets_below(${PROJECT_SOURCE_DIR}/${folder} targets)
    foreach(target IN LISTS targets)
      room_of(${target} room)
      foreach(property LINK_LIBRARIES INTERFACE_LINK_LIBRARIES)
        get_target_property(linked ${target} ${property})
        string(REGEX REPLACE "\\$<[A-Z_]+:([^<>]*)>" "\\1" linked "${linked}")
        foreach(library IN LISTS linked)
          if(TARGET ${library})
            room_of(${library} other)
            if(other AND NOT "${other}:${library}" MATCHES "${link_${room}}")
              message(FATAL_ERROR "${target} of ${room}/ links ${library} of ${other}/, against the arrows between the folders "
                "(see docs/architecture.md)")
            endif()
          endif()
        endforeach()
      endforeach()
    endforeach()
  endforeach()
endfunction()
