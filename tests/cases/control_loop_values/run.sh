# SPDX-License-Identifier: BSD-3-Clause
# What a control loop is given is checked by Set, by name; the last good value stays and the tick is
# as it was.
loop=$OCA_BUILD/tests/cases/case_control_loop
[ -x "$loop" ] || { echo "not built: case_control_loop"; exit 1; }
"$loop" obstacle good > good
grep -x "Set: ok" good
nearest=$(tail -n 1 good)
refused() {
  "$loop" obstacle "$1" > out || { echo "$1: exit $?"; exit 1; }
  grep "^Set: input obstacles.obstacles at t = 0 s: .*$2" out || { echo "$1:"; cat out; exit 1; }
  grep -qx "Tick: ok" out && grep -qxF "$nearest" out || { echo "$1:"; cat out; exit 1; }
}
refused empty_body "obstacle 1: body; got none"
refused shapeless "obstacle 0: body; got one without a shape"
refused zero_rotation "'box': rotation"
refused scaled "'box': rotation"
refused sheared "'box': rotation"
refused mirrored "mirrors"
refused at_1e300 "'box': position; got \[1e+300"
refused at_2e6 "'box': position"
refused nan "'box': got a NaN"
refused fast "'box': velocity"
refused twice "got 'box' again"
refused nameless "id; got an empty one"
