# Flags for our own code only; libraries are included as SYSTEM.
set(LUMIBOX_SANITIZE "" CACHE STRING "Sanitizers, e.g. address,undefined or thread")
# The build type of the sanitizer presets: assertions on, and lines enough to read a report.
set(CMAKE_CXX_FLAGS_SANITIZED "-O1 -g1")

find_program(CCACHE ccache)
if(CCACHE)
  # Without this it refuses files that use precompiled headers.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

add_library(lumibox_flags INTERFACE)
target_compile_options(lumibox_flags INTERFACE -Wall -Wextra -Wconversion -Wshadow -Werror)
# GCC 12 sees overlaps in string concatenations and unset members in Eigen's inlined code that are
# not there (its bugs 105651 and 105562).
target_compile_options(lumibox_flags INTERFACE -Wno-restrict -Wno-maybe-uninitialized)
# Floating-point contraction differs between compilers and machines; results must not.
target_compile_options(lumibox_flags INTERFACE -ffp-contract=off -fno-math-errno)
if(LUMIBOX_SANITIZE)
  target_compile_options(lumibox_flags INTERFACE -fsanitize=${LUMIBOX_SANITIZE} -fno-omit-frame-pointer
                                                 -fno-sanitize-recover=undefined)
  # Sanitizer instrumentation confuses GCC's flow analysis of Eigen's inlined code.
  target_compile_options(lumibox_flags INTERFACE -Wno-error=array-bounds)
  target_link_options(lumibox_flags INTERFACE -fsanitize=${LUMIBOX_SANITIZE})
endif()
