# `cmake --install build --prefix P` and `cpack`. Programs find their files from where they stand (geometry/base/installation.hpp), so
# that P may be any folder and may be moved. The build folder is laid out as P is, with links to the source tree in its share/cutterflow.
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CUTTERFLOW_DATA share/cutterflow)
set(CUTTERFLOW_VERIFICATION libexec/cutterflow/verification)

file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/${CUTTERFLOW_DATA}")
foreach(folder cases docs validation)
  file(CREATE_LINK "${CMAKE_SOURCE_DIR}/${folder}" "${CMAKE_BINARY_DIR}/${CUTTERFLOW_DATA}/${folder}" SYMBOLIC)
endforeach()
file(CREATE_LINK "${CUTTERFLOW_OPENFOAM_DIR}/src/tutorials" "${CMAKE_BINARY_DIR}/${CUTTERFLOW_DATA}/tutorials" SYMBOLIC)

# What programs read.
install(FILES docs/references.bib DESTINATION ${CUTTERFLOW_DATA}/docs)
install(DIRECTORY docs/results/validation DESTINATION ${CUTTERFLOW_DATA}/docs/results FILES_MATCHING PATTERN "*.json")
install(DIRECTORY validation/cases DESTINATION ${CUTTERFLOW_DATA}/validation FILES_MATCHING PATTERN "README.md" PATTERN "*.csv")
install(DIRECTORY cases/examples DESTINATION ${CUTTERFLOW_DATA}/cases USE_SOURCE_PERMISSIONS)
install(DIRECTORY "${CUTTERFLOW_OPENFOAM_DIR}/src/tutorials/lagrangian/DPMFoam/Goldschmidt"
  DESTINATION ${CUTTERFLOW_DATA}/tutorials/lagrangian/DPMFoam OPTIONAL)

# What people read. Result pages stay in the repository: they are large.
install(FILES README.md CHANGELOG.md LICENSE DESTINATION share/doc/cutterflow)
install(DIRECTORY docs DESTINATION share/doc/cutterflow PATTERN "*.html" EXCLUDE PATTERN "*.json" EXCLUDE)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME cutterflow)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_CONTACT "the developers of Cutterflow")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Predicts the spillage of a cutter suction dredger's rotating cutter head")
set(CPACK_PACKAGE_DESCRIPTION "Fluid (OpenFOAM, sliding mesh) and rock (LIGGGHTS) in one process, coupled four ways: from the cutter's
surface to a report of what is spilled, with the error and the cost beside it.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Programs that are started, and OpenFOAM's libraries, for which Debian keeps no dependency information.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libopenfoam, openfoam, liggghts, gnuplot-nox, openmpi-bin")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
