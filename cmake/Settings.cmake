set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

if(PROJECT_IS_TOP_LEVEL)
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo" FORCE)
  endif()
  find_program(XTRACK_CCACHE ccache)
  if(XTRACK_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${XTRACK_CCACHE})
  endif()
endif()

# The order matters to the linker only, but everything in the build must agree on these.
if(XTRACK_SANITIZE)
  string(REPLACE ";" "," sanitizers "${XTRACK_SANITIZE}")
  add_compile_options(-fsanitize=${sanitizers} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${sanitizers})
endif()

# What every target of ours is compiled with. There is no -march: the libraries run on every
# x86-64, and kernels that gain from more choose at run time.
function(xtrack_settings target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON
                                             CXX_VISIBILITY_PRESET default)
  # GCC 12 warns falsely of overlap in std::string's operator+ (its bug 105651); 13 does not.
  # Contraction into fused multiply-adds would give other bits on arm64 than on x86-64.
  target_compile_options(
    ${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow -ffp-contract=off
                      $<$<CXX_COMPILER_ID:Clang>:-Wthread-safety>
                      $<$<STREQUAL:$<CXX_COMPILER_ID>$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>,GNU1>:-Wno-restrict>
                      $<$<BOOL:${XTRACK_DEVELOPER}>:-Werror>)
endfunction()
