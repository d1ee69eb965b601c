# arm64 Linux from Debian: g++-aarch64-linux-gnu, and libraries by multiarch (libhwy-dev:arm64 and
# so on), which live beside those of the host. Programs run under qemu-user.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
find_program(XTRACK_QEMU qemu-aarch64)
if(XTRACK_QEMU)
  # The C library of libc6:arm64, not the cross compiler's own older copy, whose thread creation
  # hangs under qemu.
  set(CMAKE_CROSSCOMPILING_EMULATOR ${XTRACK_QEMU} -L /)
endif()
