# SPDX-License-Identifier: BSD-3-Clause
# cmake -DBUILD=... -DSOURCE=... -DWORK=... -P run.cmake: installs, builds the project of someone
# else against it, and shows that the block of theirs works wherever one of ours does. The files are
# those of docs/how-to/own_block.md.
cmake_minimum_required(VERSION 3.25)

# run(STATUS PATTERN COMMAND...): the command ends so and prints what matches; INPUT is its stdin.
function(run status pattern)
  file(WRITE ${WORK}/input "${INPUT}")
  execute_process(COMMAND ${ARGN} INPUT_FILE ${WORK}/input WORKING_DIRECTORY ${WORK}
                  RESULT_VARIABLE got OUTPUT_VARIABLE out ERROR_VARIABLE out)
  list(JOIN ARGN " " command)
  if(NOT got STREQUAL status)
    message(FATAL_ERROR "${command}\nended with ${got}, not ${status}\n${out}")
  elseif(NOT out MATCHES "${pattern}")
    message(FATAL_ERROR "${command}\nprinted no '${pattern}'\n${out}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(files ${SOURCE}/tests/consumer)
set(installed ${WORK}/installed)
run(0 "" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${installed})
# Headers that are installed include no header that is not.
file(GLOB_RECURSE headers ${installed}/include/oca/*.h)
foreach(header ${headers})
  file(STRINGS ${header} includes REGEX "^#include \"oca/")
  foreach(include ${includes})
    string(REGEX REPLACE ".*\"(oca/.*)\".*" "\\1" include ${include})
    if(NOT EXISTS ${installed}/include/${include})
      message(FATAL_ERROR "${header}: includes ${include}, which is not installed")
    endif()
  endforeach()
endforeach()
# No folder of it is empty.
file(GLOB_RECURSE entries LIST_DIRECTORIES true ${installed}/*)
foreach(entry ${entries})
  if(IS_DIRECTORY ${entry})
    file(GLOB inside ${entry}/*)
    if(NOT inside)
      message(FATAL_ERROR "${entry}: installed without a file in it")
    endif()
  endif()
endforeach()
run(0 "" ${CMAKE_COMMAND} -G Ninja -S ${files} -B ${WORK}/build -DCMAKE_PREFIX_PATH=${installed}
         -DCMAKE_BUILD_TYPE=Release)
run(0 "" ${CMAKE_COMMAND} --build ${WORK}/build)
set(simulator ${WORK}/build/acme_simulator)
set(battery ${files}/battery.yaml)

# It runs, alone and in the program, and the same program runs our own files.
run(0 "largest power: 9[0-9.]* W.charge left: 0.5" ${WORK}/build/embedded ${battery})
run(0 "met monitor.battery.charge" ${simulator} run ${battery})
run(0 "reached" ${simulator} run ${installed}/share/oca/diagrams/static_test.yaml)
run(0 "reached" ${installed}/bin/simulator run ${installed}/share/oca/diagrams/static_test.yaml)
run(2 "battery.yaml:7:.*no system type 'BatteryMonitor'" ${installed}/bin/simulator run ${battery})

# It is described, listed, checked, drawn, and in the schema.
run(0 "joint_power +number W s/rad >= 0; default 50" ${simulator} describe BatteryMonitor)
run(0 "output  battery +Battery, held state" ${simulator} describe BatteryMonitor)
run(0 "input   battery +Battery" ${simulator} describe LowBattery)
run(0 "BatteryMonitor +counts what.*LowBattery +1 while" ${simulator} list)
run(0 "battery.yaml: fine, 3 systems" ${simulator} check ${battery})
run(0 "BatteryMonitor" ${simulator} graph ${battery})
run(0 "\"low_charge\"" ${simulator} schema)

# What is wrong is located.
file(READ ${battery} text)
string(REPLACE "low_charge: 0.5" "low_charge: 2" text "${text}")
file(WRITE ${WORK}/bad.yaml "${text}")
run(2 "bad.yaml:7:[0-9]+: error: systems.monitor.low_charge: got 2; expected in .0, 1."
    ${simulator} check bad.yaml)
run(2 "systems.monitor.capacity: got -1 J; expected > 0" ${simulator} run ${battery}
    -s parameters.capacity=-1)
run(2 "did you mean 'BatteryMonitor'" ${simulator} describe BateryMonitor)

# It is evaluated, its signal as an output and as an input.
set(INPUT "{\"velocity\": [1, -1]}\n{\"velocity\": [0, 0]}\n")
run(0 "\"power\":.120.*\"charge\":0.9988.*\"power\":20" ${simulator} eval BatteryMonitor --params
    "{\"capacity\": 1000}")
set(INPUT "{\"battery\": {\"charge\": 0.1, \"power\": 20, \"low\": true}}\n{\"battery\": 7}\n{\"battery\": {\"charge\": 2, \"power\": 20, \"low\": true}}\n")
run(0 "\"out\":.1.*error.*expected an object with charge, power, low.*expected 0 to 1" ${simulator} eval LowBattery)
set(INPUT "")

# It is recorded, run again from its record, compared, exported, plotted, swept and shown.
run(0 "" ${simulator} run ${battery} --record a.mcap --csv csv)
run(0 "met monitor.battery.charge" ${simulator} run a.mcap --record b.mcap)
run(0 "no difference" ${simulator} compare a.mcap b.mcap)
run(0 "" ${simulator} export a.mcap --csv exported)
foreach(folder csv exported)
  file(READ ${WORK}/${folder}/monitor.battery.jsonl text)
  if(NOT text MATCHES "\"time\":0.1,\"value\":.\"charge\":0.99.*\"low\":true")
    message(FATAL_ERROR "${folder}/monitor.battery.jsonl:\n${text}")
  endif()
endforeach()
run(0 "" ${simulator} plot a.mcap --signal monitor.battery.charge -o charge.svg)
run(0 "2 runs" ${simulator} sweep ${battery} --samples 2 -o swept --no-progress)
run(0 "s simulated" ${simulator} run ${battery} --live=0 -t 0.5 --realtime=5)
if(EXISTS ${installed}/share/oca/viewer.html)
  run(0 "" ${simulator} run ${battery} --report report.html)
  file(SIZE ${WORK}/report.html size)
  if(size LESS 100000)
    message(FATAL_ERROR "report.html: ${size} bytes")
  endif()
else()
  message(STATUS "without Node there is no page, so no report was made")
endif()

# The page that explains it quotes these very files.
file(READ ${SOURCE}/docs/how-to/own_block.md page)
foreach(name battery_monitor.h catalogue.h simulator.cc battery.yaml CMakeLists.txt embedded.cc)
  file(READ ${files}/${name} text)
  string(REGEX REPLACE "^[^\n]*SPDX[^\n]*\n" "" text "${text}")
  string(FIND "${page}" "\n${text}```" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "docs/how-to/own_block.md does not quote tests/consumer/${name} as it is")
  endif()
endforeach()

# What the first line of installed diagrams leads to.
if(NOT EXISTS ${installed}/share/oca/diagrams/diagram.schema.json)
  message(FATAL_ERROR "diagram.schema.json: not installed beside the diagrams")
endif()
