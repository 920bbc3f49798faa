# SPDX-License-Identifier: BSD-3-Clause
# cmake -DBUILD=... -DSOURCE=... -DWORK=... -P run.cmake: installs, builds the consumer, runs it.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\n${out}")
  endif()
endfunction()
file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/installed)
run(${CMAKE_COMMAND} -G Ninja -S ${SOURCE}/tests/consumer -B ${WORK}/build
    -DCMAKE_PREFIX_PATH=${WORK}/installed -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer ${WORK}/installed/share/oca/diagrams/static_test.yaml)
run(${WORK}/installed/bin/simulator run ${WORK}/installed/share/oca/diagrams/static_test.yaml)
# What the first line of installed diagrams leads to.
if(NOT EXISTS ${WORK}/installed/share/oca/diagrams/diagram.schema.json)
  message(FATAL_ERROR "diagram.schema.json: not installed beside the diagrams")
endif()
