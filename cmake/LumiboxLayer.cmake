# lumibox_layer(NAME layer SOURCES ... [USES lumibox targets ...] [LIBRARIES public libs ...]
#               [PRIVATE_LIBRARIES libs ...] [FOLDER folder] [COLD])
#
# Makes the static library lumibox_<layer>. Headers are included as "<folder>/name.h"; the include
# path of a target holds nothing but a link to its own folder, so a folder that is not among USES
# (or theirs) cannot be included at all. That is what keeps the layers in order.
# A COLD layer computes little and is compiled for a quick build.
function(lumibox_layer)
  cmake_parse_arguments(L "COLD" "NAME;FOLDER" "SOURCES;USES;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  if(NOT L_FOLDER)
    set(L_FOLDER ${L_NAME})
  endif()
  set(view ${CMAKE_BINARY_DIR}/layers/${L_FOLDER})
  file(MAKE_DIRECTORY ${view})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${L_FOLDER} ${view}/${L_FOLDER} SYMBOLIC)

  set(target lumibox_${L_NAME})
  add_library(${target} STATIC ${L_SOURCES})
  target_include_directories(${target} PUBLIC ${view})
  target_link_libraries(${target} PUBLIC ${L_USES} ${L_LIBRARIES}
                                  PRIVATE lumibox_flags ${L_PRIVATE_LIBRARIES})
  target_precompile_headers(${target} REUSE_FROM lumibox_precompiled)
  if(L_COLD)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
endfunction()
