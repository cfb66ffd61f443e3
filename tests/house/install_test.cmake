# Install Lambent, move it elsewhere, build the examples there as a user would, run each, and look at what it wrote.
#
#   cmake -D source=... -D build=... -D generator=... -D make_program=... -D compiler=... -D flags=... -D version=...
#         -P tests/house/install_test.cmake
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\nended with ${status}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(expect_start file hex)
  if(NOT EXISTS ${file})
    message(FATAL_ERROR "${file} was not written")
  endif()
  string(LENGTH ${hex} digits)
  math(EXPR bytes "${digits} / 2")
  file(READ ${file} start LIMIT ${bytes} HEX)
  if(NOT start STREQUAL hex)
    message(FATAL_ERROR "${file} begins with ${start}, not with ${hex}")
  endif()
endfunction()

set(place ${build}/house/install)
file(REMOVE_RECURSE ${place})
file(MAKE_DIRECTORY ${place}/run)
run(${CMAKE_COMMAND} --install ${build} --prefix ${place}/first)
file(RENAME ${place}/first ${place}/prefix)  # the package must not depend on where it was installed

file(GLOB headers RELATIVE ${source}/include ${source}/include/lambent/*.h)
foreach(header IN LISTS headers)
  if(NOT EXISTS ${place}/prefix/include/${header})
    message(FATAL_ERROR "${header} is not installed")
  endif()
endforeach()

# The package names no folder of the source or the build.
file(GLOB_RECURSE package ${place}/prefix/*/cmake/lambent/*.cmake)
if(NOT package)
  message(FATAL_ERROR "there is no lib/cmake/lambent")
endif()
foreach(file IN LISTS package)
  file(READ ${file} text)
  foreach(folder IN ITEMS ${source} ${build})
    string(FIND "${text}" "${folder}" found)
    if(NOT found EQUAL -1)
      message(FATAL_ERROR "${file} names ${folder}")
    endif()
  endforeach()
endforeach()

run(${place}/prefix/bin/lambent --version)
if(NOT output MATCHES "${version}")
  message(FATAL_ERROR "the installed program says it is ${output}, not ${version}")
endif()

run(${CMAKE_COMMAND} -G ${generator} -S ${source}/examples -B ${place}/examples
  -D CMAKE_MAKE_PROGRAM=${make_program} -D CMAKE_CXX_COMPILER=${compiler} "-DCMAKE_CXX_FLAGS=${flags} -Wall -Wextra -Wpedantic -Werror"
  -D CMAKE_PREFIX_PATH=${place}/prefix)
run(${CMAKE_COMMAND} --build ${place}/examples)

file(GLOB examples ${source}/examples/*.cpp)
foreach(example IN LISTS examples)
  cmake_path(GET example STEM name)
  execute_process(COMMAND ${place}/examples/${name} WORKING_DIRECTORY ${place}/run
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${name} ended with ${status}:\n${output}")
  endif()
  message(STATUS "${name}: ${output}")
endforeach()

expect_start(${place}/run/00_minimal.png 89504e470d0a1a0a)
expect_start(${place}/run/00_minimal.exr 762f3101)
run(${place}/prefix/bin/lambent info ${place}/run/00_minimal.exr)
