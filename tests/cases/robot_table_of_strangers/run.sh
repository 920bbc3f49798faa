# A robot that is refused ended the whole table, after it and without a word.
cp "$OCA_SOURCE"/tests/models/robot/arms/{kr6,ur3e}.{urdf,srdf} .
echo '<robot name="a"><link name="l"/><joint name="j" type="revolute"/></robot>' > l_is_no_arm.urdf
"$OCA_SOURCE/tools/robot_table.sh" --methods recommended . > out
cat out
[ "$(wc -l < out)" = 6 ]
grep -q '^l_is_no_arm  *no task: .*l_is_no_arm.urdf:1: joint ' out
grep -q '^1 without a task$' out
grep -qE '^ur3e +yes, time [0-9.]+, 0.[0-9]+ m ' out
grep -qE '^of 2 +2, 100 %' out
# One of which nothing is known without avoidance: the run fails, and the table goes on.
mkdir other bin
cp kr6.urdf kr6.srdf other
cat > bin/simulator <<'S'
#!/usr/bin/env bash
[[ "$*" == *avoid=false* ]] && exit 1
exec "$REAL" "$@"
S
chmod +x bin/simulator
REAL=$SIMULATOR SIMULATOR=$PWD/bin/simulator "$OCA_SOURCE/tools/robot_table.sh" --methods recommended other > out
grep -qE '^kr6 +yes, 0.[0-9]+ m, never without' out
