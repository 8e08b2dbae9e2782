# SPDX-License-Identifier: Apache-2.0
# A house of empty rooms, linked rightly and then wrongly: the configuration of the wrong one must fail.
cmake_minimum_required(VERSION 3.25)

# configure(LINKS status text): a scratch project with a target in every room, and LINKS.
function(configure links status text)
  file(REMOVE_RECURSE ${SCRATCH})
  set(rooms "")
  foreach(room model hal firmware tools)
    file(WRITE ${SCRATCH}/${room}/CMakeLists.txt "add_library(hotfire_${room} INTERFACE)\n")
    string(APPEND rooms "add_subdirectory(${room})\n")
  endforeach()
  file(APPEND ${SCRATCH}/hal/CMakeLists.txt "add_library(hotfire_hal_sim INTERFACE)\nadd_library(hotfire_hal_linux INTERFACE)\n")
  file(WRITE ${SCRATCH}/tools/interface/CMakeLists.txt "add_library(hotfire_interface INTERFACE)\n")
  file(APPEND ${SCRATCH}/tools/CMakeLists.txt "add_subdirectory(interface)\n")
  file(WRITE ${SCRATCH}/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nproject(rooms LANGUAGES NONE)\n${rooms}"
    "${links}\ninclude(${ROOT}/tools/style/link_arrows.cmake)\ncheck_link_arrows()\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SCRATCH} -B ${SCRATCH}/build
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  set(${status} ${result} PARENT_SCOPE)
  set(${text} "${output}" PARENT_SCOPE)
endfunction()

function(expect_wrong links words)
  configure("${links}" status text)
  string(FIND "${text}" "${words}" position)
  if(status EQUAL 0 OR position EQUAL -1)
    message(SEND_ERROR "'${links}': expected '${words}', got status ${status}: ${text}")
  endif()
endfunction()

configure("target_link_libraries(hotfire_firmware INTERFACE hotfire_model hotfire_hal_linux)
  target_link_libraries(hotfire_tools INTERFACE hotfire_model hotfire_hal_sim)" status text)
if(NOT status EQUAL 0)
  message(SEND_ERROR "the right arrows: ${text}")
endif()
expect_wrong("target_link_libraries(hotfire_model INTERFACE hotfire_hal)" "hotfire_model of model/ links hotfire_hal of hal/")
expect_wrong("target_link_libraries(hotfire_hal_sim INTERFACE hotfire_model)" "links hotfire_model of model/")
expect_wrong("target_link_libraries(hotfire_firmware INTERFACE hotfire_tools)" "links hotfire_tools of tools/")
expect_wrong("target_link_libraries(hotfire_tools INTERFACE hotfire_firmware)" "links hotfire_firmware of firmware/")
expect_wrong("target_link_libraries(hotfire_tools INTERFACE $<LINK_ONLY:hotfire_hal_linux>)" "links hotfire_hal_linux of hal/")
expect_wrong("target_link_libraries(hotfire_interface INTERFACE hotfire_tools)" "links hotfire_tools of tools/")
