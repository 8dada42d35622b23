# lumibox_precompiled(TARGET LIBRARIES ... HEADERS ...): headers of others that many files include,
# parsed once; use with target_precompile_headers(... REUSE_FROM TARGET). It is only for speed: each
# file still includes what it uses.
function(lumibox_precompiled target)
  cmake_parse_arguments(P "" "" "LIBRARIES;HEADERS" ${ARGN})
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "")
  add_library(${target} OBJECT ${source})
  target_link_libraries(${target} PRIVATE lumibox_flags ${P_LIBRARIES})
  target_precompile_headers(${target} PRIVATE ${P_HEADERS})
endfunction()

lumibox_precompiled(lumibox_precompiled
  LIBRARIES Eigen3::Eigen
  HEADERS <Eigen/Geometry> <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <map>
          <memory> <optional> <span> <string> <vector>)
