# Before project(): clang++-19 when it and its OpenMP are there and the user named no compiler; else what CMake finds.
if(NOT DEFINED CMAKE_CXX_COMPILER AND NOT DEFINED ENV{CXX})
  find_program(PLIANT_CLANG clang++-19)
  find_file(PLIANT_CLANG_OPENMP libomp.so PATHS /usr/lib/llvm-19/lib NO_DEFAULT_PATH)
  mark_as_advanced(PLIANT_CLANG PLIANT_CLANG_OPENMP)
  if(PLIANT_CLANG AND PLIANT_CLANG_OPENMP)
    set(CMAKE_CXX_COMPILER ${PLIANT_CLANG})
  endif()
endif()
