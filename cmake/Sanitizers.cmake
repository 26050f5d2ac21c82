# CUTTERFLOW_SANITIZE=ON: every target is built with AddressSanitizer and UndefinedBehaviorSanitizer; the first error ends the program.
if(NOT CUTTERFLOW_SANITIZE)
  return()
endif()
if(CUTTERFLOW_WITH_SOLVER)
  message(FATAL_ERROR "CUTTERFLOW_SANITIZE=ON with CUTTERFLOW_WITH_SOLVER=ON. OpenFOAM and LIGGGHTS are not built for the sanitizers. Configure with -DCUTTERFLOW_WITH_SOLVER=OFF.")
endif()
add_compile_options(-O1 -fno-omit-frame-pointer -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all -Wno-maybe-uninitialized -Wno-stringop-overflow)
add_link_options(-fsanitize=address,undefined,float-cast-overflow)
