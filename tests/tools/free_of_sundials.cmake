# SPDX-License-Identifier: BSD-3-Clause
# cmake -DPROGRAM=... -P free_of_sundials.cmake: neither a library of SUNDIALS nor a call of it.
foreach(command ldd nm)
  execute_process(COMMAND ${command} ${PROGRAM} RESULT_VARIABLE status OUTPUT_VARIABLE out)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${command} ${PROGRAM} failed")
  endif()
  string(REGEX MATCH "sundials|CVode|ERKStep|N_VNew" found "${out}")
  if(found)
    message(FATAL_ERROR "${command} ${PROGRAM}: got ${found}; expected nothing of SUNDIALS")
  endif()
endforeach()
