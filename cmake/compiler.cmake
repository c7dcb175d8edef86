# Before project(): clang++-19 when it and its OpenMP are there and the user named no compiler; else what CMake finds.
find_program(PLIANT_CLANG clang++-19)
# Where the package of its OpenMP would push another version out, `./pliant` unpacks it here.
set(PLIANT_OPENMP ${CMAKE_SOURCE_DIR}/build/openmp CACHE PATH "Where clang's OpenMP is unpacked, if anywhere")
set(unpacked ${PLIANT_OPENMP}/usr/lib/llvm-19/lib)
find_file(PLIANT_CLANG_OPENMP libomp.so PATHS ${unpacked} /usr/lib/llvm-19/lib NO_DEFAULT_PATH)
mark_as_advanced(PLIANT_CLANG PLIANT_CLANG_OPENMP)
if(NOT DEFINED CMAKE_CXX_COMPILER AND NOT DEFINED ENV{CXX} AND PLIANT_CLANG AND PLIANT_CLANG_OPENMP)
  set(CMAKE_CXX_COMPILER ${PLIANT_CLANG})
endif()
if("${CMAKE_CXX_COMPILER}" MATCHES "clang\\+\\+-19$" AND PLIANT_CLANG_OPENMP STREQUAL "${unpacked}/libomp.so")
  # As FindOpenMP would find it in the compiler's own folders. A library that is linked by its path is found there by the
  # program too, before the system's of the same name.
  set(OpenMP_CXX_FLAGS "-fopenmp=libomp -isystem ${unpacked}/clang/19/include" CACHE STRING "Of clang's OpenMP, unpacked")
  set(OpenMP_CXX_LIB_NAMES omp CACHE STRING "Of clang's OpenMP, unpacked")
  set(OpenMP_omp_LIBRARY ${PLIANT_CLANG_OPENMP} CACHE FILEPATH "Clang's OpenMP, unpacked")
endif()
