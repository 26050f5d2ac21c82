# Versions of what Cutterflow is built with, for `cutterflow --version` and the records of runs.
find_package(CGAL 5.4 REQUIRED)
# Debian's assimp package configuration asks for libraries it does not need.
find_library(ASSIMP_LIBRARY assimp REQUIRED)
if(CUTTERFLOW_WITH_SOLVER)
  find_package(MPI REQUIRED COMPONENTS CXX)
  find_library(LIGGGHTS_LIBRARY liggghts REQUIRED)
endif()

# The version in a shared library's file name; their headers name none. The library of assimp's release 5.2.5 (Debian bookworm's) says 5.2.4,
# in its file name and by aiGetVersionPatch: that release kept the number of the one before.
function(cutterflow_library_version variable library)
  file(REAL_PATH "${library}" file)
  if(file MATCHES "\\.so\\.([0-9.]+)$")
    set(${variable} "${CMAKE_MATCH_1}" PARENT_SCOPE)
  else()
    set(${variable} "unknown" PARENT_SCOPE)
  endif()
endfunction()

function(cutterflow_open_mpi_version variable)
  find_file(mpi_header mpi.h PATHS ${MPI_CXX_INCLUDE_DIRS} NO_DEFAULT_PATH NO_CACHE REQUIRED)
  set(version)
  foreach(part MAJOR MINOR RELEASE)
    file(STRINGS "${mpi_header}" line REGEX "define OMPI_${part}_VERSION")
    string(REGEX MATCH "[0-9]+" number "${line}")
    list(APPEND version "${number}")
  endforeach()
  list(JOIN version "." version)
  set(${variable} "${version}" PARENT_SCOPE)
endfunction()

set(openfoam_version none)
set(liggghts_version none)
set(mpi_version none)
cutterflow_library_version(assimp_version "${ASSIMP_LIBRARY}")
if(CUTTERFLOW_WITH_SOLVER)
  set(openfoam_version ${CUTTERFLOW_OPENFOAM_VERSION})
  cutterflow_library_version(liggghts_version "${LIGGGHTS_LIBRARY}")
  cutterflow_open_mpi_version(mpi_version)
endif()

set(CUTTERFLOW_VERSION_DEFINITIONS
  CUTTERFLOW_VERSION="${PROJECT_VERSION}"
  CUTTERFLOW_OPENFOAM_VERSION="${openfoam_version}"
  CUTTERFLOW_LIGGGHTS_VERSION="${liggghts_version}"
  CUTTERFLOW_CGAL_VERSION="${CGAL_VERSION}"
  CUTTERFLOW_ASSIMP_VERSION="${assimp_version}"
  CUTTERFLOW_MPI_VERSION="${mpi_version}"
  CUTTERFLOW_COMPILER="${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
