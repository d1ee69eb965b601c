# Windows, 64 bit, from Debian: packages g++-mingw-w64-x86-64-posix (the threads of C++ need the
# posix variant).
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# Headers only, so the host's serve.
set(Eigen3_DIR /usr/share/eigen3/cmake CACHE PATH "")
# Programs carry GCC's libraries with them.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static")
