# Installs the build into a scratch prefix and uses it from outside: cmake -D BUILD= -D VERSION= -D PICTURES= -P run.cmake
set(scratch ${BUILD}/tests/package)
set(prefix ${scratch}/prefix)
file(REMOVE_RECURSE ${scratch})
set(ENV{DESTDIR})
set(ENV{VARVE_MODULE_PATH})

function(run expected)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL expected)
    message(FATAL_ERROR "${ARGN}\nended with ${result} instead of ${expected}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(require_text text)
  string(FIND "${output}" "${text}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "\"${text}\" is missing in:\n${output}")
  endif()
endfunction()

run(0 ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
run(0 ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${scratch}/consumer -DCMAKE_BUILD_TYPE=Release
      -DCMAKE_PREFIX_PATH=${prefix} -Dvarve_DIR=)
run(0 ${CMAKE_COMMAND} --build ${scratch}/consumer)
file(READ ${scratch}/consumer/module_folder module_folder)

# No picture module in sight: a plain sentence with the remedy.
run(5 ${scratch}/consumer/consumer ${scratch}/picture.png)
require_text("varve ${VERSION}")
require_text("VARVE_MODULE_PATH")
if(EXISTS ${scratch}/picture.png)
  message(FATAL_ERROR "a picture without the module")
endif()

if(PICTURES)
  # Named by the user, then found from a program that lies beside it.
  run(0 ${CMAKE_COMMAND} -E env VARVE_MODULE_PATH=${module_folder} ${scratch}/consumer/consumer ${scratch}/picture.png)
  file(COPY ${scratch}/consumer/consumer DESTINATION ${prefix}/bin)
  file(REMOVE ${scratch}/picture.png)
  run(0 ${prefix}/bin/consumer ${scratch}/picture.png)
  if(NOT EXISTS ${scratch}/picture.png)
    message(FATAL_ERROR "no picture")
  endif()
endif()

# What is installed knows nothing of where it was built.
if(CONFIG STREQUAL "Release")
  file(GLOB_RECURSE installed ${prefix}/lib/* ${prefix}/bin/varve ${prefix}/share/*)
  foreach(file IN LISTS installed)
    file(STRINGS ${file} found REGEX "${SOURCE}")
    if(found)
      message(FATAL_ERROR "${file} names the source folder: ${found}")
    endif()
  endforeach()
endif()
file(REMOVE_RECURSE ${scratch})
