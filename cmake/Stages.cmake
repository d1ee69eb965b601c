# The way of the data. A stage may use itself and the stages before it, nothing else: the order
# here is the one place that says so. check_stages.cmake refuses an include that goes against it.
set(XTRACK_STAGES
    core/base core/pattern core/project core/capture core/sim core/decode core/unwrap core/depth
    core/calibrate core/pipeline
    gestures/segment gestures/track gestures/recognise gestures/session gestures/hid
    gestures/pipeline)

# xtrack_stage(<folder> SOURCES ... [LINK ...])
#
# An object library for one stage, named after its folder (core/decode -> xtrack_core_decode), and
# added to the library of its part (xtrack_core or xtrack_gestures). Sources are relative to the
# stage's folder; LINK names outside libraries that the stage needs.
function(xtrack_stage folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  if(NOT folder IN_LIST XTRACK_STAGES)
    message(FATAL_ERROR "${folder} is not a stage; cmake/Stages.cmake lists them")
  endif()
  string(REPLACE "/" "_" name "xtrack_${folder}")
  string(REGEX REPLACE "/.*" "" part "${folder}")
  add_library(${name} OBJECT ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}
                                             ${PROJECT_SOURCE_DIR}/core/include)
  if(part STREQUAL "gestures")
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/gestures/include)
  endif()
  target_link_libraries(${name} PUBLIC Eigen3::Eigen Threads::Threads ${ARG_LINK})
  xtrack_settings(${name})
  set_property(GLOBAL APPEND PROPERTY XTRACK_${part}_OBJECTS $<TARGET_OBJECTS:${name}>)
  set_property(GLOBAL APPEND PROPERTY XTRACK_${part}_LINK ${ARG_LINK})
endfunction()
