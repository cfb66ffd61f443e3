# The house's own rules: who includes whom, what the kernels may share, and that what is installed is of use to others.
add_test(NAME House.Rooms COMMAND ${PROJECT_SOURCE_DIR}/script/check_rooms)
add_test(NAME House.RoomsAreChecked COMMAND ${CMAKE_CURRENT_LIST_DIR}/rooms_test.sh ${PROJECT_SOURCE_DIR})
add_test(NAME House.BenchScenes COMMAND ${CMAKE_CURRENT_LIST_DIR}/bench_scenes_test.sh ${PROJECT_SOURCE_DIR} $<TARGET_FILE:lambent_program>)
set_tests_properties(House.BenchScenes PROPERTIES SKIP_RETURN_CODE 77)
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT LAMBENT_SANITIZE)  # without optimization nothing is inlined, not even std::max
  add_test(NAME House.Symbols COMMAND ${PROJECT_SOURCE_DIR}/script/check_symbols ${PROJECT_BINARY_DIR})
endif()

set(flags ${CMAKE_CXX_FLAGS})
if(LAMBENT_SANITIZE)
  string(APPEND flags " -fsanitize=${LAMBENT_SANITIZE}")
endif()
add_test(NAME House.Install COMMAND ${CMAKE_COMMAND} -D source=${PROJECT_SOURCE_DIR} -D build=${PROJECT_BINARY_DIR}
  -D generator=${CMAKE_GENERATOR} -D make_program=${CMAKE_MAKE_PROGRAM} -D compiler=${CMAKE_CXX_COMPILER}
  -D "flags=${flags}" -D version=${PROJECT_VERSION} -P ${CMAKE_CURRENT_LIST_DIR}/install_test.cmake)
set_tests_properties(House.Install PROPERTIES TIMEOUT 600)
