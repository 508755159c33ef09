# Of Ceres' solvers only those of Eigen are used. A static Ceres also asks for SuiteSparse, CXSparse, LAPACK and BLAS, and to
# load these takes six of the nine milliseconds in which a program starts. So nothing is linked to them: their functions, which
# nothing calls, are stubs that end the program. Hidden ones, since LibTorch and NumPy have these libraries for themselves.
get_target_property(type Ceres::ceres TYPE)
if(type STREQUAL "STATIC_LIBRARY")
  get_target_property(archive Ceres::ceres LOCATION)
  execute_process(COMMAND ${CMAKE_NM} --undefined-only ${archive} OUTPUT_VARIABLE undefined ERROR_QUIET)
  string(REGEX MATCHALL " U ((_Z[0-9]+SuiteSparse|SuiteSparse_|cholmod_|cs_di_|METIS_)[A-Za-z0-9_]+|d[a-z]+_)\n" names "${undefined}")
  list(REMOVE_DUPLICATES names)
  set(stubs "#include <stdlib.h>\n")
  foreach(name ${names})
    string(REGEX REPLACE " U |\n" "" name ${name})
    string(APPEND stubs "extern \"C\" __attribute__((visibility(\"hidden\"))) void ${name}() { abort(); }\n")
  endforeach()
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/ceres_stubs.cc CONTENT "${stubs}" @ONLY)
  add_library(pushid_ceres_stubs STATIC ${PROJECT_BINARY_DIR}/ceres_stubs.cc)
  set_property(TARGET Ceres::ceres PROPERTY INTERFACE_LINK_LIBRARIES
    pushid_ceres_stubs Threads::Threads glog::glog gflags Eigen3::Eigen)
endif()
