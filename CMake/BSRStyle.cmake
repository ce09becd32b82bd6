# Checks of the sources: `cmake --build build --target tidy` runs clang-tidy with the project's
# .clang-tidy over Core, Filters and IO; the style tests below run with every ctest.
find_program(RUN_CLANG_TIDY_EXECUTABLE run-clang-tidy)
find_program(CLANG_TIDY_EXECUTABLE clang-tidy)
find_program(CLANG_FORMAT_EXECUTABLE clang-format)
mark_as_advanced(RUN_CLANG_TIDY_EXECUTABLE CLANG_TIDY_EXECUTABLE CLANG_FORMAT_EXECUTABLE)

if (RUN_CLANG_TIDY_EXECUTABLE AND CLANG_TIDY_EXECUTABLE)
  # Only our own sources: the compilation database also has the wrapped Python and server code.
  add_custom_target(tidy
    COMMAND "${RUN_CLANG_TIDY_EXECUTABLE}" -quiet -p "${CMAKE_BINARY_DIR}"
      "^${CMAKE_SOURCE_DIR}/(Core|Filters|IO)/[^/]*/?[^/]*[.]cxx$"
    WORKING_DIRECTORY "${CMAKE_SOURCE_DIR}"
    COMMENT "clang-tidy over Core, Filters and IO"
    USES_TERMINAL VERBATIM)
else ()
  message(STATUS "clang-tidy not found: no target tidy")
endif ()

if (BSR_BUILD_TESTING)
  find_package(Git QUIET)
  foreach (check IN ITEMS Format CoreWithoutVTK)
    add_test(NAME "Style.${check}"
      COMMAND "${CMAKE_COMMAND}" "-DCHECK=${check}" "-DGIT=${GIT_EXECUTABLE}"
        "-DCLANG_FORMAT=${CLANG_FORMAT_EXECUTABLE}" -P "${CMAKE_SOURCE_DIR}/CMake/CheckStyle.cmake"
      WORKING_DIRECTORY "${CMAKE_SOURCE_DIR}")
    set_tests_properties("Style.${check}" PROPERTIES LABELS style
      SKIP_REGULAR_EXPRESSION "SKIPPED: ")
  endforeach ()
endif ()
