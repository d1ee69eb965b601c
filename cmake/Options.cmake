# Every option of the build, in one place.

option(XTRACK_WITH_OPENCV "Recordings on disk (reading and writing images); off: computation only" ON)
option(XTRACK_WITH_HIGHWAY "SIMD kernels with run-time dispatch; off: scalar kernels" ON)
option(XTRACK_WITH_TOOLS "The xtrack command" ${XTRACK_WITH_OPENCV})
option(XTRACK_WITH_TESTS "Unit and functional tests" ${PROJECT_IS_TOP_LEVEL})
option(XTRACK_WITH_BENCHMARKS "Google Benchmark programs" OFF)
option(XTRACK_LIBFUZZER "The parsers' fuzz entry as a libFuzzer program (clang++ only)" OFF)
option(XTRACK_DEVELOPER "Warnings are errors" OFF)
option(BUILD_SHARED_LIBS "Shared libraries instead of static ones" OFF)
set(XTRACK_SANITIZE "" CACHE STRING "Sanitizers to build everything with, e.g. address;undefined")

# Parts with hardware or outside libraries behind them. Each is a folder; as long as this version
# has no such folder its option is off, and asking for it is refused rather than ignored.
function(xtrack_part_option name folder what)
  if(EXISTS ${PROJECT_SOURCE_DIR}/${folder}/CMakeLists.txt)
    option(${name} "${what}" ON)
    return()
  endif()
  option(${name} "${what} (not part of this version)" OFF)
  if(${name})
    message(FATAL_ERROR "${name}=ON: ${what} is not part of xTrack ${PROJECT_VERSION} "
                        "(${folder} is missing); configure with -D${name}=OFF")
  endif()
endfunction()

xtrack_part_option(XTRACK_WITH_CALIBRATION core/calibrate "calibration of camera and projector")
xtrack_part_option(XTRACK_WITH_V4L2 core/capture/v4l2 "live cameras over V4L2")
xtrack_part_option(XTRACK_WITH_PROJECTOR core/project "the pattern window on a projector")
xtrack_part_option(XTRACK_WITH_HID gestures/hid "the virtual HID device")
xtrack_part_option(XTRACK_WITH_BINDINGS bindings "the C and Python bindings")

if(XTRACK_WITH_TOOLS AND NOT XTRACK_WITH_OPENCV)
  message(FATAL_ERROR "XTRACK_WITH_TOOLS=ON needs XTRACK_WITH_OPENCV=ON: the command reads and "
                      "writes images; configure with -DXTRACK_WITH_TOOLS=OFF")
endif()
