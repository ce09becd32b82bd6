# The two VTK modules (Filters, IO) and their Python package `bsplinereconstruction`.
vtk_module_find_modules(bsr_module_files "${CMAKE_SOURCE_DIR}/Filters" "${CMAKE_SOURCE_DIR}/IO")
vtk_module_scan(
  MODULE_FILES ${bsr_module_files}
  REQUEST_MODULES BSplineReconstruction::Filters BSplineReconstruction::IO
  PROVIDES_MODULES bsr_modules
  ENABLE_TESTS "${BSR_BUILD_TESTING}")
vtk_module_build(
  MODULES ${bsr_modules}
  PACKAGE BSplineReconstruction
  INSTALL_HEADERS ON
  ENABLE_WRAPPING "${BSR_WRAP_PYTHON}"
  HEADERS_DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/BSplineReconstruction"
  CMAKE_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/BSplineReconstruction")
foreach (module IN LISTS bsr_modules)
  _vtk_module_real_target(target ${module})
  bsr_strict(${target})
endforeach ()

if (BSR_WRAP_PYTHON)
  set(bsr_python_dir "lib/python3/dist-packages")
  vtk_module_wrap_python(
    MODULES ${bsr_modules}
    TARGET BSplineReconstruction::Python
    PYTHON_PACKAGE "bsplinereconstruction"
    MODULE_DESTINATION "${bsr_python_dir}"
    CMAKE_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/BSplineReconstruction"
    INSTALL_HEADERS OFF
    BUILD_STATIC OFF)
  file(WRITE "${CMAKE_BINARY_DIR}/${bsr_python_dir}/bsplinereconstruction/__init__.py"
    "\"\"\"B-spline reconstruction filters for VTK.\"\"\"\nfrom .BSplineReconstructionFilters import *\nfrom .BSplineReconstructionIO import *\n")
  install(FILES "${CMAKE_BINARY_DIR}/${bsr_python_dir}/bsplinereconstruction/__init__.py"
    DESTINATION "${bsr_python_dir}/bsplinereconstruction")
endif ()
