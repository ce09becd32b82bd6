# Everything comes from the distribution; see CONTRIBUTING.md for the reason of each.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(OpenCASCADE REQUIRED COMPONENTS FoundationClasses ModelingData ModelingAlgorithms
  Visualization ApplicationFramework DataExchange)

set(BSR_VTK_COMPONENTS CommonCore CommonDataModel CommonExecutionModel CommonMath CommonMisc
  CommonTransforms FiltersCore FiltersGeneral FiltersGeometry FiltersModeling FiltersPoints FiltersSources ImagingCore
  ImagingGeneral IOCore IOLegacy IOXML ParallelCore)

set(BSR_WITH_PARAVIEW OFF)
if (BSR_BUILD_PLUGIN)
  find_package(ParaView 5.10 QUIET COMPONENTS RemotingCore VTKExtensionsCore)
  if (ParaView_FOUND)
    set(BSR_WITH_PARAVIEW ON)
    find_package(VTK REQUIRED PATHS "${VTK_DIR}" NO_DEFAULT_PATH COMPONENTS ${BSR_VTK_COMPONENTS})
  endif ()
endif ()
if (NOT BSR_WITH_PARAVIEW)
  find_package(VTK 9.1 REQUIRED COMPONENTS ${BSR_VTK_COMPONENTS})
  message(STATUS "ParaView not used: building against VTK ${VTK_VERSION}, without the plugin")
endif ()
if (BSR_WRAP_PYTHON)
  find_package(Python3 COMPONENTS Interpreter Development QUIET)
  if (NOT Python3_FOUND OR NOT TARGET VTK::WrappingPythonCore)
    set(BSR_WRAP_PYTHON OFF)
  endif ()
endif ()
