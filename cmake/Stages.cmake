# The way of the data. A stage may use itself and the stages before it, nothing else: the order
# here is the one place that says so. check_stages.cmake refuses an include that goes against it.
set(XTRACK_STAGES
    core/base core/pattern core/project core/capture core/sim core/decode core/unwrap core/depth
    core/light core/calibrate core/pipeline
    gestures/segment gestures/track gestures/recognise gestures/session gestures/hid
    gestures/pipeline)

# Which stage a public header <xtrack/NAME.hpp> belongs to. Nouns that several stages share belong
# to the earliest of them. A public header that is missing here fails the build.
set(XTRACK_HEADERS_core/base depth frame geometry image mesh pattern phase_map point_cloud result
                             rig source stamp)
set(XTRACK_HEADERS_core/pattern method pattern_timeline)
set(XTRACK_HEADERS_core/capture null_source recording)
set(XTRACK_HEADERS_core/sim sim)
set(XTRACK_HEADERS_core/decode decode_settings phase_ripple)
set(XTRACK_HEADERS_core/unwrap relative_depth)
set(XTRACK_HEADERS_core/light light_calibration)
set(XTRACK_HEADERS_core/pipeline depth_decoder paper_decoder)
set(XTRACK_HEADERS_gestures/segment hand hand_region tracker_settings)
set(XTRACK_HEADERS_gestures/track hand_source hand_tracker joint_recording
                                one_euro_filter)
set(XTRACK_HEADERS_gestures/recognise gesture_event gesture_recogniser gesture_settings labels
                                    scoring)
set(XTRACK_HEADERS_gestures/session session)

# The only folders that may include headers of an operating system.
set(XTRACK_DEVICE_FOLDERS core/capture/v4l2 core/project gestures/hid)

# Stages that an option switches off.
set(XTRACK_OPTION_core/project XTRACK_WITH_PROJECTOR)
set(XTRACK_OPTION_core/calibrate XTRACK_WITH_CALIBRATION)
set(XTRACK_OPTION_gestures/hid XTRACK_WITH_HID)

# Runs check_stages.cmake before anything is compiled, and again only if a source changed.
function(xtrack_check_stages)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/core/*.?pp
       ${PROJECT_SOURCE_DIR}/gestures/*.?pp ${PROJECT_SOURCE_DIR}/core/*.h
       ${PROJECT_SOURCE_DIR}/gestures/*.h)
  set(script ${PROJECT_SOURCE_DIR}/cmake/check_stages.cmake)
  set(stamp ${PROJECT_BINARY_DIR}/stages.stamp)
  add_custom_command(
    OUTPUT ${stamp}
    COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -P ${script}
    COMMAND ${CMAKE_COMMAND} -E touch ${stamp}
    DEPENDS ${sources} ${script} ${PROJECT_SOURCE_DIR}/cmake/Stages.cmake
    COMMENT "Checking that no stage includes a later one"
    VERBATIM)
  add_custom_target(xtrack_check_stages DEPENDS ${stamp})
endfunction()

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
  add_dependencies(${name} xtrack_check_stages)
  set_property(GLOBAL APPEND PROPERTY XTRACK_${part}_OBJECTS $<TARGET_OBJECTS:${name}>)
  set_property(GLOBAL APPEND PROPERTY XTRACK_${part}_LINK ${ARG_LINK})
endfunction()

# xtrack_part(<part> [LINK ...])
#
# Adds the stages of a part, in order, and the library xtrack_<part> (alias xtrack::<part>) made of
# them. LINK names the parts it stands on.
function(xtrack_part part)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  foreach(stage ${XTRACK_STAGES})
    set(switch "${XTRACK_OPTION_${stage}}")
    if(stage MATCHES "^${part}/" AND EXISTS ${PROJECT_SOURCE_DIR}/${stage}/CMakeLists.txt
       AND ("${switch}" STREQUAL "" OR "${${switch}}"))
      add_subdirectory(${PROJECT_SOURCE_DIR}/${stage})
    endif()
  endforeach()

  get_property(objects GLOBAL PROPERTY XTRACK_${part}_OBJECTS)
  get_property(link GLOBAL PROPERTY XTRACK_${part}_LINK)
  list(REMOVE_DUPLICATES link)
  add_library(xtrack_${part} ${objects})
  add_library(xtrack::${part} ALIAS xtrack_${part})
  # Before 1.0 a minor version may change the ABI, so the SONAME carries it.
  set_target_properties(
    xtrack_${part}
    PROPERTIES LINKER_LANGUAGE CXX
               EXPORT_NAME ${part}
               VERSION ${PROJECT_VERSION}
               SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
               WINDOWS_EXPORT_ALL_SYMBOLS ON
               XTRACK_OUTSIDE_LIBRARIES "${link}")
  target_include_directories(
    xtrack_${part} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/${part}/include>
                          $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(xtrack_${part} PUBLIC Eigen3::Eigen Threads::Threads ${ARG_LINK}
                                       PRIVATE ${link})
  target_compile_features(xtrack_${part} PUBLIC cxx_std_20)
endfunction()
