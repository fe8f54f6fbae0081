include(${CMAKE_CURRENT_LIST_DIR}/lensprof-targets.cmake)
