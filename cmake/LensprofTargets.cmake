# How every layer of lensprof is compiled.

add_library(lensprof_settings INTERFACE)
set(lensprof_include ${PROJECT_SOURCE_DIR}/include)
if(LENSPROF_SANITIZE)
  # The sanitized build is a later version, too: its structs that grow are longer (tests/install/growth).
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  set(lensprof_include ${PROJECT_BINARY_DIR}/longer)
  set(longer_headers ${PROJECT_SOURCE_DIR}/tests/install/growth/longer_headers.py)
  execute_process(COMMAND ${Python3_EXECUTABLE} -B ${longer_headers} ${PROJECT_SOURCE_DIR}/include ${lensprof_include}
                  COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB public_headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/lensprof/*.h)
  set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${public_headers} ${longer_headers})
endif()
target_include_directories(lensprof_settings INTERFACE ${lensprof_include})
# Contraction is off so that results do not depend on the instruction set.
target_compile_options(lensprof_settings INTERFACE -Wall -Wextra -Wshadow -Wpointer-arith -ffp-contract=off)
# GCC collects its garbage at 1 GB of it, and not at 128 MB: a tenth less time for the largest sources.
target_compile_options(lensprof_settings INTERFACE
  $<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=1000000>)
if(EMSCRIPTEN)
  target_compile_options(lensprof_settings INTERFACE -fwasm-exceptions)
  target_link_options(lensprof_settings INTERFACE -fwasm-exceptions)
endif()
if(LENSPROF_WERROR)
  target_compile_options(lensprof_settings INTERFACE -Werror)
endif()
if(LENSPROF_SANITIZE)
  # C reads bytes in place and keeps all checks. In C++ these four are at every access through a pointer or reference and take
  # as much compile time as all the rest; the address sanitizer stops at a null pointer, too.
  target_compile_options(lensprof_settings INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
    $<$<COMPILE_LANGUAGE:CXX>:-fno-sanitize=null,alignment,object-size,vptr>
    # clang's check of calls through pointers needs its C++ runtime in C programs, too.
    $<$<COMPILE_LANG_AND_ID:CXX,Clang>:-fno-sanitize=function>)
  # A function with more than 30 accesses to memory checks them in calls: the same checks, a tenth less compile time.
  target_compile_options(lensprof_settings INTERFACE
    "$<$<COMPILE_LANG_AND_ID:CXX,Clang>:SHELL:-mllvm -asan-instrumentation-with-call-threshold=30>")
  # As GCC does: what measures memory asks for it.
  target_compile_definitions(lensprof_settings INTERFACE $<$<C_COMPILER_ID:Clang>:__SANITIZE_ADDRESS__=1>)
  target_link_options(lensprof_settings INTERFACE -fsanitize=address,undefined)
endif()
# The build type of the preset `sanitize`. -O1: with -O2 the compiler takes three times as long, longer than all tests.
# -g1: lines, which is what reports show. For C++ they take a tenth of the compile time: CXXFLAGS=-g1 adds them.
set(CMAKE_C_FLAGS_SANITIZE "-O1 -g1 -DNDEBUG")
set(CMAKE_CXX_FLAGS_SANITIZE "-O1 -DNDEBUG")

# The compiler's cache, if there is one. `CCACHE_DISABLE=1 make` or -DCMAKE_CXX_COMPILER_LAUNCHER= does without.
find_program(LENSPROF_CCACHE ccache)
mark_as_advanced(LENSPROF_CCACHE)
foreach(language C CXX)
  if(LENSPROF_CCACHE AND NOT DEFINED CMAKE_${language}_COMPILER_LAUNCHER)
    set(CMAKE_${language}_COMPILER_LAUNCHER ${LENSPROF_CCACHE})
  endif()
endforeach()

# lensprof_precompile(target header...): these C++ headers are parsed once for all sources of the target. ccache with its default
# settings does not cache sources that use a precompiled header, so a build with a compiler cache has none.
function(lensprof_precompile target)
  if(NOT CMAKE_CXX_COMPILER_LAUNCHER)
    list(TRANSFORM ARGN REPLACE "(.+)" "<\\1>")
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# lensprof_reuse_precompiled(target from): the precompiled headers of `from`, a target with the same compiler options.
function(lensprof_reuse_precompiled target from)
  if(NOT CMAKE_CXX_COMPILER_LAUNCHER)
    target_precompile_headers(${target} REUSE_FROM ${from})
  endif()
endfunction()

# lensprof_join(target): the C++ sources of each folder of the target are compiled as one, because most of the compiler's time is
# for the templates that they share. File-local names are therefore unique in a folder.
function(lensprof_join target)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_filename_component(folder ${source} DIRECTORY)
    get_filename_component(folder ${folder} NAME)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${LENSPROF_JOIN} UNITY_BUILD_MODE GROUP)
  # GCC takes the sources for headers, in which a type must not have a member of a file-local type.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# lensprof_layer(name [ONLY] SOURCES... LINK...): an object library lensprof_<name> with hidden symbols, of all sources in its
# folder (with ONLY of none but those named) and the generated SOURCES. Includes name private headers from src on.
function(lensprof_layer name)
  cmake_parse_arguments(ARG "ONLY" "" "SOURCES;LINK" ${ARGN})
  if(NOT ARG_ONLY)
    file(GLOB_RECURSE found CONFIGURE_DEPENDS *.c *.cpp)
    list(APPEND ARG_SOURCES ${found})
  endif()
  add_library(lensprof_${name} OBJECT ${ARG_SOURCES})
  target_include_directories(lensprof_${name} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(lensprof_${name} PUBLIC lensprof_settings PRIVATE ${ARG_LINK})
  target_compile_definitions(lensprof_${name} PRIVATE LENSPROF_EXPORTS)
  set_target_properties(lensprof_${name} PROPERTIES
    C_STANDARD 11 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF
    CXX_STANDARD 17 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF
    C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden
    POSITION_INDEPENDENT_CODE ON)
endfunction()

# lensprof_library(name SOURCES...): a library for other programs. A shared one lets out only the C functions: templates of
# the C++ library are instantiated in it.
function(lensprof_library name)
  if(DEFINED BUILD_SHARED_LIBS AND NOT BUILD_SHARED_LIBS)
    add_library(${name} STATIC ${ARGN})
  else()
    add_library(${name} SHARED ${ARGN})
    if(NOT APPLE AND NOT WIN32) # there the visibility of functions does it
      target_link_options(${name} PRIVATE -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/exports.map)
      set_target_properties(${name} PROPERTIES LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/exports.map)
    endif()
  endif()
endfunction()
