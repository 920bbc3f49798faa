# SPDX-License-Identifier: BSD-3-Clause
# One joint read far off for a few ticks: Set refuses it, naming port, joint and number, and no tick
# takes longer for it. What is within reach of the limits is taken, and its ticks end too.
loop=$OCA_BUILD/tests/cases/case_control_loop
[ -x "$loop" ] || { echo "not built: case_control_loop"; exit 1; }
for radians in 1e3 1e6 1e15 -1e15 1e300 nan; do
  timeout 60 "$loop" joint recommended $radians > out
  grep "^Set: input plant.position at t = .*got" out
  if [ "$radians" != nan ]; then grep -q "joint 'lwr4_joint_4'" out; fi
  tail -n 1 out | awk '{ exit $4 > 2000 }'
done
timeout 60 "$loop" joint recommended 7.0 > out
grep -x "Set: ok" out
tail -n 1 out | awk '{ exit $4 > 2000 }'

# A state that starts out there is an error of the file.
status=0
"$SIMULATOR" check "$OCA_SOURCE/diagrams/static_test.yaml" -s systems.plant.initial_position='[0, 0, 0, 0, 1e6, 0, 0]' 2> err || status=$?
[ $status = 2 ]
grep "plant.position.*joint 'lwr4_joint_5'; got 1e+06" err
