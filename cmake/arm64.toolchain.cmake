# Debian's cross compiler and libraries for 64-bit ARM boards: packages crossbuild-essential-arm64
# and those of scripts/packages.txt as PACKAGE:arm64. scripts/build-arm64 makes a place that has them.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(ENV{PKG_CONFIG_LIBDIR} /usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig)
set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
# Notes on how GCC before 10.1 passed arguments.
set(CMAKE_CXX_FLAGS_INIT -Wno-psabi)

# Tests run on the emulated processor, where there is one.
find_program(QEMU_AARCH64 qemu-aarch64-static)
if(QEMU_AARCH64)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${QEMU_AARCH64})
endif()
