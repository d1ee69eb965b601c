# What every target of ours is compiled with.
function(xtrack_settings target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON
                                             CXX_VISIBILITY_PRESET default)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow
                                           $<$<BOOL:${XTRACK_DEVELOPER}>:-Werror>)
endfunction()
