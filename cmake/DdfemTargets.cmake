# Compiler settings that every target of this project shares.
add_library(ddfem_options INTERFACE)
target_compile_options(ddfem_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
# GCC 12 reports overlapping copies and uninitialised characters inside std::string that cannot happen (GCC bugs 105651,
# 105562).
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(ddfem_options INTERFACE -Wno-restrict -Wno-error=maybe-uninitialized)
endif()
if(DDFEM_WARNINGS_AS_ERRORS)
  target_compile_options(ddfem_options INTERFACE -Werror)
endif()
if(DDFEM_SANITIZE)
  target_compile_options(ddfem_options INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer
                                                -fno-sanitize-recover=all)
  target_link_options(ddfem_options INTERFACE -fsanitize=address,undefined)
endif()

# ddfem_module(NAME): library ddfem_NAME (alias ddfem::NAME) from every .cc below the current folder, except those
# given after EXCLUDE. The include root is the repository, so that `#include "dd/network/network.h"` works.
function(ddfem_module name)
  cmake_parse_arguments(arg "" "" "EXCLUDE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cc)
  if(arg_EXCLUDE)
    list(REMOVE_ITEM sources ${arg_EXCLUDE})
  endif()
  add_library(ddfem_${name} STATIC ${sources})
  add_library(ddfem::${name} ALIAS ddfem_${name})
  target_link_libraries(ddfem_${name} PRIVATE ddfem_options)
endfunction()

# Every header of the folder must compile on its own: one generated translation unit per header.
function(ddfem_check_headers name)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.h)
  set(units)
  foreach(header ${headers})
    string(REPLACE "/" "_" unit ${header})
    set(unit ${CMAKE_CURRENT_BINARY_DIR}/header_checks/${unit}.cc)
    file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${header})
    file(CONFIGURE OUTPUT ${unit} CONTENT "#include \"${path}\"\n")
    list(APPEND units ${unit})
  endforeach()
  add_library(ddfem_${name}_headers OBJECT EXCLUDE_FROM_ALL ${units})
  target_link_libraries(ddfem_${name}_headers PRIVATE ddfem_${name} ddfem_options)
  target_compile_options(ddfem_${name}_headers PRIVATE -O0) # only whether they compile is asked
endfunction()
