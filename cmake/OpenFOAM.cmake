# Imported targets for OpenFOAM 1912: OpenFOAM::base (libOpenFOAM and Pstream), OpenFOAM::finiteVolume (with meshTools, surfMesh,
# dynamic meshes), OpenFOAM::turbulence (incompressible and phase-weighted DPM models).
#
# Two sources: an openfoam.com installation (WM_PROJECT_DIR with lnInclude folders and FOAM_LIBBIN), or Debian's libraries with the
# headers that cmake/fetch_openfoam_headers.sh lays out in CUTTERFLOW_OPENFOAM_DIR.
set(CUTTERFLOW_OPENFOAM_VERSION 1912)

if(EXISTS "$ENV{WM_PROJECT_DIR}/src/finiteVolume/lnInclude/fvCFD.H")
  if(NOT "$ENV{WM_PROJECT_VERSION}" MATCHES "1912")
    message(FATAL_ERROR "WM_PROJECT_VERSION = $ENV{WM_PROJECT_VERSION} is not ${CUTTERFLOW_OPENFOAM_VERSION}. cutterFoam is written for OpenFOAM v${CUTTERFLOW_OPENFOAM_VERSION}. Source that version's bashrc, or use Debian's packages with an empty environment.")
  endif()
  set(CUTTERFLOW_OPENFOAM_PROJECT_DIR "$ENV{WM_PROJECT_DIR}")
  set(foam_source "$ENV{WM_PROJECT_DIR}/src")
  set(foam_flat_suffix "/lnInclude")
  set(foam_include_root "${foam_source}")
  set(foam_library_dirs "$ENV{FOAM_LIBBIN}" "$ENV{FOAM_LIBBIN}/$ENV{FOAM_MPI}")
  set(foam_label_size "$ENV{WM_LABEL_SIZE}")
else()
  set(CUTTERFLOW_OPENFOAM_PROJECT_DIR "/usr/share/openfoam")  # where Debian keeps OpenFOAM's etc/
  set(foam_source "${CUTTERFLOW_OPENFOAM_DIR}/src/src")
  set(foam_flat_suffix "")
  set(foam_include_root "${CUTTERFLOW_OPENFOAM_DIR}/include")
  set(foam_library_dirs /usr/lib /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE} /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/openfoam /usr/lib/openfoam)
  set(foam_label_size 32)
  if(NOT EXISTS "${foam_include_root}/OpenFOAM/argList.H")
    message(FATAL_ERROR "OpenFOAM's headers are not in CUTTERFLOW_OPENFOAM_DIR = ${CUTTERFLOW_OPENFOAM_DIR}. Run ./bootstrap, which fetches them (cmake/fetch_openfoam_headers.sh), or configure with -DCUTTERFLOW_WITH_SOLVER=OFF.")
  endif()
endif()

# foam_target(NAME LIBRARIES lib ... INCLUDES folder ... LINKS target ...)
function(foam_target name)
  cmake_parse_arguments(ARG "" "" "LIBRARIES;INCLUDES;LINKS" ${ARGN})
  add_library(OpenFOAM::${name} INTERFACE IMPORTED GLOBAL)
  foreach(folder ${ARG_INCLUDES})
    target_include_directories(OpenFOAM::${name} SYSTEM INTERFACE "${foam_include_root}/${folder}${foam_flat_suffix}")
  endforeach()
  foreach(library ${ARG_LIBRARIES})
    find_library(foam_${library} NAMES ${library} PATHS ${foam_library_dirs} NO_DEFAULT_PATH REQUIRED)
    target_link_libraries(OpenFOAM::${name} INTERFACE "${foam_${library}}")
  endforeach()
  target_link_libraries(OpenFOAM::${name} INTERFACE ${ARG_LINKS})
endfunction()

foam_target(base LIBRARIES OpenFOAM Pstream INCLUDES OpenFOAM OSspecific/POSIX)
target_compile_definitions(OpenFOAM::base INTERFACE
  NoRepository OPENFOAM=${CUTTERFLOW_OPENFOAM_VERSION} WM_DP WM_LABEL_SIZE=${foam_label_size} linux64)
target_compile_options(OpenFOAM::base INTERFACE -Wno-old-style-cast -ftemplate-depth=100)
target_link_options(OpenFOAM::base INTERFACE -Wl,--no-as-needed)

foam_target(finiteVolume
  LIBRARIES finiteVolume meshTools surfMesh fileFormats dynamicMesh dynamicFvMesh sampling fvOptions
  INCLUDES finiteVolume meshTools surfMesh fileFormats dynamicMesh dynamicFvMesh sampling fvOptions LINKS OpenFOAM::base)
foam_target(turbulence
  LIBRARIES turbulenceModels incompressibleTurbulenceModels incompressibleTransportModels DPMTurbulenceModels
  INCLUDES TurbulenceModels/turbulenceModels TurbulenceModels/incompressible transportModels/incompressible
  LINKS OpenFOAM::finiteVolume)
target_include_directories(OpenFOAM::turbulence SYSTEM INTERFACE
  "${foam_source}/transportModels" "${foam_source}/TurbulenceModels/phaseIncompressible/PhaseIncompressibleTurbulenceModel")
